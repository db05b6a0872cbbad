#pragma once

#include <map>
#include <ostream>
#include <string>
#include <vector>

#include "catalogue/catalogue.hpp"

namespace hybrid_sphere::mechanics::catalogue::testing {

/// An entry of the catalogue with other numbers.
struct Variation {
  std::string name;  ///< for a test: letters, digits and underscores
  std::string entry;
  std::map<std::string, double> numbers;  ///< that differ from those as a rule
  double time_scale = 1;                  ///< of the motion, over the entry's characteristic time
  bool never_held = false;                ///< the motion is not known where the constraints hold
  int least_checked = 20;                 ///< of 40 instants, those that are known and not next to a switch
};

inline std::ostream& operator<<(std::ostream& stream, const Variation& variation) {
  return stream << variation.name;
}

inline Values values_of(const Variation& variation) {
  Values values(entry(variation.entry).parameters);
  for (const auto& [name, value] : variation.numbers) values.set(name, value);
  return values;
}

/// Every entry as a rule, and the places where formulas could lose digits or change their branch.
inline std::vector<Variation> variations() {
  std::vector<Variation> all;
  for (const Entry& entry : entries()) all.push_back({entry.name, entry.name, {}});
  const std::vector<Variation> more = {
      {"sleigh_mass_behind", "chaplygin_sleigh", {{"a", -0.3}}},
      {"sleigh_mass_behind_for_long", "chaplygin_sleigh", {{"a", -3}, {"x_dot", 9}}, 0.1},
      {"sleigh_mass_at_the_blade", "chaplygin_sleigh", {{"a", 0}}},
      {"sleigh_mass_hardly_ahead", "chaplygin_sleigh", {{"a", 1e-9}}},
      {"sleigh_without_rotation", "chaplygin_sleigh", {{"theta", 0.75}, {"theta_dot", 0}, {"x_dot", 0.5}}},
      {"sleigh_backwards",
       "chaplygin_sleigh",
       {{"theta", 0}, {"x_dot", -2}, {"y_dot", 0}, {"theta_dot", 1e-3}}},
      {"sleigh_turning_back", "chaplygin_sleigh", {{"x_dot", -1}, {"theta_dot", -4}}, 0.3},
      {"sleigh_of_large_inertia", "chaplygin_sleigh", {{"I", 40}, {"theta_dot", 3}}},
      {"disk_straight_ahead", "rolling_disk", {{"theta_dot", 0}}},
      {"disk_hardly_turning", "rolling_disk", {{"theta_dot", 1e-9}}},
      {"disk_turning_fast", "rolling_disk", {{"theta_dot", -20}}, 0.1},
      {"disk_without_spin", "rolling_disk", {{"phi_dot", 0}, {"R", 3}}},
      {"skate_straight_ahead", "knife_edge_incline", {{"theta_dot", 0}}},
      {"skate_hardly_turning", "knife_edge_incline", {{"theta_dot", 1e-9}}},
      {"skate_turning_fast", "knife_edge_incline", {{"theta_dot", -12}}, 0.1},
      {"skate_on_the_level", "knife_edge_incline", {{"gs", 0}}},
      {"skate_uphill", "knife_edge_incline", {{"gs", -3}, {"theta", 2}}},
      {"particle_rising_to_its_summit", "appell_hamel", {{"z_dot", 3}}, 0.1, false, 15},
      {"particle_on_a_shallow_slope", "appell_hamel", {{"a", 7}, {"m", 3}}},
      {"particle_without_direction", "appell_hamel", {{"x_dot", 0}, {"y_dot", 0}}, 1, true, 4},
      {"speed_without_gravity", "constant_speed", {{"g", 0}}},
      {"speed_with_hardly_any_gravity", "constant_speed", {{"g", 1e-9}}},
      {"speed_with_gravity_upwards", "constant_speed", {{"g", -3}}},
      {"speed_straight_down", "constant_speed", {{"x_dot", 0}}},
      {"speed_straight_up", "constant_speed", {{"x_dot", 0}, {"y_dot", 6}}},
      {"speed_nearly_straight_up", "constant_speed", {{"x_dot", 1e-2}, {"y_dot", 6}}},
      {"speed_from_rest", "constant_speed", {{"x_dot", 0}, {"y_dot", 2.5}}, 1, true, 4},
      {"time_without_resistance", "explicit_time", {{"gamma", 0}}},
      {"time_with_a_blade_at_rest", "explicit_time", {{"Omega", 0}}},
      {"time_with_neither", "explicit_time", {{"gamma", 0}, {"Omega", 0}}},
      {"time_with_hardly_any_of_both", "explicit_time", {{"gamma", 1e-9}, {"Omega", -1e-9}}},
      {"time_with_a_driving_medium", "explicit_time", {{"gamma", -0.5}, {"Omega", -3}}, 0.5},
      {"time_with_a_thick_medium", "explicit_time", {{"gamma", 6}, {"gx", -2}}, 0.2},
      {"particle_at_rest_in_y", "nonholonomic_particle", {{"y_dot", 0}}},
      {"particle_hardly_moving_in_y", "nonholonomic_particle", {{"y_dot", 1e-9}}},
      {"particle_from_far_to_far", "nonholonomic_particle", {{"y", -30}, {"y_dot", 20}}, 0.05},
      {"particle_visiting_backwards", "visiting_particle", {{"y_dot", -0.9}}},
      {"particle_visiting_narrow_strips", "visiting_particle", {{"period", 0.25}, {"y", -0.3}}, 0.25},
      {"particle_starting_on_a_strip", "visiting_particle", {{"y", 0.25}, {"z_dot", 0.25}}},
      {"ball_of_equal_moments", "chaplygin_ball", {{"A", 0.1}, {"B", 0.1}, {"C", 0.1}}},
      {"particle_starting_at_a_border", "visiting_particle", {{"y", 0}, {"z_dot", 4}}},
  };
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

/// Those of which a motion is known.
inline std::vector<Variation> known_variations() {
  std::vector<Variation> all;
  for (const Variation& one : variations()) {
    if (entry(one.entry).build(values_of(one)).known) all.push_back(one);
  }
  return all;
}

}  // namespace hybrid_sphere::mechanics::catalogue::testing
