#include "hybrid_sphere/mechanics/linearization.hpp"

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "mechanics/check_initial.hpp"
#include "mechanics/constrained_motion.hpp"
#include "text/refusal.hpp"

namespace hybrid_sphere::mechanics {
namespace {

/// df/dx at 0 by Ridders' method: differences over steps that are halved, extrapolated to none, of which each
/// component takes the one that agrees best with those before it.
/// @param f     x -> Vector; steps at which it is not defined are left out
/// @param size  the longest step
template <class Function>
Vector derivative(const Function& f, double size) {
  constexpr int halvings = 40;
  constexpr std::size_t orders = 5;
  std::array<Vector, orders> before;  // by the power of the step that is extrapolated away
  std::array<Vector, orders> now;
  std::size_t known = 0;  // in `before`
  Vector best;
  Vector error;
  for (int i = 0; i < halvings; ++i) {
    const double h = std::ldexp(size, -i);
    Vector rounding;
    try {
      const Vector up = f(h);
      const Vector down = f(-h);
      now[0] = (up - down) / (2 * h);
      rounding = DBL_EPSILON / h * (up.cwiseAbs() + down.cwiseAbs());
    } catch (const NumericalError&) {
      if (i + 1 == halvings) throw;
      known = 0;
      continue;
    }
    if (best.size() == 0) {
      best = now[0];
      error = Vector::Constant(best.size(), std::numeric_limits<double>::infinity());
    }
    double power = 1;
    const std::size_t count = std::min(known + 1, orders);
    for (std::size_t k = 1; k < count; ++k) {
      power *= 4;
      now[k] = (power * now[k - 1] - before[k - 1]) / (power - 1);
      const Vector apart =
          rounding + (now[k] - now[k - 1]).cwiseAbs().cwiseMax((now[k] - before[k - 1]).cwiseAbs());
      for (Index j = 0; j < best.size(); ++j) {
        // Where the two sides are equal, rounding has swallowed the step.
        const bool is_swallowed = now[0][j] == 0 && best[j] != 0;
        if (is_swallowed || !(apart[j] < error[j])) continue;
        error[j] = apart[j];
        best[j] = now[k][j];
      }
    }
    std::swap(before, now);
    known = count;
  }
  return best;
}

void check_place(const Model& model, const State& state) {
  check(model);
  check_state(model, state.time, state.q, state.v);
  check_constraints(model, "active", state.active);
  for (const Slide& slide : state.sliding) {
    check_constraints(model, "sliding", {slide.constraint});
    const Constraint& constraint = model.constraints[slide.constraint];
    if (constraint.friction) continue;
    throw std::invalid_argument(
        text::refusal("sliding: constraint " + constraint.name, "those with friction"));
  }
}

double size_of(double x) { return 0.125 * std::max(1.0, std::abs(x)); }

/// x' in a state.
class Rate {
 public:
  Rate(const Model& model, const State& state) : motion_(model), time_(state.time), size_(state.q.size()) {
    motion_.set_active(state.active, state.sliding);
  }
  Vector operator()(const Vector& x) {
    q_ = x.head(size_);
    v_ = x.tail(x.size() - size_);
    motion_.evaluate_stage(time_, q_, v_);
    Vector rate(x.size());
    rate << motion_.terms().rate, motion_.acceleration();
    return rate;
  }

 private:
  ConstrainedMotion motion_;
  double time_;
  Index size_;
  Vector q_;
  Vector v_;
};

}  // namespace

Linearization linearize(const Model& model, const State& state) {
  check_place(model, state);
  Vector x(state.q.size() + state.v.size());
  x << state.q, state.v;
  Rate rate(model, state);
  Linearization result;
  result.rate = rate(x);
  result.A.resize(x.size(), x.size());
  result.B.resize(x.size(), 0);
  for (Index i = 0; i < x.size(); ++i) {
    const auto along = [&](double h) {
      Vector there = x;
      there[i] += h;
      return rate(there);
    };
    result.A.col(i) = derivative(along, size_of(x[i]));
  }
  return result;
}

Linearization linearize(const ModelOfInput& model, const Vector& input, const State& state) {
  for (Index i = 0; i < input.size(); ++i) {
    if (!std::isfinite(input[i])) refuse("input[" + std::to_string(i) + "]", input[i], "a finite number");
  }
  Linearization result = linearize(model(input), state);
  Vector x(state.q.size() + state.v.size());
  x << state.q, state.v;
  result.B.resize(x.size(), input.size());
  for (Index i = 0; i < input.size(); ++i) {
    const auto along = [&](double h) {
      Vector there = input;
      there[i] += h;
      const Model moved = model(there);
      return Rate(moved, state)(x);
    };
    result.B.col(i) = derivative(along, size_of(input[i]));
  }
  return result;
}

}  // namespace hybrid_sphere::mechanics
