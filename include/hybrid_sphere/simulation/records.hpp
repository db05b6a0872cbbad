#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "hybrid_sphere/export.hpp"
#include "hybrid_sphere/sphere/twist.hpp"

namespace hybrid_sphere {

/// Stages of Mei's hybrid system that have a duration; stage 2 is the impulse between them and has none.
enum class Stage : std::uint8_t { holonomic = 1, nonholonomic = 3 };

enum class Mode : std::uint8_t {
  free,          ///< smooth ground
  rolling,       ///< no slip
  sliding,       ///< slip, with the friction of the law coulomb
  edge_sliding,  ///< along the edge between two grounds that throw the sphere at each other
  resting,       ///< no slip, no velocity and no spin
};

enum class SwitchKind : std::uint8_t {
  applied = 1,    ///< a constraint is applied
  released = 2,   ///< a constraint is released
  exchanged = 3,  ///< one constraint replaces another
};

/// Why the constraint changed.
enum class Cause : std::uint8_t {
  edge = 0,            ///< the sphere reached another ground
  placed = 1,          ///< the sphere was placed there, or the ground was placed under it
  slip_ended = 2,      ///< friction has used up the slip
  grip_lost = 3,       ///< to keep rolling would need a larger reaction than friction can give
  livelock = 4,        ///< two grounds throw the sphere at each other endlessly: it slides along their edge
  livelock_ended = 5,  ///< one of the two releases it
  kicked = 6,          ///< an impulse from outside struck the sphere
  accumulation = 7     ///< throws back and forth have reached their last instant: docs/theory.md 5.5
};

/// Why a simulation cannot continue.
enum class Stop : std::uint8_t {
  none,      ///< it can
  livelock,  ///< grounds throw the sphere at each other without end, and none of the motions along an edge
             ///< is theirs
  accumulation,  ///< switches follow one another ever faster (Zeno), with no motion after the last one
  undecided,     ///< rounding hides what happens next
  numerical,     ///< the motion cannot be computed further
  out_of_memory,
  interrupted  ///< requested by the caller's function; the next call resumes
};

/// Whether a simulation can continue; the counterpart of mechanics::Status for a solution.
struct Status {
  Stop stop = Stop::none;
  double time = 0;      ///< of the last state [s]
  std::string message;  ///< one sentence with names and numbers; empty if it can continue
};

HYBRID_SPHERE_EXPORT const char* to_string(Stop stop);
HYBRID_SPHERE_EXPORT const char* to_string(Mode mode);
HYBRID_SPHERE_EXPORT const char* to_string(SwitchKind kind);
HYBRID_SPHERE_EXPORT const char* to_string(Cause cause);

/// The sphere at one instant, in the world frame.
struct State {
  double time = 0;                                    ///< since the initial state [s]
  Vector2d position = Vector2d::Zero();               ///< of the centre [m]; its height is R
  Quaterniond orientation = Quaterniond::Identity();  ///< body to world, unit
  Twist twist;
  Vector2d slip = Vector2d::Zero();  ///< velocity of the contact point relative to the ground [m/s]
  Stage stage = Stage::holonomic;
  Mode mode = Mode::free;
  std::string_view
      region;  ///< name of the ground under the sphere; valid as long as the simulation keeps its map
};

/// Stage 2: a change of the constraint on the sphere, with or without an impulse.
/// @code
/// const auto lost = [](const Switch& event) { return event.energy_before - event.energy_after; };
/// const auto is_rolling = [](const State& state) { return state.mode == Mode::rolling; };
/// @endcode
struct Switch {
  std::uint64_t index = 0;  ///< 0, 1, 2 ... since the initial state
  double time = 0;          ///< of the switch itself, since the initial state [s]
  /// What `time` loses by rounding to binary64 [s]: the unevaluated sum time + time_remainder is accurate to
  /// an ulp of the duration of each preceding segment, and far better on a straight path to a straight edge.
  double time_remainder = 0;
  SwitchKind kind = SwitchKind::applied;
  Cause cause = Cause::edge;
  Stage from_stage = Stage::holonomic;
  Stage to_stage = Stage::nonholonomic;
  std::string_view
      from_region;  ///< empty where the sphere was put there; valid during the call that reports it
  std::string_view to_region;
  Vector2d position = Vector2d::Zero();         ///< of the centre [m]
  Vector2d slip_before = Vector2d::Zero();      ///< relative to the ground entered [m/s]
  Vector2d impulse = Vector2d::Zero();          ///< P of the ground on the sphere [N s]
  Vector3d angular_impulse = Vector3d::Zero();  ///< about the centre, (R P_y, -R P_x, L_z) [N m s]
  Twist before;
  Twist after;
  double energy_before = 0;  ///< kinetic [J]
  double energy_after = 0;   ///< kinetic [J]
};

}  // namespace hybrid_sphere
