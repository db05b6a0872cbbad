#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "html/rings.hpp"

namespace hybrid_sphere::html {

/// The cells of an image as a picture of one bit for each pixel.
struct CellRaster {
  Rectangle box;  ///< relative to the drawing's origin [m]
  std::size_t columns = 0;
  std::size_t rows = 0;
  std::vector<std::uint8_t> bits;  ///< row by row from the lower left, the highest bit of a byte first
};

/// The leading regions of a surface that are cells, as far as they lie in the drawing; a pixel is a cell, or
/// as many as it takes for the picture to have at most max_side of them along a side. None where no cell is.
std::optional<CellRaster> raster_of_cells(const scene::Surface& surface, const Drawing& drawing,
                                          std::size_t max_side);

}  // namespace hybrid_sphere::html
