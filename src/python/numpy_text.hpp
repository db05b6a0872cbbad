#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace hybrid_sphere::python {

/// A text as the items of a numpy array with dtype "U" hold it: UCS-4, filled up with zeros.
/// @param text  UTF-8
std::u32string numpy_text(std::string_view text);

/// Puts a text where such an item of `width` characters is; what is longer is cut off.
void put_text(std::u32string_view text, std::size_t width, char* item);

}  // namespace hybrid_sphere::python
