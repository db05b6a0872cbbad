#include <rapidcheck.h>

#include "support/random_scenes.hpp"

namespace hybrid_sphere::testing {

// At full size from the first case on.
int integer(int low, int high) { return *rc::gen::resize(100, rc::gen::inRange(low, high + 1)); }

}  // namespace hybrid_sphere::testing
