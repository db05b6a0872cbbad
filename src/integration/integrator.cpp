#include "integration/integrator.hpp"

#include <algorithm>
#include <cmath>

namespace hybrid_sphere::integration {

double error_of_better(double difference, int order) {
  return difference * std::min(1.0, std::pow(difference, 1.0 / order));
}

}  // namespace hybrid_sphere::integration
