#include "hybrid_sphere/mechanics/kinematics.hpp"

namespace hybrid_sphere::mechanics {

template struct QuasiVelocityTerms<3, 4>;

}  // namespace hybrid_sphere::mechanics
