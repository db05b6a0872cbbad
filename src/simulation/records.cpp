#include "hybrid_sphere/simulation/records.hpp"

namespace hybrid_sphere {

const char* to_string(Mode mode) {
  switch (mode) {
    case Mode::free: return "free";
    case Mode::rolling: return "rolling";
    case Mode::resting: return "resting";
  }
  return "";
}

const char* to_string(SwitchKind kind) {
  switch (kind) {
    case SwitchKind::applied: return "applied";
    case SwitchKind::released: return "released";
  }
  return "";
}

}  // namespace hybrid_sphere
