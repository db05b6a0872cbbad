#include "hybrid_sphere/mechanics/user_function.hpp"

#include <stdexcept>
#include <string>

namespace hybrid_sphere::mechanics::user_function {

void refuse_size(const char* name, Index found, Index size) {
  throw std::invalid_argument(std::string(name) + " has " + std::to_string(found) + " numbers, not " +
                              std::to_string(size));
}

void refuse_value(std::string_view function) { throw NotFinite(std::string(function)); }

void refuse_derivative(std::string_view function) {
  throw NotFinite("derivative of " + std::string(function));
}

}  // namespace hybrid_sphere::mechanics::user_function
