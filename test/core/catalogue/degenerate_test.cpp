// The degenerate systems d1 to d7 of test/data/mechanics/general_systems.json, each with the answer described
// there.

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <limits>
#include <map>
#include <set>
#include <utility>

#include "catalogue/catalogue.hpp"
#include "hybrid_sphere/mechanics/solve.hpp"
#include "hybrid_sphere/mechanics/system.hpp"

namespace hybrid_sphere::mechanics::catalogue::testing::degenerate_test {
namespace {

constexpr double accuracy = 1e-10;

double largest(const Eigen::MatrixXd& matrix) { return matrix.cwiseAbs().maxCoeff(); }

Solution solved(const Model& model, const Initial& initial, double duration) {
  Options options;
  options.accuracy = accuracy;
  return solve(model, initial, duration, options);
}

// An entry as a rule, without its constraints.
struct Base {
  explicit Base(const std::string& name, const std::map<std::string, double>& numbers = {})
      : values(entry(name).parameters) {
    for (const auto& [key, value] : numbers) values.set(key, value);
    example = entry(name).build(values);
    t_switch = values["t_switch"];
    duration = entry(name).duration;
  }

  template <class... Constraints>
  Model with(Constraints... constraints) const {
    Model model = example.model;
    model.constraints = {{constraints.first,
                          constraints.second,
                          {t_switch, std::numeric_limits<double>::infinity(), nullptr}}...};
    return model;
  }

  Values values;
  Example example;
  double t_switch = 0;
  double duration = 0;
};

template <int n, class Function>
std::pair<std::string, std::shared_ptr<const ConstraintFunction>> named(const std::string& name, Function f) {
  return {name, automatic_constraint<n, n>("constraint " + name, std::move(f))};
}

const auto slope = [](auto /*t*/, const auto& q, const auto& v) { return v[2] - q[1] * v[0]; };

// What a motion that cannot go on says: why, when, and about which constraints.
void expect_stop(const Solution& solution, Stop why, double time, const std::vector<std::string>& names) {
  EXPECT_EQ(solution.status().stop, why) << to_string(solution.status().stop);
  EXPECT_EQ(solution.status().time, time) << solution.status().message;
  EXPECT_EQ(solution.end(), time);
  for (const std::string& name : names) {
    EXPECT_NE(solution.status().message.find(name), std::string::npos) << solution.status().message;
  }
  // All up to there is known.
  EXPECT_EQ(solution.at(solution.end()).time, time);
  EXPECT_TRUE(solution.switches().empty());
}

TEST(DegenerateSystem, OfDuplicatedConstraintsMovesAsUnderOne) {  // d1
  const Base base("nonholonomic_particle");
  const Model model =
      base.with(named<3>("once", slope),
                named<3>("twice", [](auto t, const auto& q, const auto& v) { return 2.0 * slope(t, q, v); }));
  const Solution solution = solved(model, base.example.initial, base.duration);
  ASSERT_EQ(solution.status().stop, Stop::reached_end) << solution.status().message;
  ASSERT_EQ(solution.switches().size(), 1u);
  EXPECT_EQ(solution.switches()[0].rank, 1);
  const Solution single = solved(base.example.model, base.example.initial, base.duration);
  const Switch& both = solution.switches()[0];
  const Switch& one = single.switches().at(0);
  EXPECT_LE(largest(both.v_after - one.v_after), accuracy * largest(one.v_after));
  // lambda C = lambda1 C + lambda2 2 C with the least lambda1^2 + lambda2^2.
  const Vector shares = Eigen::Vector2d(1, 2) / 5;
  EXPECT_LE(largest(both.multipliers - shares * one.multipliers[0]), accuracy * std::abs(one.multipliers[0]));
  for (int i = 0; i <= 50; ++i) {
    const double t = base.duration * i / 50;
    const State state = solution.at(t);
    const Known known = base.example.known(t).value();
    EXPECT_LE(largest(state.q - known.q), accuracy * largest(known.q)) << "t = " << t;
    EXPECT_LE(largest(state.v - known.v), accuracy * largest(known.v)) << "t = " << t;
    const double lambda = (*known.multipliers)[0];
    EXPECT_LE(largest(state.multipliers - shares * lambda), accuracy * (1 + std::abs(lambda))) << "t = " << t;
  }
}

TEST(DegenerateSystem, OfContradictoryConstraintsIsRefusedByTheirNames) {  // d2
  const Base base("nonholonomic_particle");
  const auto rest = [](auto /*t*/, const auto& /*q*/, const auto& v) { return v[0]; };
  const auto one = [](auto /*t*/, const auto& /*q*/, const auto& v) { return v[0] - 1.0; };
  const auto other = [](auto /*t*/, const auto& /*q*/, const auto& v) { return v[2]; };
  const Solution solution =
      solved(base.with(named<3>("at_rest", rest), named<3>("bystander", other), named<3>("at_one", one)),
             base.example.initial, base.duration);
  expect_stop(solution, Stop::inconsistent, base.t_switch, {"at_rest", "at_one"});
  EXPECT_EQ(solution.status().message.find("bystander"), std::string::npos) << solution.status().message;
}

TEST(DegenerateSystem, OfAConstraintThatHasNoDirectionAtRestSaysSo) {  // d3
  const Base base("appell_hamel", {{"x_dot", 0}, {"y_dot", 0}, {"z_dot", 0}, {"t_switch", 0}});
  for (const Model* model : {&base.example.model, &base.example.by_hand}) {
    const Solution solution = solved(*model, base.example.initial, base.duration);
    expect_stop(solution, Stop::no_direction, 0, {"slope"});
  }
}

TEST(DegenerateSystem, OfAConstraintWithoutVelocitiesSaysSo) {  // d4
  const Base base("nonholonomic_particle");
  const auto surface = [](auto /*t*/, const auto& q, const auto& /*v*/) { return q[2] - q[0] * q[1]; };
  const Solution solution =
      solved(base.with(named<3>("surface", surface)), base.example.initial, base.duration);
  expect_stop(solution, Stop::no_direction, base.t_switch, {"surface"});
}

TEST(DegenerateSystem, OfEulerAnglesAtTheirSingularityIsSingular) {  // d5
  const Base base("turntable_ball", {{"x", 0.75}, {"y", -0.25}, {"theta", 0}});
  for (const Model* model : {&base.example.model, &base.example.by_hand}) {
    const Solution solution = solved(*model, base.example.initial, base.duration);
    expect_stop(solution, Stop::singular, 0, {});
  }
}

TEST(DegenerateSystem, ThatSatisfiesItsConstraintAlreadyHasNoImpulse) {  // d6
  const Base base(
      "nonholonomic_particle",
      {{"x", 0.25}, {"y", -1.25}, {"z", 0}, {"x_dot", 1}, {"y_dot", 0.75}, {"z_dot", -0.5}, {"t_switch", 1}});
  for (const Model* model : {&base.example.model, &base.example.by_hand}) {
    const Solution solution = solved(*model, base.example.initial, base.duration);
    ASSERT_EQ(solution.switches().size(), 1u) << solution.status().message;
    const Switch& change = solution.switches()[0];
    EXPECT_EQ(change.time, 1);
    EXPECT_EQ(change.multipliers[0], 0);
    EXPECT_EQ(largest(change.impulse), 0);
    EXPECT_EQ(largest(change.v_after - change.v_before), 0);
    EXPECT_EQ(change.kinetic_energy_after, change.kinetic_energy_before);
    EXPECT_EQ(solution.status().stop, Stop::reached_end);
  }
}

TEST(DegenerateSystem, WithoutARealVelocityEndsThere) {  // d7
  const Base base("constant_speed");
  const double c = base.values["c"];
  const auto speed = [c](auto /*t*/, const auto& /*q*/, const auto& v) {
    return v[0] * v[0] + v[1] * v[1] + c * c;
  };
  const Solution solution =
      solved(base.with(named<2>("imaginary", speed)), base.example.initial, base.duration);
  expect_stop(solution, Stop::no_velocity, base.t_switch, {"imaginary"});
}

TEST(DegenerateSystem, IsOneOfThoseTestedHere) {
  const std::set<std::string> tested = {
      "d1_duplicated_constraint", "d2_contradictory_constraints", "d3_zero_gradient", "d4_no_velocity",
      "d5_singular_mass_matrix",  "d6_already_satisfied",         "d7_no_real_root"};
  std::set<std::string> described;
  const YAML::Node file = YAML::LoadFile(std::string(TEST_DATA_DIR) + "/mechanics/general_systems.json");
  for (const YAML::Node& system : file["degenerate"]) described.insert(system["name"].as<std::string>());
  EXPECT_EQ(described, tested);
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::catalogue::testing::degenerate_test
