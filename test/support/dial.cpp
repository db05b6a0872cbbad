#include "support/dial.hpp"
#include "sphere/constants.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>

#include "hybrid_sphere/simulation/simulation.hpp"
#include "scene/read_tree.hpp"
#include "scene/yaml.hpp"
#include "support/files.hpp"

namespace hybrid_sphere::testing {
namespace {

/// How far the motion has come: what errors are relative to.
class Scale {
 public:
  explicit Scale(const scene::Scene& scene)
      : radius_(scene.sphere.radius), last_(scene.initial_state.position) {}

  void see(const ExpectedState& state) {
    way_ += (state.position - last_).norm();
    last_ = state.position;
    spin_ = std::max(spin_, state.twist.angular_velocity.norm());
    speed_ = std::max({speed_, state.twist.velocity.norm(), radius_ * spin_});
    turned_ = std::max(turned_, spin_ * state.time);
  }
  double way() const { return way_ + DBL_MIN; }
  double speed() const { return speed_ + DBL_MIN; }
  double turned() const { return std::max(1.0, turned_); }

 private:
  double radius_;
  Vector2d last_;
  double way_ = 0;
  double speed_ = 0;
  double spin_ = 0;
  double turned_ = 0;
};

// The tolerance of the reference is 16 times what an ulp of the input and the rounding of the output, of this
// size, make of it; the accuracy is carried over in the same way as the first.
double condition(double scale, double floor, double size) {
  const double of_input = floor - 16 * DBL_EPSILON * size;
  return std::max(1.0, of_input / (16 * DBL_EPSILON * scale));
}

double distance(const Quaterniond& a, const Quaterniond& b) {
  return std::min((a.coeffs() - b.coeffs()).norm(), (a.coeffs() + b.coeffs()).norm());
}

// Next to a switch an output may be before it or after it.
bool near_switch(const Expected& expected, double time, double accuracy) {
  constexpr double slack = 10;
  return std::any_of(expected.switches.begin(), expected.switches.end(), [&](const ExpectedSwitch& event) {
    return time > 0 && std::abs(event.time - time) <= slack * (accuracy + DBL_EPSILON) * (1 + time) + 1e-12;
  });
}

class Comparison {
 public:
  Comparison(const SolvedScene& solved, double accuracy, Delivered& delivered)
      : solved_(solved), accuracy_(accuracy), scale_(solved.scene), delivered_(delivered) {}

  void add(const State& found, const ExpectedState& state) {
    scale_.see(state);
    if (near_switch(solved_.expected, state.time, accuracy_)) return;
    const double radius = solved_.scene.sphere.radius;
    keep((found.position - state.position).norm(), scale_.way(),
         condition(scale_.way(), state.position_tolerance, state.position.norm()), state.position_tolerance,
         {"position", state.time});
    keep((found.twist.velocity - state.twist.velocity).norm(), scale_.speed(),
         condition(scale_.speed(), state.velocity_tolerance, 0), state.velocity_tolerance,
         {"velocity", state.time});
    const double floor = radius * state.spin_tolerance;
    keep(radius * (found.twist.angular_velocity - state.twist.angular_velocity).norm(), scale_.speed(),
         condition(scale_.speed(), floor, 0), floor, {"spin", state.time});
    if (!state.orientation) return;
    const double turned = 0.5 * scale_.turned();
    keep(distance(found.orientation, *state.orientation), turned,
         condition(turned, state.orientation_tolerance, 0), state.orientation_tolerance,
         {"orientation", state.time});
  }

 private:
  struct What {
    const char* name;
    double time;
  };

  void keep(double error, double scale, double condition, double floor, const What& what) {
    delivered_.error = std::max(delivered_.error, (error - floor) / (scale * condition));
    const double ratio = error / (accuracy_ * scale * condition + floor);
    if (ratio <= delivered_.worst) return;
    delivered_.worst = std::isnan(ratio) ? HUGE_VAL : ratio;
    delivered_.where = std::string(what.name) + " at t = " + std::to_string(what.time);
  }

  const SolvedScene& solved_;
  double accuracy_;
  Scale scale_;
  Delivered& delivered_;
};

}  // namespace

namespace {

std::size_t count_switches(const scene::Scene& scene, double until) {
  Simulation simulation(scene);
  simulation.advance_to(until, [](const Switch&) {});
  return simulation.switches();
}

/// Whether the number of switches is another one where the initial velocity is turned or stretched by a part.
bool hangs_on_less(const SolvedScene& solved, double part) {
  const double until = solved.expected.states.back().time;
  for (const Vector2d& change :
       {Vector2d(part, 0), Vector2d(-part, 0), Vector2d(0, part), Vector2d(0, -part)}) {
    scene::Scene scene = solved.scene;
    const Vector2d& v = solved.scene.initial_state.velocity;
    scene.initial_state.velocity += change.x() * v + change.y() * turned(v);
    if (count_switches(scene, until) != solved.expected.switches.size()) return true;
  }
  return false;
}

}  // namespace

std::vector<SolvedScene> solved_scenes() {
  std::vector<SolvedScene> scenes;
  for (const std::string folder : {"oracle", "reference"}) {
    for (const std::string& name : yaml_files(folder)) {
      const std::string path = std::string(TEST_DATA_DIR) + "/" + folder + "/" + name;
      scenes.push_back({name, scene::read_scene(scene::tree_from_yaml_file(path + ".yaml")),
                        read_expected(path + ".expected.yaml")});
    }
  }
  return scenes;
}

Delivered deliver(const SolvedScene& solved, const scene::Solver& solver) {
  scene::Scene scene = solved.scene;
  scene.solver = solver;
  Delivered delivered;
  std::size_t switches = 0;
  Simulation simulation(scene);
  Comparison comparison(solved, solver.accuracy, delivered);
  try {
    for (const ExpectedState& state : solved.expected.states) {
      simulation.advance_to(state.time, [&switches](const Switch&) { ++switches; });
      comparison.add(simulation.state(), state);
    }
  } catch (const HaltedError& error) {
    if (!solved.expected.halted_at) delivered.halt = error.what();
  }
  delivered.other_switches = !solved.expected.halted_at && switches != solved.expected.switches.size();
  delivered.hangs_on_less = delivered.other_switches && hangs_on_less(solved, solver.accuracy);
  delivered.estimate = simulation.estimated_error();
  delivered.evaluations = simulation.evaluations();
  return delivered;
}

}  // namespace hybrid_sphere::testing
