#pragma once

#include <boost/multiprecision/cpp_bin_float.hpp>

/// Numbers for the cases that binary64 does not decide. Apart from exact.hpp, which nearly every file
/// includes: Boost.Multiprecision is long to read for a compiler.
namespace hybrid_sphere::exact {

/// Products of two differences are exact in it as long as the numbers other than 0 differ by less than a
/// factor 1e30 in size.
using Real = boost::multiprecision::cpp_bin_float_100;

inline int sign(const Real& x) { return x.sign(); }

}  // namespace hybrid_sphere::exact
