#include "motion/complex_lu.hpp"

namespace hybrid_sphere {

ComplexLu::ComplexLu(const Square& matrix) : decomposition_(matrix) {}

ComplexLu::Column ComplexLu::solve(const Column& right) const { return decomposition_.solve(right); }

}  // namespace hybrid_sphere
