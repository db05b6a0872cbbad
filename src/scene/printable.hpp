#pragma once

#include <string>
#include <string_view>

namespace hybrid_sphere::scene {

/// Whether a text is UTF-8 as in RFC 3629: no overlong forms, no surrogates, nothing above U+10FFFF.
bool is_utf8(std::string_view text);

/// Text that is safe to show on a terminal and send in a message: UTF-8, with invalid bytes as escapes of two
/// hexadecimal digits, and control characters as ?.
std::string escaped(std::string_view text);

/// The same, shortened to about sixty bytes.
std::string printable(std::string_view text);

}  // namespace hybrid_sphere::scene
