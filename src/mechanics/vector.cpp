#include "hybrid_sphere/mechanics/vector.hpp"

#include <stdexcept>
#include <string>

namespace hybrid_sphere::mechanics {

void refuse_index(Index i, Index size) {
  throw std::out_of_range("component [" + std::to_string(i) + "] of a vector of " + std::to_string(size) +
                          "; allowed: " + (size > 0 ? "0 to " + std::to_string(size - 1) : "none"));
}

}  // namespace hybrid_sphere::mechanics
