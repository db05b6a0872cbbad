#include "cli/three_stage_deviation.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

namespace hybrid_sphere::cli::three_stage {
namespace {

using mechanics::Index;
using mechanics::Matrix;
using mechanics::Vector;

double relative(double error, double scale) { return error == 0 ? 0 : error / scale; }

}  // namespace

Deviation::Deviation(const mechanics::Model& model, const Vector& q, double duration, double step)
    : motion_(model),
      scale_(model, q),
      duration_(duration),
      step_(step),
      error_(Vector::Zero(model.equations->coordinates() + model.equations->velocities())),
      reaction_error_(Vector::Zero(model.multipliers())),
      reaction_(reaction_error_),
      effect_(Vector::Constant(model.multipliers(), std::numeric_limits<double>::infinity())) {}

void Deviation::add(const mechanics::State& state, const mechanics::catalogue::Known& known) {
  motion_.set_active(state.active, state.sliding);
  try {
    motion_.evaluate_stage(state.time, state.q, state.v);
  } catch (const mechanics::ConstraintError&) {
    return;  // the end of a motion that cannot go on: its multipliers are not determined
  }
  scale_.see(motion_, state.q, state.v, step_);
  const Vector& a = motion_.acceleration();
  acceleration_ = std::max(acceleration_, std::sqrt(std::max(0.0, a.dot(motion_.terms().mass * a))));
  see_reactions(state);
  Vector error(error_.size());
  error << state.q - known.q, state.v - known.v;
  error_ = error_.cwiseMax(error.cwiseAbs());
  if (known.multipliers) {
    reaction_ = reaction_.cwiseMax(known.multipliers->cwiseAbs());
    reaction_error_ = reaction_error_.cwiseMax((state.multipliers - *known.multipliers).cwiseAbs());
  }
  ++states_;
}

void Deviation::see_reactions(const mechanics::State& state) {
  const mechanics::Model& model = motion_.model();
  const Eigen::LDLT<Matrix> mass(motion_.terms().mass);
  Vector value;
  Matrix gradient;
  for (const std::size_t i : state.active) {
    model.constraints[i].function->evaluate(state.time, state.q, state.v, value, gradient);
    for (Index row = 0; row < gradient.rows(); ++row) {
      const Vector direction = gradient.row(row);
      const double effect = std::sqrt(direction.dot(mass.solve(direction)));
      double& smallest = effect_[model.multiplier_of(i) + row];
      if (effect > 0) smallest = std::min(smallest, effect);
    }
  }
}

double Deviation::of_coordinates() const {
  double largest = 0;
  for (Index i = 0; i < motion_.model().equations->coordinates(); ++i) {
    largest = std::max(largest, relative(error_[i], scale_.values()[i]));
  }
  return largest;
}

double Deviation::of_velocities() const {
  double largest = 0;
  for (Index i = motion_.model().equations->coordinates(); i < error_.size(); ++i) {
    largest = std::max(largest, relative(error_[i], scale_.values()[i]));
  }
  return largest;
}

double Deviation::of_multipliers() const {
  const double speed = acceleration_ > 0 ? acceleration_ * scale_.turning_time() : 0;
  const double acceleration = duration_ > 0 ? std::max(acceleration_, speed / duration_) : acceleration_;
  double largest = 0;
  for (Index i = 0; i < reaction_.size(); ++i) {
    largest =
        std::max(largest, relative(reaction_error_[i], std::max(reaction_[i], acceleration / effect_[i])));
  }
  return largest;
}

}  // namespace hybrid_sphere::cli::three_stage
