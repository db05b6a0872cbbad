#include "scene/grey_image.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "scene/cell_map.hpp"

namespace hybrid_sphere::scene {
namespace {

constexpr std::size_t max_bytes = 128U << 20U;  // 16-bit colours of max_cells pixels, and a header

[[noreturn]] void refuse_size() { throw ImageError("larger than " + std::to_string(max_bytes) + " bytes"); }

std::string content_of(const std::string& file) {
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw ImageError(std::strerror(errno));
  std::string content;
  std::error_code unknown;  // of what is no regular file
  const auto size = std::filesystem::file_size(file, unknown);
  if (!unknown && size > max_bytes) refuse_size();
  if (!unknown) content.reserve(static_cast<std::size_t>(size));
  char block[65536];
  while (stream.read(block, sizeof block), stream.gcount() > 0) {
    content.append(block, static_cast<std::size_t>(stream.gcount()));
    if (content.size() > max_bytes) refuse_size();
  }
  if (stream.bad()) throw ImageError(std::strerror(errno));
  return content;
}

}  // namespace

void check_image_size(std::size_t width, std::size_t height) {
  if (width == 0 || height == 0 || width > max_cells / height) {
    throw ImageError(std::to_string(width) + " x " + std::to_string(height) + " pixels, not 1 x 1 to " +
                     std::to_string(max_cells) + " in total");
  }
}

std::uint32_t level_of(const Colours& colours, bool averages_opacity) {
  const auto sum = static_cast<std::uint32_t>(colours[0] + colours[1] + colours[2]);
  if (averages_opacity) return sum + colours[3];
  return colours[3] == 0 ? sum | GreyImage::transparent : sum;
}

GreyImage read_grey_image(const std::string& file, const GreyRules& rules) {
  const std::string content = content_of(file);
  if (content.rfind("\x89PNG\r\n\x1a\n", 0) == 0) return grey_image_from_png(content, rules);
  if (content.rfind("BM", 0) == 0) return grey_image_from_bmp(content, rules);
  if (content.size() > 2 && content[0] == 'P' && '1' <= content[1] && content[1] <= '6') {
    return grey_image_from_pnm(content);
  }
  throw ImageError(content.empty() ? "empty" : "neither PNG nor BMP nor PNM");
}

}  // namespace hybrid_sphere::scene
