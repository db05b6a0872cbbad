#include "motion/collocation_lu.hpp"

namespace hybrid_sphere {

CollocationLu::CollocationLu(const Square& matrix) : decomposition_(matrix) {}

CollocationLu::Column CollocationLu::solve(const Column& right) const { return decomposition_.solve(right); }

}  // namespace hybrid_sphere
