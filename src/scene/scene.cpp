#include "hybrid_sphere/scene/scene.hpp"

namespace hybrid_sphere::scene {

const char* to_string(Law law) {
  switch (law) {
    case Law::smooth: return "smooth";
    case Law::rough: return "rough";
  }
  return "";
}

const char* to_string(Solver::Method method) {
  switch (method) {
    case Solver::Method::automatic: return "auto";
    case Solver::Method::exact: return "exact";
  }
  return "";
}

}  // namespace hybrid_sphere::scene
