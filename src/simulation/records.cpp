#include "hybrid_sphere/simulation/records.hpp"

namespace hybrid_sphere {

const char* to_string(Stop stop) {
  switch (stop) {
    case Stop::none: return "none";
    case Stop::livelock: return "livelock";
    case Stop::accumulation: return "accumulation";
    case Stop::undecided: return "undecided";
    case Stop::numerical: return "numerical";
    case Stop::out_of_memory: return "out of memory";
    case Stop::interrupted: return "interrupted";
  }
  return "";
}

const char* to_string(Mode mode) {
  switch (mode) {
    case Mode::free: return "free";
    case Mode::rolling: return "rolling";
    case Mode::sliding: return "sliding";
    case Mode::edge_sliding: return "edge_sliding";
    case Mode::resting: return "resting";
  }
  return "";
}

const char* to_string(SwitchKind kind) {
  switch (kind) {
    case SwitchKind::applied: return "applied";
    case SwitchKind::released: return "released";
    case SwitchKind::exchanged: return "exchanged";
  }
  return "";
}

const char* to_string(Cause cause) {
  switch (cause) {
    case Cause::edge: return "edge";
    case Cause::placed: return "placed";
    case Cause::slip_ended: return "slip ended";
    case Cause::grip_lost: return "grip lost";
    case Cause::livelock: return "livelock";
    case Cause::livelock_ended: return "livelock ended";
    case Cause::kicked: return "kicked";
    case Cause::accumulation: return "accumulation";
  }
  return "";
}

}  // namespace hybrid_sphere
