#include <png.h>

#include <cstring>
#include <string_view>

#include "scene/grey_image.hpp"

namespace hybrid_sphere::scene {
namespace {

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

  bool has_opacity() const { return (image_.format & PNG_FORMAT_FLAG_ALPHA) != 0; }
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

/// The content without the chunks that say how its levels are to be shown. What is no PNG stays as it is.
std::string without_gamma(const std::string& content) {
  constexpr std::size_t signature = 8;
  constexpr std::size_t around = 12;  // bytes of a chunk beside its data: length, type and checksum
  std::string kept = content.substr(0, signature);
  std::size_t at = kept.size();
  while (content.size() - at >= around) {
    std::size_t length = 0;
    for (std::size_t i = 0; i < 4; ++i) length = length << 8U | static_cast<unsigned char>(content[at + i]);
    const std::string_view type(content.data() + at + 4, 4);
    if (length > content.size() - at - around) break;
    const bool is_of_gamma = type == "gAMA" || type == "cHRM" || type == "sRGB" || type == "iCCP";
    if (!is_of_gamma) kept.append(content, at, around + length);
    at += around + length;
  }
  return kept.append(content, at, std::string::npos);
}

}  // namespace

GreyImage grey_image_from_png(const std::string& content, const GreyRules& rules) {
  if (rules.ignores_gamma)
    return grey_image_from_png(without_gamma(content), {rules.averages_opacity, false});
  PngReader reader(content);
  check_image_size(reader.width(), reader.height());
  const bool averages_opacity = rules.averages_opacity && reader.has_opacity();
  GreyImage image{reader.width(), reader.height(), white_of(averages_opacity), reader.pixels()};
  for (std::uint32_t& level :
       image.levels) {  // in the place of its pixel: one copy of a large image is enough
    Colours colours;
    std::memcpy(colours.data(), &level, sizeof level);
    level = level_of(colours, averages_opacity);
  }
  return image;
}

}  // namespace hybrid_sphere::scene
