#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace hybrid_sphere::scene {

/// Why a file is not accepted as an image.
class ImageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A grey image: the mean of red, green and blue.
struct GreyImage {
  static constexpr std::uint32_t transparent = 1U << 31U;  ///< set in the level of a fully transparent pixel

  std::size_t width = 0;
  std::size_t height = 0;
  std::uint32_t white = 0;            ///< the level of white; 0 is black
  std::vector<std::uint32_t> levels;  ///< row by row from the top, each from the left
};

/// How the colours of a pixel become its level.
struct GreyRules {
  bool averages_opacity = false;  ///< of an image that has opacity: it counts as one more colour
  bool ignores_gamma = false;     ///< PNG: the levels as they are stored, not as shown on a screen (sRGB)
};

/// The image in a PNG, BMP or PNM (PBM, PGM, PPM) file of at most max_cells pixels. PNG: 8 bits; no memory is
/// allocated for pixels before the size in the header has been checked.
/// @throws ImageError
GreyImage read_grey_image(const std::string& file, const GreyRules& rules = {});

/// The image in a file's content.
GreyImage grey_image_from_pnm(const std::string& content);
GreyImage grey_image_from_png(const std::string& content, const GreyRules& rules = {});
GreyImage grey_image_from_bmp(const std::string& content, const GreyRules& rules = {});

using Colours = std::array<std::uint8_t, 4>;  ///< red, green, blue and opacity of a pixel
inline constexpr std::uint8_t opaque = 255;

/// The level of a pixel.
std::uint32_t level_of(const Colours& colours, bool averages_opacity);
/// The level of white of images whose pixels level_of makes.
inline std::uint32_t white_of(bool averages_opacity) { return averages_opacity ? 4 * opaque : 3 * opaque; }

/// @throws ImageError  for an image of no pixels or more than max_cells
void check_image_size(std::size_t width, std::size_t height);

}  // namespace hybrid_sphere::scene
