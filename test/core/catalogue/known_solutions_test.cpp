// The known solutions of the catalogue against references of more digits, and against what makes them
// solutions: q' = v, the constraints, M v' = h + C^T lambda, and at each switch p2 - p1 = C^T Lambda. These
// hold for any numbers.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>

#include "core/catalogue/reference_systems.hpp"
#include "core/catalogue/variations.hpp"
#include "mechanics/decompositions/pivoted_qr.hpp"

namespace hybrid_sphere::mechanics::catalogue::testing::known_solutions_test {
namespace {

constexpr double unit = 0x1p-53;  // rounding of one operation, relative

double largest(const Eigen::MatrixXd& matrix) {
  return matrix.size() == 0 ? 0 : matrix.cwiseAbs().maxCoeff();
}

class KnownSolution : public ::testing::TestWithParam<ReferenceSystem> {};

// Formulas of some tens of operations. Each rounds by one unit of a number no larger than the scale, and the
// phases that grow with the time are below 10 rad: 64 units of the scale are a bound with room for all of
// them.
TEST_P(KnownSolution, IsTheReferenceToRounding) {
  const ReferenceSystem& system = GetParam();
  double scale = 1;
  double reaction = 1;
  for (const ReferenceState& state : system.states) {
    scale = std::max({scale, largest(state.q), largest(state.v)});
    reaction = std::max(reaction, largest(state.multipliers));
  }
  double worst = 0;
  for (const ReferenceState& state : system.states) {
    const std::optional<Known> known = system.example.known(state.time);
    ASSERT_TRUE(known) << "t = " << state.time;
    worst = std::max({worst, largest(known->q - state.q) / scale, largest(known->v - state.v) / scale});
    ASSERT_TRUE(known->multipliers) << "t = " << state.time;
    if (state.stage == 1) {
      EXPECT_EQ(largest(*known->multipliers), 0) << "t = " << state.time;
    } else {
      worst = std::max(worst, largest(*known->multipliers - state.multipliers) / reaction);
    }
  }
  EXPECT_LE(worst, 64 * unit) << "in units: " << worst / unit;
  RecordProperty("units", std::to_string(worst / unit));
}

INSTANTIATE_TEST_SUITE_P(AllReferences, KnownSolution, ::testing::ValuesIn(reference_systems()),
                         [](const auto& info) { return info.param.name; });

class ReferenceSolution : public ::testing::TestWithParam<Variation> {
 protected:
  ReferenceSolution()
      : entry_(entry(GetParam().entry)),
        example_(entry_.build(values_of(GetParam()))),
        step_(GetParam().time_scale * entry_.characteristic_time / 200) {}

  const Model& model() const { return example_.by_hand; }

  // Constraints that hold at t.
  ActiveSet active(double t, const Vector& q) const {
    ActiveSet result;
    for (std::size_t i = 0; i < model().constraints.size(); ++i) {
      const Schedule& schedule = model().constraints[i].schedule;
      const bool holds =
          schedule.guard ? schedule.guard->value(t, q) > 0 : schedule.begin <= t && t < schedule.end;
      if (holds) result.push_back(i);
    }
    return result;
  }

  // C and f of the active constraints stacked.
  void gradient(const ActiveSet& set, double t, const Vector& q, const Vector& v, Matrix& C,
                Vector& f) const {
    C.resize(0, v.size());
    f.resize(0);
    for (const std::size_t i : set) {
      Vector value;
      Matrix rows;
      model().constraints[i].function->evaluate(t, q, v, value, rows);
      C.conservativeResize(C.rows() + rows.rows(), Eigen::NoChange);
      C.bottomRows(rows.rows()) = rows;
      f.conservativeResize(f.size() + value.size());
      f.tail(value.size()) = value;
    }
  }

  Vector multipliers(const ActiveSet& set, const Vector& all) const {
    Vector result;
    for (const std::size_t i : set) {
      const Index size = model().constraints[i].function->size();
      result.conservativeResize(result.size() + size);
      result.tail(size) = all.segment(model().multiplier_of(i), size);
    }
    return result;
  }

  // f = 0 to the rounding of its terms and of q in it.
  void expect_on_constraints(const ActiveSet& set, double t, const Known& known) const {
    Matrix C;
    Vector f;
    gradient(set, t, known.q, known.v, C, f);
    for (Index row = 0; row < f.size(); ++row) {
      const double terms = C.row(row).cwiseAbs() * known.v.cwiseAbs();
      EXPECT_LE(std::abs(f[row]), 64 * unit * terms * (1 + largest(known.q))) << "t = " << t;
    }
  }

  struct Derivative {
    Vector value;
    double error = 0;  // of the difference formula
  };

  // Of eighth order, its error bounded by the difference to that of sixth order.
  template <class Part>
  Derivative derivative(double t, Part part) const {
    std::array<Vector, 5> change;
    for (int k = 1; k <= 4; ++k) {
      change[static_cast<std::size_t>(k)] =
          part(*example_.known(t + k * step_)) - part(*example_.known(t - k * step_));
    }
    const Vector eighth = (change[1] * 4 / 5 - change[2] / 5 + change[3] * 4 / 105 - change[4] / 280) / step_;
    const Vector sixth = (change[1] * 3 / 4 - change[2] * 3 / 20 + change[3] / 60) / step_;
    return {eighth, largest(eighth - sixth)};
  }

  const Entry& entry_;
  Example example_;
  double step_;
};

TEST_P(ReferenceSolution, SolvesTheEquationsOfMotion) {
  int checked = 0;
  int held = 0;
  for (int i = 0; i < 40; ++i) {
    const double t = entry_.duration * (i + 0.37) / 40;
    const std::optional<Known> known = example_.known(t), first = example_.known(t - 4 * step_),
                               last = example_.known(t + 4 * step_);
    if (!known || !first || !last) continue;
    const ActiveSet set = active(t, known->q);
    if (active(t - 4 * step_, first->q) != set || active(t + 4 * step_, last->q) != set) continue;
    ++checked;
    held += set.empty() ? 0 : 1;
    expect_on_constraints(set, t, *known);

    const Derivative rate = derivative(t, [](const Known& at) { return at.q; });
    const Derivative acceleration = derivative(t, [](const Known& at) { return at.v; });
    MotionTerms terms;
    model().equations->evaluate(t, known->q, known->v, terms);
    const double q_scale = largest(known->q) + step_ * largest(terms.rate);
    const double v_scale = largest(known->v) + step_ * largest(acceleration.value);
    // Rounding of 64 units in each value of the difference.
    const double rate_error = rate.error + 128 * unit * q_scale / step_;
    const double acceleration_error =
        acceleration.error + 128 * unit * (v_scale + q_scale / entry_.duration) / step_;
    EXPECT_LE(largest(rate.value - terms.rate), rate_error) << "t = " << t;

    Matrix C;
    Vector f;
    gradient(set, t, known->q, known->v, C, f);
    Vector reaction = Vector::Zero(known->v.size());
    if (known->multipliers && !set.empty()) {
      reaction = C.transpose() * multipliers(set, *known->multipliers);
    }
    const double forces = largest(terms.force) + largest(reaction) + largest(terms.mass * acceleration.value);
    EXPECT_LE(
        largest(terms.mass * acceleration.value - terms.force - reaction),
        static_cast<double>(known->v.size()) * largest(terms.mass) * acceleration_error + 64 * unit * forces)
        << "t = " << t;
    // The bounds are bounds: a wrong sign anywhere would be 1e5 times as large.
    EXPECT_LE(rate_error, 1e-7 * (largest(terms.rate) + q_scale / entry_.duration)) << "t = " << t;
    EXPECT_LE(acceleration_error, 1e-6 * (largest(acceleration.value) + v_scale / entry_.duration))
        << "t = " << t;
  }
  EXPECT_GE(checked, GetParam().least_checked);
  EXPECT_TRUE(held > 0 || GetParam().never_held);
}

// Instants at which a constraint is applied or released, to rounding.
std::vector<double> switch_times(const Example& example, double duration) {
  std::vector<double> times;
  for (const Constraint& constraint : example.by_hand.constraints) {
    const Schedule& schedule = constraint.schedule;
    if (!schedule.guard) {
      if (schedule.begin > 0 && schedule.begin < duration) times.push_back(schedule.begin);
      continue;
    }
    const auto positive = [&](double t) {
      const std::optional<Known> known = example.known(t);
      return known && schedule.guard->value(t, known->q) > 0;
    };
    constexpr int pieces = 500;
    for (int i = 0; i < pieces; ++i) {
      double low = duration * i / pieces, high = duration * (i + 1) / pieces;
      if (positive(low) == positive(high)) continue;
      for (int k = 0; k < 60; ++k) {
        const double middle = (low + high) / 2;
        (positive(middle) == positive(low) ? low : high) = middle;
      }
      times.push_back(high);
    }
  }
  return times;
}

TEST_P(ReferenceSolution, MeetsEachSwitchWithTheImpulseOfTheConstraint) {
  const std::vector<double> times = switch_times(example_, entry_.duration);
  int checked = 0;
  for (const double t : times) {
    const double margin = 1e-9 * entry_.duration;  // q and v change by no more than their rates times this
    const std::optional<Known> before = example_.known(t - margin), after = example_.known(t + margin);
    if (!before || !after) continue;
    ++checked;
    const double scale = largest(after->v) + largest(before->v);
    MotionTerms terms;
    model().equations->evaluate(t, after->q, after->v, terms);
    const double forces = largest(terms.force) / largest(terms.mass) + scale / entry_.characteristic_time;
    const double slack = 100 * margin * (scale + forces + largest(terms.rate));
    EXPECT_LE(largest(after->q - before->q), slack) << "t = " << t;

    const ActiveSet set = active(t + margin, after->q);
    Vector p_before, p_after;
    Matrix mass;
    model().equations->momentum(t, before->q, before->v, p_before, mass);
    model().equations->momentum(t, after->q, after->v, p_after, mass);
    const Vector P = p_after - p_before;
    Matrix C;
    Vector f;
    gradient(set, t + margin, after->q, after->v, C, f);
    Vector off = P;
    if (!set.empty()) off -= C.transpose() * PivotedQr(C.transpose()).solve(P);
    EXPECT_LE(largest(off), largest(mass) * slack) << "t = " << t;
    expect_on_constraints(set, t + margin, *after);
  }
  EXPECT_TRUE(checked > 0 || GetParam().never_held);
}

INSTANTIATE_TEST_SUITE_P(AllEntries, ReferenceSolution, ::testing::ValuesIn(known_variations()),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace hybrid_sphere::mechanics::catalogue::testing::known_solutions_test
