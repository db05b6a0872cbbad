#pragma once

#include <boost/math/special_functions/erf.hpp>

/// The inverse error functions in binary64: no exception, and infinite at the ends of their domains.
namespace hybrid_sphere::study {

namespace quiet {
namespace bmp = boost::math::policies;
using Policy = bmp::policy<bmp::promote_double<false>, bmp::domain_error<bmp::ignore_error>,
                           bmp::pole_error<bmp::ignore_error>, bmp::overflow_error<bmp::ignore_error>,
                           bmp::evaluation_error<bmp::ignore_error>>;
}  // namespace quiet

/// The x with erf(x) = p, -1 <= p <= 1.
inline double inverse_erf(double p) { return boost::math::erf_inv(p, quiet::Policy()); }

/// The x with erfc(x) = q, 0 <= q <= 2.
inline double inverse_erfc(double q) { return boost::math::erfc_inv(q, quiet::Policy()); }

}  // namespace hybrid_sphere::study
