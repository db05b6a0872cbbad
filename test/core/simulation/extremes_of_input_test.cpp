// Numbers at the ends of binary64: denormals, signed zeros, and what lies outside of the ranges.

#include <gtest/gtest.h>

#include <cfloat>

#include "scene/read_tree.hpp"
#include "scene/yaml.hpp"
#include "support/recorded.hpp"

namespace hybrid_sphere::testing::extremes_of_input_test {
namespace {

scene::Scene onto_rough() {
  scene::Scene scene{};
  scene.sphere = {2, 0.25, 0.25 * std::sqrt(0.4)};
  scene.surface.regions = {{"half", scene::HalfPlane{{0, 0}, {1, 0}}, scene::Law::rough}};
  return scene;
}

bool is_finite(const State& state) {
  return state.position.allFinite() && state.orientation.coeffs().allFinite() &&
         state.twist.velocity.allFinite() && state.twist.angular_velocity.allFinite() &&
         state.slip.allFinite();
}

/// Either every number is finite, or the computation says why it goes no further.
void expect_finite_or_refused(const scene::Scene& scene, const std::string& what) {
  const Record found = record(scene, 2, 4);
  ASSERT_FALSE(found.states.empty()) << what;
  for (const RecordedState& state : found.states) {
    EXPECT_TRUE(is_finite(state) && state.reaction.allFinite()) << what << " at " << state.time;
  }
  for (const RecordedSwitch& event : found.switches) {
    EXPECT_TRUE(event.impulse.allFinite() && std::isfinite(event.energy_after)) << what;
  }
}

TEST(DenormalVelocities, LeadOntoRoughGroundAsOthersDo) {
  scene::Scene scene = onto_rough();
  scene.initial_state.position = {-1e-310, 0};
  scene.initial_state.velocity = {1e-310, 0};
  const Record found = record(scene, 2, 2);
  ASSERT_EQ(found.switches.size(), 1U);
  // A denormal number is a whole multiple of 2^-1074: each velocity is right to a few of those.
  EXPECT_EQ(found.switches[0].time, 1.0);
  EXPECT_NEAR(found.states[2].twist.velocity.x() / 1e-310, 5.0 / 7.0, 8 * DBL_TRUE_MIN / 1e-310);
  EXPECT_NEAR(found.states[2].position.x() / 1e-310, 5.0 / 7.0, 8 * DBL_TRUE_MIN / 1e-310);
}

TEST(DenormalSpins, KeepTheOrientationAUnitQuaternion) {
  scene::Scene scene = onto_rough();
  scene.initial_state.angular_velocity = {1e-310, -1e-312, DBL_TRUE_MIN};
  const Record found = record(scene, 1e9, 2);
  EXPECT_EQ(found.halt, "");
  EXPECT_EQ(found.states[2].orientation.coeffs().norm(), 1);
}

TEST(SignedZeros, AreZeros) {
  scene::Scene scene = onto_rough();
  const Record zeros = record(scene, 1, 2);
  scene.initial_state = {{-0.0, -0.0}, {1, -0.0, -0.0, -0.0}, {-0.0, -0.0}, {-0.0, -0.0, -0.0}};
  const Record found = record(scene, 1, 2);
  ASSERT_EQ(found.switches.size(), zeros.switches.size());
  for (std::size_t i = 0; i < found.states.size(); ++i) {
    EXPECT_EQ(found.states[i].position, zeros.states[i].position);
    EXPECT_EQ(found.states[i].orientation.coeffs(), zeros.states[i].orientation.coeffs());
    EXPECT_EQ(found.states[i].mode, Mode::resting);
    EXPECT_EQ(found.states[i].name, zeros.states[i].name);
  }
}

TEST(ExtremesOfInput, ASphereOnAnEdgeWithAVelocityOfMinusZeroMovesNowhere) {
  scene::Scene scene = onto_rough();
  scene.initial_state.velocity = {-0.0, 1};
  const Record found = record(scene, 1, 1);
  EXPECT_EQ(found.states[1].position.x(), 0);
  EXPECT_EQ(found.states[1].name, "half");
}

TEST(Motion, HasNoNumberThatIsNotFiniteAtTinySpeeds) {
  for (const double speed : {DBL_TRUE_MIN, 1e-310, 1e-300, 1e-160, 1e-100, 1e-20}) {
    for (int kind = 0; kind < 6; ++kind) {
      scene::Scene scene = onto_rough();
      scene::Material& ground = scene.surface.regions[0].material;
      scene.initial_state.velocity = {speed, -speed};
      if (kind == 1) scene.forces.drag.translational = 1;
      if (kind == 2) scene.forces.drag.quadratic = 1;
      if (kind == 3) scene.forces.spring.stiffness = 1;
      if (kind == 4) ground.turntable_rate = 1;
      if (kind == 5) {
        ground.law = scene::Law::coulomb;
        ground.friction = 0.2;
      }
      expect_finite_or_refused(scene, std::to_string(kind) + " at " + std::to_string(speed) + " m/s");
    }
  }
}

TEST(Coefficient, MayBeDenormal) {
  const double tiny = 1e-310;
  std::vector<scene::Scene> scenes(7, onto_rough());
  for (scene::Scene& scene : scenes) {
    scene.initial_state.position = {-1, 0};
    scene.initial_state.velocity = {2, 0.5};
  }
  scenes[0].forces.gravity.x() = tiny;
  scenes[1].forces.drag.translational = tiny;
  scenes[2].forces.drag.rotational = tiny;
  scenes[3].forces.spring.stiffness = tiny;
  scenes[4].surface.regions[0].material.turntable_rate = tiny;
  scenes[5].surface.regions[0].material.rolling_resistance = tiny;
  scenes[6].surface.regions[0].material.belt = {tiny, -0.0};
  const Record without = [&] {
    scene::Scene scene = scenes[0];
    scene.forces.gravity.x() = 0;
    return record(scene, 2, 4);
  }();
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    const Record found = record(scenes[i], 2, 4);
    ASSERT_EQ(found.halt, "") << i;
    for (std::size_t j = 0; j < found.states.size(); ++j) {
      // An effect of 1e-310 is below the rounding of every sum that it goes into: a few ulp of a way of 4 m.
      EXPECT_LE((found.states[j].position - without.states[j].position).norm(), 16 * DBL_EPSILON) << i;
    }
  }
}

struct Refusal {
  const char* key;   ///< path that the message begins with
  const char* text;  ///< of the scene, with the number past the limit
};

// The limits of docs/scene_files.md, each a little past.
const Refusal refusals[] = {
    {"sphere.mass", "sphere: {mass: 1.0e+61, radius: 1, body: solid}"},
    {"sphere.mass", "sphere: {mass: 1.0e-61, radius: 1, body: solid}"},
    {"sphere.mass", "sphere: {mass: 1.0e-310, radius: 1, body: solid}"},
    {"sphere.radius", "sphere: {mass: 1, radius: 1.0e-13, body: solid}"},
    {"sphere.radius", "sphere: {mass: 1, radius: 1.0e+13, body: solid}"},
    {"sphere.radius", "sphere: {mass: 1, radius: -0.0, body: solid}"},
    {"sphere.gyration_radius", "sphere: {mass: 1, radius: 1, gyration_radius: 1.0e-10}"},
    {"sphere.gyration_radius", "sphere: {mass: 1, radius: 1, gyration_radius: 0.8165}"},
    {"initial_state.velocity", "initial_state: {velocity: [1.1e+15, 0]}"},
    {"initial_state.position", "initial_state: {position: [0, -1.1e+15]}"},
    {"initial_state.angular_velocity", "initial_state: {angular_velocity: [0, 0, .inf]}"},
    {"initial_state.velocity", "initial_state: {velocity: [.nan, 0]}"},
    {"surface.regions[0].friction",
     "surface: {regions: [{name: a, circle: {center: [0, 0], radius: 1}, law: coulomb, friction: 1.1e+9}]}"},
    {"surface.regions[0].friction",
     "surface: {regions: [{name: a, circle: {center: [0, 0], radius: 1}, law: coulomb, friction: "
     "-1.0e-310}]}"},
    {"surface.regions[0].circle.radius",
     "surface: {regions: [{name: a, circle: {center: [0, 0], radius: 1.0e-13}, law: rough}]}"},
    {"drag.translational", "drag: {translational: 1.1e+15}"},
    {"drag.quadratic", "drag: {quadratic: 1.1e+15}"},
    {"spring.stiffness", "spring: {stiffness: 1.1e+15}"},
    {"gravity", "gravity: [0, 0, -1.1e+15]"},
    {"solver.accuracy", "solver: {accuracy: 1.0e-15}"},
    {"solver.method", "solver: {method: guess}"},
};

TEST(ExtremesOfInput, ANumberPastItsLimitIsRefusedByItsKeyWithWhatIsAllowed) {
  for (const Refusal& refusal : refusals) {
    const std::string sphere =
        std::string(refusal.key).find("sphere") == 0 ? "" : "sphere: {mass: 1, radius: 1, body: solid}\n";
    try {
      scene::read_scene(scene::tree_from_yaml(sphere + refusal.text));
      ADD_FAILURE() << "not refused: " << refusal.text;
    } catch (const scene::SceneError& error) {
      const std::string message = error.what();
      EXPECT_EQ(message.find(refusal.key), 0U) << message;
      EXPECT_NE(message.find("allowed: "), std::string::npos) << message;
    }
  }
}

TEST(ExtremesOfInput, ATimeThatIsNotFiniteIsRefused) {
  Simulation simulation(onto_rough());
  for (const double time : {-1.0, -DBL_TRUE_MIN, HUGE_VAL, std::nan("")}) {
    EXPECT_THROW(simulation.advance_to(time, {}), std::invalid_argument) << time;
  }
  EXPECT_EQ(simulation.time(), 0);
}

}  // namespace
}  // namespace hybrid_sphere::testing::extremes_of_input_test
