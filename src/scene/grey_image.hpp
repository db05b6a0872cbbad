#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
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
  static constexpr std::uint32_t transparent = std::numeric_limits<std::uint32_t>::max();

  std::size_t width = 0;
  std::size_t height = 0;
  std::uint32_t white = 0;            ///< the level of white; 0 is black
  std::vector<std::uint32_t> levels;  ///< or `transparent`; row by row from the top, each from the left
};

/// The image in a PNG or PNM (PBM, PGM, PPM) file of at most max_cells pixels. PNG: levels as shown on a
/// screen (sRGB), 8 bits; no memory is allocated for pixels before the size in the header has been checked.
/// @throws ImageError
GreyImage read_grey_image(const std::string& file);

/// The image in a PNM file's content; grey_image_from_png for PNG.
GreyImage grey_image_from_pnm(const std::string& content);
GreyImage grey_image_from_png(const std::string& content);

/// @throws ImageError  for an image of no pixels or more than max_cells
void check_image_size(std::size_t width, std::size_t height);

}  // namespace hybrid_sphere::scene
