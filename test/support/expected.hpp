#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hybrid_sphere/simulation/records.hpp"

namespace hybrid_sphere::testing {

/// A state of a reference solution and how far from it a binary64 program may be.
struct ExpectedState {
  double time = 0;
  Vector2d position;
  std::optional<Quaterniond> orientation;  ///< none where its accuracy is not known
  Twist twist;
  double position_tolerance = 0;
  double velocity_tolerance = 0;
  double spin_tolerance = 0;
  double orientation_tolerance = 0;
  std::string mode;    ///< as to_string(Mode); empty where it is not told
  std::string region;  ///< empty where it is not told
};

/// Velocities around an impulse.
struct ExpectedImpulse {
  Vector2d impulse;
  double normal = 0;  ///< L_z, only from rubber [N m s]
  Twist before;
  Twist after;
};

struct ExpectedSwitch {
  SwitchKind kind = SwitchKind::applied;
  Cause cause = Cause::edge;
  std::string from;
  std::string to;
  double time = 0;
  Vector2d position;
  std::optional<ExpectedImpulse> impulse;  ///< none: the velocities do not change
};

struct Expected {
  double event_time_tolerance = 0;
  std::optional<double> halted_at;  ///< when the computation cannot go on [s]; none where it always can
  std::vector<ExpectedState> states;
  std::vector<ExpectedSwitch> switches;
};

/// Reads a file that test/references/make_reference_data or test/references/make_numeric_references wrote.
Expected read_expected(const std::string& path);

}  // namespace hybrid_sphere::testing
