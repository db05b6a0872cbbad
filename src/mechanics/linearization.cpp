#include "hybrid_sphere/mechanics/linearization.hpp"

#include <cmath>
#include <string>

#include "mechanics/check_initial.hpp"
#include "mechanics/constrained_motion.hpp"
#include "mechanics/extrapolated_derivative.hpp"

namespace hybrid_sphere::mechanics {
namespace {

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
  check_state(model, state);
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
    result.A.col(i) = derivative(along, step_size_of(x[i]));
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
    result.B.col(i) = derivative(along, step_size_of(input[i]));
  }
  return result;
}

}  // namespace hybrid_sphere::mechanics
