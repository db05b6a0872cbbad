// The whole engine on every entry of the catalogue, at two accuracies and with both kinds of derivatives.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>
#include <utility>

#include "core/catalogue/reference_systems.hpp"
#include "hybrid_sphere/mechanics/solve.hpp"

namespace hybrid_sphere::mechanics::catalogue::testing::runs_test {
namespace {

constexpr double unit = 0x1p-53;  // rounding of one operation, relative

double largest(const Eigen::MatrixXd& matrix) {
  return matrix.size() == 0 ? 0 : matrix.cwiseAbs().maxCoeff();
}

Solution solved(const Model& model, const Initial& initial, double duration, double accuracy) {
  Options options;
  options.accuracy = accuracy;
  return solve(model, initial, duration, options);
}

// What a run is relative to: the largest coordinate, velocity and multiplier that it has.
struct Scale {
  double q = 0;
  double v = 0;
  double multipliers = 0;

  void see(const Vector& some_q, const Vector& some_v, const Vector& some_multipliers) {
    q = std::max(q, largest(some_q));
    v = std::max(v, largest(some_v));
    multipliers = std::max(multipliers, largest(some_multipliers));
  }
};

// The largest deviations of a run, relative to its scale.
struct Deviation {
  double q = 0;
  double v = 0;
  double multipliers = 0;

  void see(const State& state, const Vector& some_q, const Vector& some_v, const Vector& some_multipliers) {
    q = std::max(q, largest(state.q - some_q));
    v = std::max(v, largest(state.v - some_v));
    multipliers = std::max(multipliers, largest(state.multipliers - some_multipliers));
  }
  Deviation relative_to(const Scale& scale) const {
    const auto ratio = [](double part, double whole) { return whole > 0 ? part / whole : part; };
    return {ratio(q, scale.q), ratio(v, scale.v), ratio(multipliers, scale.multipliers)};
  }
};

void expect_within(const Deviation& deviation, double accuracy) {
  EXPECT_LE(deviation.q, accuracy) << "q";
  EXPECT_LE(deviation.v, accuracy) << "v";
  EXPECT_LE(deviation.multipliers, accuracy) << "lambda";
}

struct Case {
  std::string entry;
  double accuracy;
  bool by_hand;

  std::string name() const {
    std::ostringstream text;
    text << entry << "_1e" << std::lround(std::log10(1 / accuracy)) << (by_hand ? "_by_hand" : "");
    return text.str();
  }
};
std::ostream& operator<<(std::ostream& stream, const Case& which) { return stream << which.name(); }

std::vector<Case> cases(const std::vector<std::string>& names) {
  std::vector<Case> all;
  for (const std::string& name : names) {
    for (const double accuracy : {1e-6, 1e-10}) {
      for (const bool by_hand : {false, true}) all.push_back({name, accuracy, by_hand});
    }
  }
  return all;
}

std::vector<Case> cases_of_entries() {
  std::vector<std::string> names;
  for (const Entry& entry : entries()) names.push_back(entry.name);
  return cases(names);
}

std::vector<Case> cases_of_references() {
  std::vector<std::string> names;
  for (const ReferenceSystem& system : reference_systems()) names.push_back(system.name);
  return cases(names);
}

class CatalogueRun : public ::testing::TestWithParam<Case> {
 protected:
  CatalogueRun()
      : entry_(entry(GetParam().entry)),
        example_(entry_.build(Values(entry_.parameters))),
        model_(GetParam().by_hand ? example_.by_hand : example_.model) {}

  Solution run(double duration) const {
    return solved(model_, example_.initial, duration, GetParam().accuracy);
  }

  // 200 instants that are not next to a switch, where an error of its time is one of the velocity's jump.
  std::vector<double> instants(const Solution& solution) const {
    std::vector<double> times;
    constexpr int count = 200;
    const double spacing = solution.end() / count;
    for (int i = 0; i < count; ++i) {
      const double t = spacing * (i + 0.3719);
      const auto& switches = solution.switches();
      const bool near = std::any_of(switches.begin(), switches.end(), [&](const Switch& change) {
        return std::abs(change.time - t) < 1e-3 * spacing;
      });
      if (!near) times.push_back(t);
    }
    return times;
  }

  // f after the projection is a sum of terms C_s v_s, some tens of operations, at coordinates of their size.
  void expect_on_constraints(const State& state) const {
    double allowed = 0;
    for (const std::size_t i : state.active) {
      Vector value;
      Matrix gradient;
      model_.constraints[i].function->evaluate(state.time, state.q, state.v, value, gradient);
      const double terms = (gradient.cwiseAbs() * state.v.cwiseAbs()).maxCoeff();
      allowed = std::max(allowed, 64 * unit * terms * (1 + largest(state.q)));
      EXPECT_LE(largest(value), allowed) << "t = " << state.time;
    }
    EXPECT_LE(state.residual, allowed) << "t = " << state.time;
  }

  const Entry& entry_;
  Example example_;
  const Model& model_;
};

TEST_P(CatalogueRun, IsAsNearToTheKnownMotionAsAskedFor) {
  const Solution solution = run(entry_.duration);
  ASSERT_EQ(solution.status().stop, Stop::reached_end) << solution.status().message;
  const std::vector<double> times = instants(solution);
  ASSERT_GE(times.size(), 180u);
  // Where nothing is known, a run at the greatest accuracy.
  std::optional<Solution> finest;
  if (!example_.known) finest = solved(model_, example_.initial, entry_.duration, 1e-13);
  Scale scale;
  Deviation deviation;
  for (const double t : times) {
    const State state = solution.at(t);
    Known expected;
    if (finest) {
      const State fine = finest->at(t);
      expected = {fine.q, fine.v, fine.multipliers};
    } else {
      expected = example_.known(t).value();
    }
    scale.see(expected.q, expected.v, expected.multipliers.value());
    deviation.see(state, expected.q, expected.v, *expected.multipliers);
  }
  expect_within(deviation.relative_to(scale), GetParam().accuracy);
}

TEST_P(CatalogueRun, KeepsTheConstraintsToRounding) {
  const Solution solution = run(entry_.duration);
  for (const double t : instants(solution)) expect_on_constraints(solution.at(t));
}

// Entries whose constraints do work on the motion: affine, or nonlinear and inhomogeneous.
const std::set<std::string> works = {"constant_speed", "turntable_ball"};

TEST_P(CatalogueRun, MeetsEachSwitchByTheTheoremOfCarnot) {
  const Solution solution = run(entry_.duration);
  ASSERT_FALSE(solution.switches().empty());
  MotionTerms terms;
  for (const Switch& change : solution.switches()) {
    model_.equations->evaluate(change.time, change.q, change.v_before, terms);
    const Vector p_before = terms.momentum;
    const Matrix M = terms.mass;
    model_.equations->evaluate(change.time, change.q, change.v_after, terms);
    const double momenta = largest(p_before) + largest(terms.momentum);
    EXPECT_LE(largest(change.impulse - (terms.momentum - p_before)), 64 * unit * momenta);

    const Vector lost = change.v_before - change.v_after;
    const double before = change.kinetic_energy_before, after = change.kinetic_energy_after;
    const double of_lost = lost.dot(M * lost) / 2, work = change.impulse.dot(change.v_after);
    const double rounding = 64 * unit * (before + after) * static_cast<double>(lost.size());
    EXPECT_NEAR(before - after, of_lost - work, rounding) << "t = " << change.time;
    if (works.count(entry_.name) == 0) {
      EXPECT_NEAR(before - after, of_lost, rounding) << "t = " << change.time;
    } else {
      EXPECT_GT(std::abs(work), 1e-3 * (before + after)) << "the impulse of this entry works";
    }
    if (change.applied.empty()) {
      EXPECT_EQ(largest(lost), 0) << "t = " << change.time;
    }
  }
}

// A quantity may deviate by what it changes when every coordinate and velocity deviates by the accuracy asked
// for.
double slack(const Model& model, const Invariant& invariant, const State& state, const Scale& scale,
             double accuracy) {
  const auto value_of = [&](const Vector& q, const Vector& v) {
    State moved = state;
    moved.q = q;
    moved.v = v;
    MotionTerms terms;
    model.equations->evaluate(state.time, q, v, terms);
    moved.energy = v.dot(terms.momentum) - terms.lagrangian;
    return invariant.value(moved);
  };
  const double here = value_of(state.q, state.v);
  double sum = 0;
  const auto add = [&](Vector q, Vector v) { sum += std::abs(value_of(q, v) - here); };
  for (Index i = 0; i < state.q.size(); ++i) {
    Vector q = state.q;
    q[i] += accuracy * scale.q;
    add(q, state.v);
  }
  for (Index i = 0; i < state.v.size(); ++i) {
    Vector v = state.v;
    v[i] += accuracy * scale.v;
    add(state.q, v);
  }
  return sum + 64 * unit * std::abs(here);
}

// y = j period/2 for each j, up when applied and when released: y' never changes.
TEST(VisitingParticle, SwitchesAtEachBorderOfItsStrips) {
  const Entry& visiting = entry("visiting_particle");
  const Values values(visiting.parameters);
  const Example example = visiting.build(values);
  for (const double accuracy : {1e-6, 1e-10}) {
    for (const double duration : {visiting.duration, 60.0}) {
      const Solution solution = solved(example.model, example.initial, duration, accuracy);
      const double half = values["period"] / 2;
      const double first = std::ceil(values["y"] / half);
      const double crossed = std::floor((values["y"] + values["y_dot"] * duration) / half) - first + 1;
      ASSERT_EQ(static_cast<double>(solution.switches().size()), crossed) << solution.status().message;
      for (const Switch& change : solution.switches()) {
        const double border = first + static_cast<double>(change.index);
        EXPECT_EQ(change.active.size(), std::fmod(border, 2) == 0 ? 1u : 0u);
        EXPECT_NEAR(change.time, (border * half - values["y"]) / values["y_dot"], accuracy * duration);
      }
    }
  }
}

// 0.3/0.1 is below 3 in binary64, where the border is to rounding: upwards it is left, downwards the strip
// below it begins with an impulse.
TEST(VisitingParticle, StartsOnABorderThatIsThereToRounding) {
  constexpr double accuracy = 1e-10, half = 0.1, speed = 0.75;
  for (const double y_dot : {speed, -speed}) {
    Values values(entry("visiting_particle").parameters);
    for (const auto& [name, value] : {std::pair("period", 2 * half), {"y", 0.3}, {"y_dot", y_dot}}) {
      values.set(name, value);
    }
    const Example example = entry("visiting_particle").build(values);
    const Solution solution = solved(example.model, example.initial, 10 * half / speed, accuracy);
    for (int i = 0; i < 10; ++i) {
      const double t = (i + 0.5) * half / speed;
      const State state = solution.at(t);
      EXPECT_EQ(state.stage == 3, (i % 2 == 0) == (y_dot < 0)) << "t = " << t << ", y' = " << y_dot;
      const std::optional<Known> known = example.known(t);
      ASSERT_TRUE(known) << "t = " << t << ", y' = " << y_dot;
      EXPECT_LE(largest(state.q - known->q), accuracy * largest(known->q)) << "t = " << t;
      EXPECT_LE(largest(state.v - known->v), accuracy * largest(known->v)) << "t = " << t;
    }
  }
}

TEST(VisitingParticle, IsNotKnownBehindTooManyStripsOrTooFarAway) {
  const auto example = [](double period, double y) {
    Values values(entry("visiting_particle").parameters);
    values.set("period", period);
    values.set("y", y);
    return entry("visiting_particle").build(values);
  };
  EXPECT_TRUE(example(1e-9, -1e-10).known(1e-5)) << "15,000 strips";
  EXPECT_FALSE(example(1e-9, -1e-10).known(6));
  EXPECT_TRUE(example(1, -4e8).known(1));
  EXPECT_FALSE(example(1, -1e9).known(1));
}

class LongCatalogueRun : public CatalogueRun {};

TEST_P(LongCatalogueRun, KeepsItsInvariantsOverAThousandCharacteristicTimes) {
  const double duration = entry_.duration + 1000 * entry_.characteristic_time;
  const Solution solution = run(duration);
  ASSERT_EQ(solution.status().stop, Stop::reached_end) << solution.status().message;
  // Where switches follow one another for ever, invariants are those of all of them.
  const auto& switches = solution.switches();
  const double begin = switches.size() < 10 ? switches.back().time : switches.front().time;
  const State first = solution.at(begin);
  Scale scale;
  std::vector<State> states;
  for (int i = 1; i <= 300; ++i) {
    states.push_back(solution.at(begin + (solution.end() - begin) * i / 300));
    expect_on_constraints(states.back());
    scale.see(states.back().q, states.back().v, states.back().multipliers);
  }
  for (const Invariant& invariant : example_.invariants) {
    const double expected = invariant.value(first);
    double worst = 0;
    for (const State& state : states) {
      const double allowed = slack(model_, invariant, state, scale, GetParam().accuracy);
      worst = std::max(worst, std::abs(invariant.value(state) - expected) / allowed);
    }
    EXPECT_LE(worst, 1) << invariant.name << ", relative to what the accuracy allows";
  }
}

INSTANTIATE_TEST_SUITE_P(AllEntries, CatalogueRun, ::testing::ValuesIn(cases_of_entries()),
                         [](const auto& info) { return info.param.name(); });

// Each accuracy and each kind of derivatives once: these runs take seconds.
std::vector<Case> cases_of_long_runs() {
  std::vector<Case> all = cases_of_entries();
  all.erase(std::remove_if(all.begin(), all.end(),
                           [](const Case& which) { return which.by_hand != (which.accuracy < 1e-8); }),
            all.end());
  return all;
}

INSTANTIATE_TEST_SUITE_P(AllEntries, LongCatalogueRun, ::testing::ValuesIn(cases_of_long_runs()),
                         [](const auto& info) { return info.param.name(); });

class ReferenceRun : public ::testing::TestWithParam<Case> {
 protected:
  ReferenceRun()
      : system_(*std::find_if(reference_systems().begin(), reference_systems().end(),
                              [](const ReferenceSystem& system) { return system.name == GetParam().entry; })),
        model_(GetParam().by_hand ? system_.example.by_hand : system_.example.model),
        solution_(solved(model_, system_.example.initial, system_.duration(), GetParam().accuracy)) {}

  const ReferenceSystem& system_;
  const Model& model_;
  Solution solution_;
};

TEST_P(ReferenceRun, IsAsNearToTheReferenceAsAskedFor) {
  ASSERT_EQ(solution_.status().stop, Stop::reached_end) << solution_.status().message;
  Scale scale;
  Deviation deviation;
  for (const ReferenceState& expected : system_.states) {
    const State state = solution_.at(expected.time);
    const Vector multipliers =
        expected.stage == 1 ? Vector(Vector::Zero(model_.multipliers())) : expected.multipliers;
    EXPECT_EQ(state.stage, expected.stage) << "t = " << expected.time;
    scale.see(expected.q, expected.v, multipliers);
    deviation.see(state, expected.q, expected.v, multipliers);
  }
  expect_within(deviation.relative_to(scale), GetParam().accuracy);
}

TEST_P(ReferenceRun, HasTheImpulseOfTheReference) {
  ASSERT_EQ(solution_.switches().size(), 1u);
  const Switch& change = solution_.switches().front();
  const ReferenceImpulse& expected = system_.impulse;
  const double accuracy = GetParam().accuracy;
  EXPECT_EQ(change.time, system_.t_switch);
  EXPECT_EQ(change.applied, ActiveSet{0});
  EXPECT_EQ(change.rank, model_.multipliers());
  const double speed = std::max(largest(expected.v_before), largest(expected.v_after));
  EXPECT_LE(largest(change.q - expected.q), accuracy * std::max(largest(expected.q), largest(change.q)));
  EXPECT_LE(largest(change.v_before - expected.v_before), accuracy * speed);
  EXPECT_LE(largest(change.v_after - expected.v_after), accuracy * speed);
  // An impulse is as uncertain as the momenta that it is the difference of.
  Vector momentum;
  Matrix mass;
  model_.equations->momentum(change.time, change.q, change.v_before, momentum, mass);
  const double momenta = largest(mass) * speed;
  EXPECT_LE(largest(change.impulse - expected.impulse), accuracy * momenta);
  EXPECT_LE(largest(change.multipliers - expected.multipliers), accuracy * momenta);
  const double energies = expected.kinetic_energy_before + expected.kinetic_energy_after;
  EXPECT_NEAR(change.kinetic_energy_before, expected.kinetic_energy_before, 2 * accuracy * energies);
  EXPECT_NEAR(change.kinetic_energy_after, expected.kinetic_energy_after, 2 * accuracy * energies);
}

INSTANTIATE_TEST_SUITE_P(AllReferences, ReferenceRun, ::testing::ValuesIn(cases_of_references()),
                         [](const auto& info) { return info.param.name(); });

}  // namespace
}  // namespace hybrid_sphere::mechanics::catalogue::testing::runs_test
