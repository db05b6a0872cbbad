#include <algorithm>
#include <cctype>

#include "scene/grey_image.hpp"

namespace hybrid_sphere::scene {
namespace {

/// Format: https://netpbm.sourceforge.net/doc/ (pbm, pgm, ppm).
class PnmReader {
 public:
  explicit PnmReader(const std::string& content) : content_(content), kind_(kind_of(content)) {}

  GreyImage read() {
    GreyImage image;
    image.width = header_number();
    image.height = header_number();
    if (!is_bitmap()) maximum_ = static_cast<std::uint32_t>(header_number());
    if (maximum_ == 0 || maximum_ > 65535) refuse("its maximum is not from 1 to 65535");
    check_image_size(image.width, image.height);
    if (!is_text()) ++at_;  // one white space, then the pixels
    const unsigned channels = kind_ == '3' || kind_ == '6' ? 3 : 1;
    image.white = channels * maximum_;
    refuse_short_content(image, channels);
    image.levels.reserve(image.width * image.height);
    for (std::size_t y = 0; y < image.height; ++y) {
      bit_ = 0;
      for (std::size_t x = 0; x < image.width; ++x) {
        std::uint32_t sum = 0;
        for (unsigned channel = 0; channel < channels; ++channel) sum += sample();
        image.levels.push_back(sum);
      }
      if (kind_ == '4' && bit_ != 0) ++at_;  // the rest of a row's last byte
    }
    return image;
  }

 private:
  [[noreturn]] static void refuse(const std::string& why) { throw ImageError("PNM: " + why); }

  static char kind_of(const std::string& content) {
    if (content.size() < 2 || content[0] != 'P' || content[1] < '1' || content[1] > '6')
      refuse("it does not begin with P1 to P6");
    return content[1];
  }

  bool is_text() const { return kind_ <= '3'; }
  bool is_bitmap() const { return kind_ == '1' || kind_ == '4'; }

  /// Before memory is taken for the pixels that the header speaks of.
  void refuse_short_content(const GreyImage& image, unsigned channels) const {
    const std::size_t row =
        kind_ == '4' ? (image.width + 7) / 8 : image.width * channels * (maximum_ > 255 ? 2 : 1);
    const std::size_t least = is_text() ? image.width * channels : row;  // a digit for each sample
    if (at_ > content_.size() || content_.size() - at_ < least * image.height)
      refuse("it ends before its last pixel");
  }

  unsigned char byte() {
    if (at_ >= content_.size()) refuse("it ends before its last pixel");
    return static_cast<unsigned char>(content_[at_++]);
  }

  void skip_space() {
    while (at_ < content_.size()) {
      if (content_[at_] == '#') {
        at_ = std::min(content_.find('\n', at_), content_.size());
      } else if (std::isspace(static_cast<unsigned char>(content_[at_])) != 0) {
        ++at_;
      } else {
        return;
      }
    }
  }

  bool at_digit() const { return at_ < content_.size() && '0' <= content_[at_] && content_[at_] <= '9'; }

  std::size_t number(const char* what) {
    skip_space();
    if (!at_digit()) refuse(what);
    std::size_t value = 0;
    for (; at_digit(); ++at_) {
      value = 10 * value + static_cast<std::size_t>(content_[at_] - '0');
      if (value > 0xffffffff) refuse(what);
    }
    return value;
  }

  std::size_t header_number() { return number("no width, height or maximum in its header"); }

  std::uint32_t bitmap_sample() {  // 1 is black
    if (kind_ == '1') {
      skip_space();
      const unsigned char digit = byte();
      if (digit != '0' && digit != '1') refuse("a bitmap pixel other than 0 or 1");
      return digit == '0' ? 1 : 0;
    }
    const unsigned bits = byte();
    const std::uint32_t level = (bits >> (7 - bit_) & 1U) == 0 ? 1 : 0;
    bit_ = (bit_ + 1) % 8;
    if (bit_ != 0) --at_;  // more of it
    return level;
  }

  std::uint32_t sample() {
    if (is_bitmap()) return bitmap_sample();
    std::uint32_t level = 0;
    if (is_text()) {
      level = static_cast<std::uint32_t>(number("a pixel that is not a number, or a premature end"));
    } else {
      level = byte();
      if (maximum_ > 255) level = 256 * level + byte();
    }
    if (level > maximum_) refuse("a pixel above the maximum");
    return level;
  }

  const std::string& content_;
  char kind_;
  std::size_t at_ = 2;
  std::uint32_t maximum_ = 1;
  unsigned bit_ = 0;  // the next one of a bitmap's byte
};

}  // namespace

GreyImage grey_image_from_pnm(const std::string& content) { return PnmReader(content).read(); }

}  // namespace hybrid_sphere::scene
