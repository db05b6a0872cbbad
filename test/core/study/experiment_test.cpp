// What a run of a study leaves is what a simulation of its own gives for its scene, written as a file and
// read again, to the bit.

#include "study/experiment.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/study/studies.hpp"
#include "hybrid_sphere/scene/read_scene.hpp"
#include "scene/tree_place.hpp"

namespace hybrid_sphere::testing::experiment_test {
namespace {

/// What a run should leave: each number from a simulation of its own, that stops nowhere on its way.
class Expected {
 public:
  Expected(const Study& study, const scene::Scene& scene) : study_(study), scene_(scene) {}

  std::vector<double> numbers(const std::vector<double>& sample) {
    numbers_ = sample;
    Simulation simulation(scene_);
    const std::optional<HaltedError> halt = halt_of(simulation);
    add(halt ? 1 : 0);
    add(halt ? static_cast<double>(halt->stop()) : -1);
    add(halt ? halt->time() : missing);
    for (const StateField field : study_.keep.end) {
      if (halt) add_missing(field);
      if (!halt) add_state(field, simulation);
    }
    for (const StateField field : study_.keep.at) {
      for (const double time : study_.keep.times) add_at(field, time);
    }
    add_switches();
    for (const std::string& region : study_.keep.entered) {
      const auto first =
          std::find_if(told_.begin(), told_.end(), [&](const auto& told) { return told.second == region; });
      add(first == told_.end() ? missing : first->first);
    }
    for (const Extreme extreme : study_.keep.extremes) add(halt ? missing : greatest(extreme));
    return numbers_;
  }

 private:
  static constexpr double missing = std::numeric_limits<double>::quiet_NaN();

  void add(double number) { numbers_.push_back(number); }
  template <class Vector>
  void add_vector(const Vector& vector) {
    for (Eigen::Index i = 0; i < vector.size(); ++i) add(vector[i]);
  }

  std::optional<HaltedError> halt_of(Simulation& simulation) {
    simulation.set_region_sink(
        [&](double time, std::string_view region) { told_.emplace_back(time, region); });
    try {
      simulation.advance_to(study_.duration, [&](const Switch& event) { switches_.push_back(event); });
      return std::nullopt;
    } catch (const HaltedError& error) {
      return error;
    }
  }

  void add_missing(StateField field) {
    switch (field) {
      case StateField::position:
      case StateField::velocity:
      case StateField::slip: return add_vector(Vector2d(missing, missing));
      case StateField::angular_velocity: return add_vector(Vector3d(missing, missing, missing));
      case StateField::orientation: return add_vector(Eigen::Vector4d(missing, missing, missing, missing));
      case StateField::energy: return add(missing);
      default: return add(-1);
    }
  }

  void add_state(StateField field, Simulation& simulation) {
    const State& state = simulation.state();
    switch (field) {
      case StateField::position: return add_vector(state.position);
      case StateField::velocity: return add_vector(state.twist.velocity);
      case StateField::angular_velocity: return add_vector(state.twist.angular_velocity);
      case StateField::orientation: return add_vector(state.orientation.coeffs());
      case StateField::slip: return add_vector(state.slip);
      case StateField::energy: return add(simulation.sphere().kinetic_energy(state.twist));
      case StateField::stage: return add(static_cast<double>(state.stage));
      case StateField::mode: return add(static_cast<double>(state.mode));
      case StateField::region: return add(code_of(state.region));
    }
  }

  double code_of(std::string_view region) const {
    if (region == scene::base_name) return 0;
    for (std::size_t i = 0; i < scene_.surface.regions.size(); ++i) {
      if (scene_.surface.regions[i].name == region) return static_cast<double>(i + 1);
    }
    return -1;
  }

  void add_at(StateField field, double time) {
    Simulation simulation(scene_);
    try {
      simulation.advance_to(time);
    } catch (const HaltedError&) {
      return add_missing(field);
    }
    add_state(field, simulation);
  }

  void add_switches() {
    if (!study_.keep.switches) return;
    const std::uint64_t first = *study_.keep.switches;
    add(static_cast<double>(switches_.size()));
    const auto add_each = [&](const auto& value, int size, double none) {
      for (std::size_t i = 0; i < first; ++i) {
        for (int k = 0; k < size; ++k) add(i < switches_.size() ? value(switches_[i], k) : none);
      }
    };
    add_each([](const Switch& event, int) { return event.time; }, 1, missing);
    add_each([](const Switch& event, int) { return static_cast<double>(event.kind); }, 1, -1);
    add_each([](const Switch& event, int) { return static_cast<double>(event.cause); }, 1, -1);
    add_each([](const Switch& event, int k) { return event.impulse[k]; }, 2, missing);
  }

  /// Over the instants, the end, and both sides of each switch.
  double greatest(Extreme extreme) {
    double greatest = 0;
    if (extreme == Extreme::energy_lost) {
      for (const Switch& event : switches_) greatest += event.energy_before - event.energy_after;
      return greatest;
    }
    const auto note = [&](const Twist& twist, double slip) {
      const double value = extreme == Extreme::speed  ? twist.velocity.norm()
                           : extreme == Extreme::spin ? twist.angular_velocity.norm()
                                                      : slip;
      greatest = std::max(greatest, value);
    };
    for (const Switch& event : switches_) {
      note(event.before, event.slip_before.norm());
      note(event.after, 0);
    }
    const std::uint64_t instants = std::max<std::uint64_t>(study_.keep.instants, 1);
    Simulation simulation(scene_);
    for (std::uint64_t i = 0; i <= instants; ++i) {
      simulation.advance_to(static_cast<double>(i) / static_cast<double>(instants) * study_.duration);
      note(simulation.state().twist, simulation.state().slip.norm());
    }
    return greatest;
  }

  const Study& study_;
  const scene::Scene& scene_;
  std::vector<double> numbers_;
  std::vector<Switch> switches_;
  std::vector<std::pair<double, std::string>> told_;
};

struct Outcomes {
  int done = 0;
  int halted = 0;
  int refused = 0;
};

/// Runs all of a study and compares.
Outcomes expect_as_simulated(const std::string& yaml, const std::string& directory = "") {
  const Study study = read_study_text(yaml, directory);
  Experiment experiment(study);
  Chunk chunk(experiment.columns().all);
  experiment.run(0, study.runs, chunk, go_on);
  const std::size_t variables = study.variables.size();
  std::vector<double> samples(study.runs * variables);
  Samples(study).values(0, study.runs, samples.data());
  Outcomes outcomes;
  for (std::uint64_t run = 0; run < study.runs; ++run) {
    const std::vector<double> found = numbers_of_run(experiment.columns().all, chunk, run);
    const std::vector<double> sample(samples.begin() + static_cast<std::ptrdiff_t>(run * variables),
                                     samples.begin() + static_cast<std::ptrdiff_t>((run + 1) * variables));
    const std::string file = to_yaml(experiment.scene_of_run(run));
    std::optional<scene::Scene> scene;
    try {
      scene = scene::read_scene_text(file, study.scene_directory);
    } catch (const scene::SceneError&) {
      EXPECT_EQ(found[variables], static_cast<double>(Outcome::refused)) << file;
      ++outcomes.refused;
      continue;
    }
    const std::vector<double> expected = Expected(study, *scene).numbers(sample);
    EXPECT_TRUE(are_same(found, expected)) << "run " << run << ": " << ::testing::PrintToString(found)
                                           << "\nexpected: " << ::testing::PrintToString(expected);
    ++(found[variables] == 0 ? outcomes.done : outcomes.halted);
  }
  return outcomes;
}

const std::string keep_early =
    "keep: {end: [position], at: {times: [0.00001, 1], fields: [velocity]}, switches: {first: 3}, extremes: "
    "[slip]}\n";

TEST(Run, IsASimulationWhereTheInitialStateVaries) {
  EXPECT_EQ(expect_as_simulated(study_of(floor, start, 60, 1)).done, 60);
}

TEST(Run, IsASimulationWhereTheSurfaceVaries) {
  const Outcomes outcomes = expect_as_simulated(
      study_of(floor,
               start + "  surface.base.friction: {uniform: [-0.05, 0.5]}\n"
                       "  surface.regions[belt].belt[0]: {uniform: [-2, 2]}\n"
                       "  surface.regions[ice].half_plane.point[0]: {uniform: [0.5, 1.5]}\n"
                       "  surface.regions[ice again].circle.radius: {uniform: [0.1, 2]}\n"
                       "  surface.regions[belt].polygon[1][0]: {uniform: [0.2, 3]}\n",
               40, 2));
  EXPECT_GT(outcomes.done, 25);
  EXPECT_GT(outcomes.refused, 0);
}

TEST(Run, IsASimulationWhereTheSphereVaries) {
  const Outcomes outcomes =
      expect_as_simulated(study_of(floor,
                                   start + "  sphere.radius: {uniform: [-0.1, 1]}\n  sphere.mass: "
                                           "{lognormal: {median: 1, log_deviation: 1}}\n",
                                   40, 3));
  EXPECT_GT(outcomes.done, 25);
  EXPECT_GT(outcomes.refused, 0);
}

TEST(Run, IsASimulationWhereForcesVary) {
  EXPECT_EQ(expect_as_simulated(study_of(floor,
                                         "  gravity[0]: {uniform: [-1, 1]}\n"
                                         "  drag.translational: {uniform: [0, 1]}\n"
                                         "  wrench.torque[2]: {uniform: [-1, 1]}\n"
                                         "  spring.stiffness: {values: [0, 1]}\n"
                                         "  initial_state.orientation[0]: {uniform: [-0.01, 0.01]}\n",
                                         12, 4))
                .done,
            12);
}

TEST(Run, IsASimulationInACorrelatedSample) {
  EXPECT_EQ(expect_as_simulated(
                study_of(floor, start, 20, 1) +
                "correlate: [{variables: ['initial_state.position[1]', 'initial_state.velocity[0]'], "
                "covariance: [[0.25, -0.2], [-0.2, 0.25]]}]\n")
                .done,
            20);
}

const std::string against =
    "scene:\n"
    "  sphere: {mass: 1, radius: 0.25, gyration_radius: 0.15}\n"
    "  initial_state: {position: [-0.5, 0], velocity: [0.25, 0.25], angular_velocity: [0, 0, 1]}\n"
    "  surface:\n"
    "    base: {law: rough, belt: [1, 0.25]}\n"
    "    regions:\n"
    "      - {name: right, half_plane: {point: [0, 0], normal: [1, 0]}, law: rough, belt: [-1, 0.5]}\n"
    "    livelock: stop\n";

TEST(Run, HaltsWhereASimulationHaltsAndTheNextOneGoesOn) {
  const Outcomes outcomes = expect_as_simulated(
      study_of(against, "  initial_state.position[0]: {uniform: [-3, 1]}\n", 60, 1, "[right, base]"));
  EXPECT_GT(outcomes.halted, 10);
  EXPECT_GT(outcomes.done, 10);
  const Outcomes others = expect_as_simulated(
      study_of(against, "  surface.regions[right].belt[0]: {uniform: [-1, 1]}\n", 30, 1, "[right, base]"));
  EXPECT_GT(others.halted, 2);
  EXPECT_GT(others.done, 5);
}

TEST(Run, HaltsWhereSwitchesAccumulate) {
  // Spin about the normal leaves the path as it is.
  const auto outcomes_of = [](const std::string& name) {
    return expect_as_simulated(
        "scene: " + name +
            ".yaml\nruns: 2\nduration: 1\nvary: {'initial_state.angular_velocity[2]': {uniform: [-1, 1]}}\n" +
            keep_early,
        std::string(TEST_DATA_DIR) + "/accumulation");
  };
  EXPECT_EQ(outcomes_of("chatter_of_throws_within_rounding").halted, 2);
  EXPECT_EQ(outcomes_of("chatter_through_a_corner").done, 2);
}

TEST(Run, IsASimulationOfEachMethod) {
  for (const char* method : {"rk4", "dopri5", "cvode_adams", "exact"}) {
    EXPECT_EQ(
        expect_as_simulated(study_of(floor + "  solver: {method: " + method + ", step: 0.01}\n", start, 4, 5))
            .done,
        4)
        << method;
  }
}

TEST(Run, IsASimulationOfDurationZero) {
  const std::string yaml =
      floor + "runs: 3\nduration: 0\nvary:\n" + start +
      "keep: {end: [position, region], at: {times: [0], fields: [velocity]}, switches: {first: 1}, "
      "entered: [base], extremes: [speed, slip]}\n";
  EXPECT_EQ(expect_as_simulated(yaml).done, 3);
}

}  // namespace
}  // namespace hybrid_sphere::testing::experiment_test
