#include <png.h>

#include <cstring>

#include "scene/grey_image.hpp"

namespace hybrid_sphere::scene {
namespace {

constexpr std::uint32_t white = 3 * 255;  // sum of red, green and blue

/// libpng's simplified reader: reports errors by return values, never by a jump.
class PngReader {
 public:
  explicit PngReader(const std::string& content) {
    image_.version = PNG_IMAGE_VERSION;
    if (png_image_begin_read_from_memory(&image_, content.data(), content.size()) == 0) fail();
  }
  ~PngReader() { png_image_free(&image_); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  std::size_t width() const { return image_.width; }
  std::size_t height() const { return image_.height; }

  /// Red, green, blue and opacity of each pixel, the four bytes of a number.
  std::vector<std::uint32_t> pixels() {
    image_.format = PNG_FORMAT_RGBA;
    image_.flags |= PNG_IMAGE_FLAG_16BIT_sRGB;
    std::vector<std::uint32_t> pixels(width() * height());
    if (png_image_finish_read(&image_, nullptr, pixels.data(), 0, nullptr) == 0) fail();
    return pixels;
  }

 private:
  [[noreturn]] void fail() {
    const std::string why = std::string("PNG: ") + image_.message;
    png_image_free(&image_);
    throw ImageError(why);
  }

  png_image image_{};
};

}  // namespace

GreyImage grey_image_from_png(const std::string& content) {
  PngReader reader(content);
  check_image_size(reader.width(), reader.height());
  GreyImage image{reader.width(), reader.height(), white, reader.pixels()};
  for (std::uint32_t& level :
       image.levels) {  // in the place of its pixel: one copy of a large image is enough
    png_byte p[sizeof level];
    std::memcpy(p, &level, sizeof level);
    const auto sum = static_cast<std::uint32_t>(p[0] + p[1] + p[2]);
    level = p[3] == 0 ? GreyImage::transparent : sum;
  }
  return image;
}

}  // namespace hybrid_sphere::scene
