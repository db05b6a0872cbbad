#include <array>
#include <optional>

#include "scene/grey_image.hpp"

namespace hybrid_sphere::scene {
namespace {

/// Uncompressed images of 1, 4, 8, 24 or 32 bits a pixel.
/// Format: https://learn.microsoft.com/windows/win32/gdi/bitmap-storage
class BmpReader {
 public:
  explicit BmpReader(const std::string& content) : content_(content) { read_header(); }

  GreyImage read(bool averages_opacity) {
    if (!has_opaque_pixel()) opacity_.reset();
    averages_opacity = averages_opacity && opacity_;
    GreyImage image{width_, height_, white_of(averages_opacity), {}};
    image.levels.reserve(width_ * height_);
    for (std::size_t y = 0; y < height_; ++y) {
      for (std::size_t x = 0; x < width_; ++x)
        image.levels.push_back(level_of(colours_of(x, y), averages_opacity));
    }
    return image;
  }

 private:
  static constexpr std::size_t file_header = 14;  // bytes
  static constexpr std::size_t os2_header = 12;
  static constexpr std::size_t least_header = 40;

  [[noreturn]] static void refuse(const std::string& why) { throw ImageError("BMP: " + why); }

  std::uint8_t byte(std::size_t at) const { return static_cast<std::uint8_t>(content_[at]); }

  std::uint32_t number(std::size_t at, std::size_t bytes) const {
    if (content_.size() < at + bytes) refuse("it ends in its header");
    std::uint32_t value = 0;
    for (std::size_t i = bytes; i-- > 0;) value = value << 8U | byte(at + i);
    return value;
  }

  void read_header() {
    const std::size_t header = number(file_header, 4);
    const bool is_os2 = header == os2_header;
    if (!is_os2 && header < least_header) refuse("its header has an unknown size");
    const std::size_t side = is_os2 ? 2 : 4;
    const auto width = static_cast<std::int32_t>(number(file_header + 4, side));
    const auto height = static_cast<std::int32_t>(number(file_header + 4 + side, side));
    if (width < 0) refuse("its width is negative");
    is_top_down_ = height < 0;
    width_ = static_cast<std::size_t>(width);
    height_ = static_cast<std::size_t>(is_top_down_ ? -static_cast<std::int64_t>(height) : height);
    check_image_size(width_, height_);
    bits_ = number(file_header + 6 + 2 * side, 2);
    if (bits_ != 1 && bits_ != 4 && bits_ != 8 && bits_ != 24 && bits_ != 32)
      refuse(std::to_string(bits_) + " bits a pixel, not 1, 4, 8, 24 or 32");
    read_compression(is_os2 ? 0 : number(file_header + 16, 4), header);
    if (bits_ <= 8) read_palette(file_header + header, is_os2 ? 3 : 4, is_os2 ? 0 : number(46, 4));
    pixels_ = number(10, 4);
    row_ = (width_ * bits_ + 31) / 32 * 4;
    if (pixels_ > content_.size() || (content_.size() - pixels_) / row_ < height_)
      refuse("it ends before its last pixel");
  }

  void read_compression(std::uint32_t compression, std::size_t header) {
    constexpr std::uint32_t none = 0;
    constexpr std::uint32_t masks = 3;  // a mask for each colour
    constexpr std::size_t header_with_opacity = 56;
    if (bits_ == 32) opacity_ = 3;
    if (compression == masks && bits_ == 32) {
      const std::size_t first = file_header + least_header;
      for (std::size_t i = 0; i < 3; ++i) colours_[i] = byte_of_mask(number(first + 4 * i, 4));
      const std::uint32_t opacity = header < header_with_opacity ? 0 : number(first + 12, 4);
      opacity_.reset();
      if (opacity != 0) opacity_ = byte_of_mask(opacity);
    } else if (compression != none) {
      refuse("it is compressed");
    }
  }

  static std::size_t byte_of_mask(std::uint32_t mask) {
    for (std::size_t i = 0; i < 4; ++i) {
      if (mask == 0xffU << 8 * i) return i;
    }
    refuse("a colour that is not a byte of its pixel");
  }

  void read_palette(std::size_t at, std::size_t entry, std::size_t used) {
    const std::size_t most = std::size_t{1} << bits_;
    if (used > most) refuse("a palette of more than " + std::to_string(most) + " colours");
    palette_.resize(used == 0 ? most : used);
    for (std::size_t i = 0; i < palette_.size(); ++i) {
      const std::uint32_t blue_green_red = number(at + i * entry, 3);
      for (unsigned k = 0; k < 3; ++k)
        palette_[i][k] = static_cast<std::uint8_t>(blue_green_red >> (16 - 8 * k));
    }
  }

  std::size_t row_at(std::size_t y) const { return pixels_ + row_ * (is_top_down_ ? y : height_ - 1 - y); }

  /// The fourth byte of a pixel is opacity, unless it is 0 in all of them.
  bool has_opaque_pixel() const {
    if (!opacity_) return false;
    for (std::size_t y = 0; y < height_; ++y) {
      for (std::size_t x = 0; x < width_; ++x) {
        if (byte(row_at(y) + 4 * x + *opacity_) != 0) return true;
      }
    }
    return false;
  }

  Colours colours_of(std::size_t x, std::size_t y) const {
    if (bits_ > 8) {
      const std::size_t at = row_at(y) + x * bits_ / 8;
      return {byte(at + colours_[0]), byte(at + colours_[1]), byte(at + colours_[2]),
              opacity_ ? byte(at + *opacity_) : opaque};
    }
    const std::size_t bit = x * bits_;
    const std::size_t below = 8 - bits_ - bit % 8;
    const std::size_t index = byte(row_at(y) + bit / 8) >> below & ((1U << bits_) - 1);
    if (index >= palette_.size()) refuse("a pixel beyond its palette");
    const auto& colour = palette_[index];
    return {colour[0], colour[1], colour[2], opaque};
  }

  const std::string& content_;
  std::size_t width_ = 0;
  std::size_t height_ = 0;
  std::size_t bits_ = 0;    // of a pixel
  std::size_t pixels_ = 0;  // where they begin
  std::size_t row_ = 0;     // bytes
  bool is_top_down_ = false;
  std::array<std::size_t, 3> colours_{2, 1, 0};  // bytes of a pixel: red, green, blue
  std::optional<std::size_t> opacity_;           // byte of a pixel
  std::vector<std::array<std::uint8_t, 3>> palette_;
};

}  // namespace

GreyImage grey_image_from_bmp(const std::string& content, const GreyRules& rules) {
  return BmpReader(content).read(rules.averages_opacity);
}

}  // namespace hybrid_sphere::scene
