// Any bytes are an image (PNM, PNG, BMP), a file of map_server that names one, or are refused; cells become
// regions.

#include <unistd.h>

#include <fstream>

#include "scene/cell_map.hpp"
#include "scene/grey_image.hpp"
#include "scene/read_image.hpp"
#include "scene/yaml.hpp"
#include "target.hpp"

namespace {

using namespace hybrid_sphere;

void check_image(const scene::GreyImage& image) {
  if (image.width == 0 || image.height == 0 || image.levels.size() != image.width * image.height)
    fuzz::found("an image has the pixels that its size says");
  if (image.levels.size() > 4096) return;
  scene::CellMap cells{image.width, image.height, 0.05, Vector2d(-1, 2), {}};
  for (const std::uint32_t level : image.levels)
    cells.belonging.push_back(level < image.white / 2 + 1 ? 1 : 0);
  std::size_t cells_that_belong = 0;
  for (const auto belongs : cells.belonging) cells_that_belong += belongs;
  double area = 0;
  for (const scene::Region& region : scene::regions_of(cells, scene::Law::rough, "cell_", "image")) {
    const auto& vertices = std::get<scene::Polygon>(region.shape).vertices;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const Vector2d& a = vertices[i];
      const Vector2d& b = vertices[(i + 1) % vertices.size()];
      area += (a.x() * b.y() - a.y() * b.x()) / 2;
    }
  }
  const double expected = static_cast<double>(cells_that_belong) * 0.05 * 0.05;
  if (!(std::abs(area - expected) <= 1e-6 * (1 + expected)))
    fuzz::found("the regions have the area of the cells");
}

scene::GreyImage image_in(const std::string& content) {
  const bool is_bmp = content.rfind("BM", 0) == 0;
  return is_bmp ? scene::grey_image_from_bmp(content) : scene::grey_image_from_png(content);
}

// A map's YAML beside an image that stands in a file.
void read_map(const std::string& text) {
  static const std::string directory = [] {
    char name[] = "/tmp/fuzz_images_XXXXXX";
    if (mkdtemp(name) == nullptr) std::abort();
    std::ofstream(std::string(name) + "/map.pgm") << "P2 3 2 255 0 255 0 255 0 128 ";
    return std::string(name);
  }();
  std::ofstream(directory + "/map.yaml", std::ios::binary) << text;
  std::vector<std::string> warnings;
  scene::read_image(scene::tree_from_yaml("{map: map.yaml, law: rough}"), "surface.image", directory,
                    warnings);
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string content(reinterpret_cast<const char*>(data + 1), size - 1);
  try {
    switch (data[0] % 3) {
      case 0: check_image(scene::grey_image_from_pnm(content)); break;
      case 1: check_image(image_in(content)); break;
      default: read_map(content);
    }
  } catch (const scene::ImageError&) {
  } catch (const scene::SceneError&) {
  }
  return 0;
}
