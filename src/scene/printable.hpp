#pragma once

#include <string>
#include <string_view>

namespace hybrid_sphere::scene {

/// Whether a text is UTF-8 as in RFC 3629: no overlong forms, no surrogates, nothing above U+10FFFF.
bool is_utf8(std::string_view text);

/// Text as it may be shown on a terminal and sent in a message: UTF-8, a byte that is none as an escape with
/// two hexadecimal digits, a control character as ?.
std::string escaped(std::string_view text);

/// The same, shortened to some sixty bytes.
std::string printable(std::string_view text);

}  // namespace hybrid_sphere::scene
