#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "support/recorded.hpp"

namespace hybrid_sphere::testing {

/// What of a state contradicts itself or the last switch that was reported; empty where nothing does.
inline std::string contradiction(const State& state, const Vector3d& reaction, const Switches& switches) {
  const bool finite = state.position.allFinite() && state.orientation.coeffs().allFinite() &&
                      state.twist.velocity.allFinite() && state.twist.angular_velocity.allFinite() &&
                      state.slip.allFinite() && reaction.allFinite();
  if (!finite) return "not finite";
  if (std::abs(state.orientation.norm() - 1) > 0x1p-48) return "the quaternion is not unit";
  const bool rolls = state.mode == Mode::rolling || state.mode == Mode::resting;
  const bool holds = rolls || state.mode == Mode::edge_sliding;
  if (rolls && !state.slip.isZero(0)) return "it slips where it rolls";
  if (holds != (state.stage == Stage::nonholonomic)) return "the mode is not one of the stage";
  if (switches.empty()) return state.stage == Stage::holonomic ? "" : "a constraint that was never applied";
  const RecordedSwitch& last = switches.back();
  if (state.stage != last.to_stage) return "the stage is not that of the last switch";
  if (state.time < last.time) return "the last switch is later";
  if (state.time > last.time) return "";
  const double size = last.after.velocity.norm() + last.after.angular_velocity.norm();
  const double off = (state.twist.velocity - last.after.velocity).norm() +
                     (state.twist.angular_velocity - last.after.angular_velocity).norm();
  if (off > 0x1p-48 * size) return "the velocities are not those after the switch at this instant";
  const double away = (state.position - last.position).norm();
  if (away > 0x1p-45 * last.position.norm()) return "the place is not that of the switch at this instant";
  return "";
}

}  // namespace hybrid_sphere::testing
