#include "support/extremes.hpp"

#include <algorithm>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <exception>

#include "scene/read_tree.hpp"
#include "scene/yaml.hpp"
#include "simulation/check_method.hpp"
#include "support/recorded.hpp"

namespace hybrid_sphere::testing {
namespace {

using Wide = boost::multiprecision::cpp_bin_float_50;

constexpr double unit = 0x1p-53;

double largest(const Eigen::MatrixXd& difference) { return difference.cwiseAbs().maxCoeff(); }

double largest(const Quaterniond& a, const Quaterniond& b) {
  return std::min(largest(a.coeffs() - b.coeffs()), largest(a.coeffs() + b.coeffs()));
}

bool is_finite(const State& state) {
  return state.position.allFinite() && state.orientation.coeffs().allFinite() &&
         state.twist.velocity.allFinite() && state.twist.angular_velocity.allFinite() &&
         state.slip.allFinite();
}

/// What errors are relative to: the way, the speeds, the rates.
struct Scale {
  double way = 0;
  double speed = 0;

  Scale(const scene::Scene& scene, const Expected& expected) {
    for (const ExpectedState& state : expected.states) {
      way = std::max(way, (state.position - scene.initial_state.position).norm());
      speed = std::max(
          speed, state.twist.velocity.norm() + scene.sphere.radius * state.twist.angular_velocity.norm());
    }
  }
};

class Comparison {
 public:
  Comparison(const scene::Scene& scene, const Expected& expected)
      : scale_(scene, expected), radius_(scene.sphere.radius) {
    for (const ExpectedState& state : expected.states) {
      const auto add_floor = [this](double floor, double scale) {
        if (scale > 0) measured.relative.floor = std::max(measured.relative.floor, floor / scale);
      };
      add_floor(state.position_tolerance, scale_.way);
      add_floor(state.velocity_tolerance, scale_.speed);
      add_floor(state.spin_tolerance, scale_.speed / radius_);
      if (state.orientation) add_floor(state.orientation_tolerance, 1);
    }
    for (const ExpectedSwitch& event : expected.switches) {
      measured.time.floor = std::max(measured.time.floor, time_floor(expected, event));
    }
  }

  void add(double error, double floor, double scale, const std::string& where) {
    const Reached reached{error, floor, where};
    if (reached.ratio() > measured.worst.ratio()) measured.worst = reached;
    if (!(scale > 0)) return;
    if (error / scale >= measured.relative.error) measured.relative.where = where;
    measured.relative.error = std::max(measured.relative.error, error / scale);
  }

  void add(const State& state, const ExpectedState& expected) {
    const std::string at = " at t = " + std::to_string(expected.time);
    if (!is_finite(state)) {
      measured.failure = "a number that is not finite" + at;
      return;
    }
    add(largest(state.position - expected.position), expected.position_tolerance, scale_.way,
        "position" + at);
    add(largest(state.twist.velocity - expected.twist.velocity), expected.velocity_tolerance, scale_.speed,
        "velocity" + at);
    add(largest(state.twist.angular_velocity - expected.twist.angular_velocity), expected.spin_tolerance,
        scale_.speed / radius_, "angular velocity" + at);
    if (!expected.orientation) return;
    add(largest(state.orientation, *expected.orientation), expected.orientation_tolerance, 1,
        "orientation" + at);
  }

  void add(const Switches& switches, const Expected& expected) {
    if (switches.size() != expected.switches.size()) {
      measured.failure = std::to_string(switches.size()) + " switches instead of " +
                         std::to_string(expected.switches.size());
      return;
    }
    for (std::size_t i = 0; i < switches.size(); ++i) {
      const RecordedSwitch& event = switches[i];
      const ExpectedSwitch& reference = expected.switches[i];
      if (event.kind != reference.kind || event.cause != reference.cause || event.to != reference.to) {
        measured.failure = "switch " + std::to_string(i) + " is another one";
      }
      const double error = std::abs(event.time - reference.time);
      add(error, time_floor(expected, reference), 0, "time of switch " + std::to_string(i));
      measured.time.error = std::max(measured.time.error, error);
    }
  }

  Measured measured;

 private:
  static double time_floor(const Expected& expected, const ExpectedSwitch& event) {
    return event.time > 0 ? expected.event_time_tolerance + unit * event.time : 0;
  }

  Scale scale_;
  double radius_;
};

double rounded(const Wide& value) { return value.convert_to<double>(); }

scene::Scene strip_scene(int count, double spacing, double speed, const scene::Solver& solver) {
  scene::Scene scene{};
  scene.sphere = {2, 0.25, 0.125};
  scene.solver = solver;
  scene.initial_state.velocity = {speed, 0.125};
  const double reach = count * spacing;
  scene.surface.regions.reserve(static_cast<std::size_t>(count / 2 + 1));
  for (int i = 1; i <= count; i += 2) {
    const double low = i * spacing;
    const double high = (i + 1) * spacing;
    scene.surface.regions.push_back(
        {"strip_" + std::to_string(i),
         scene::Polygon{{{low, -reach}, {high, -reach}, {high, reach}, {low, reach}}}, scene::Law::rough});
  }
  return scene;
}

}  // namespace

Measured measure(const scene::Scene& scene, const Expected& expected) {
  Comparison comparison(scene, expected);
  Measured& measured = comparison.measured;
  Switches switches;
  try {
    check_method(scene);
    Simulation simulation(scene);
    for (const ExpectedState& state : expected.states) {
      simulation.advance_to(state.time, recorder(switches));
      comparison.add(simulation.state(), state);
    }
    measured.integrated = simulation.evaluations() > 0;
  } catch (const std::exception& error) {
    measured.failure = error.what();
  }
  if (measured.failure.empty()) comparison.add(switches, expected);
  return measured;
}

Measured measure(const std::string& directory, const std::string& name, const std::string& method) {
  const Expected expected = read_expected(directory + "/" + name + ".expected.yaml");
  try {
    return measure(read_extreme(directory, name, method), expected);
  } catch (const scene::SceneError& error) {
    Measured refused = Comparison(read_extreme(directory, name), expected).measured;
    refused.failure = error.what();
    return refused;
  }
}

Strips run_over_strips(int count, double spacing, const scene::Solver& solver) {
  constexpr double before = 1.25;  // [m/s]; k = R/2 makes kappa 1/5, and the speed after the impulse 1
  const scene::Scene scene = strip_scene(count, spacing, before, solver);
  const Wide first = Wide(spacing) / Wide(before);
  const auto time_of = [&](int edge) { return Wide(first + Wide(edge - 1) * Wide(spacing)); };
  Strips strips;
  strips.end = rounded(time_of(count));
  strips.time_floor = 2 * unit * strips.end;
  const double until = strips.end + 0.5 * spacing;
  try {
    Simulation simulation(scene);
    simulation.advance_to(until, [&](const Switch& event) {
      const Wide late = Wide(event.time) - time_of(++strips.switches);
      strips.time_error = std::max(strips.time_error, std::abs(rounded(late)));
      strips.moment_error = std::max(strips.moment_error, std::abs(rounded(late + event.time_remainder)));
    });
    const Wide way = Wide(until) - time_of(1) + Wide(spacing);
    strips.state_error = std::abs(rounded((Wide(simulation.state().position.x()) - way) / way));
  } catch (const std::exception& error) {
    strips.failure = error.what();
  }
  return strips;
}

scene::Solver solver_of(const std::string& method, double accuracy) {
  const std::size_t colon = method.find(':');
  scene::Tree::Map keys{{"method", method.substr(0, colon)}};
  if (colon == std::string::npos) {
    keys.emplace_back("accuracy", accuracy);
  } else {
    keys.emplace_back("step", method.substr(colon + 1));
  }
  return scene::read_solver(keys);
}

scene::Scene read_extreme(const std::string& directory, const std::string& name, const std::string& method) {
  scene::Scene scene =
      scene::read_scene(scene::tree_from_yaml_file(directory + "/" + name + ".yaml"), directory);
  if (!method.empty()) scene.solver = solver_of(method, scene.solver.accuracy);
  return scene;
}

}  // namespace hybrid_sphere::testing
