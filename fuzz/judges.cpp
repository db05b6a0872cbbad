#include "judges.hpp"

#include <stdexcept>

namespace hybrid_sphere::fuzz {

Judge judge_named(const std::string& name) {
  if (name == "invariants") return judge_invariants;
  if (name == "integrator") return judge_by_integrator;
  if (name == "relations") return judge_relations;
  throw std::invalid_argument("no check " + name);
}

}  // namespace hybrid_sphere::fuzz
