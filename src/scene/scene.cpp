#include "hybrid_sphere/scene/scene.hpp"

namespace hybrid_sphere::scene {

const char* to_string(Law law) {
  switch (law) {
    case Law::smooth: return "smooth";
    case Law::rough: return "rough";
    case Law::rubber: return "rubber";
    case Law::coulomb: return "coulomb";
  }
  return "";
}

const char* to_string(Solver::Method method) {
  for (const MethodName& named : method_names) {
    if (named.method == method) return named.name;
  }
  return "";
}

}  // namespace hybrid_sphere::scene
