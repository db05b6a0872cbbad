// The projection of a state onto the active constraints.
#include <cfloat>
#include <cmath>

#include "mechanics/constrained_motion.hpp"
#include "mechanics/impulse_equations.hpp"

namespace hybrid_sphere::mechanics {

// Rows that have been left out no longer depend on the others if they do not hold then.
void ConstrainedMotion::project(double t, Vector& q, Vector& v) {
  if (!kept_.are_all()) {
    Vector place = q;
    Vector velocity = v;
    if (model_->normalize) model_->normalize(place);
    if (has_positions_) project_position(t, place, velocity);
    if (project_by_kept_rows(t, place, velocity)) {
      q = place;
      v = velocity;
      return;
    }
    kept_.set(nullptr);
    is_regular_ = false;
  }
  project_by_all_rows(t, q, v);
}

/// @return  whether all rows hold then, up to a small part of the speeds that the kinetic energy could give
/// to
///          the velocities: rows whose terms are all round-off have no other scale
bool ConstrainedMotion::project_by_kept_rows(double t, const Vector& q, Vector& v) {
  constexpr int steps = 2;
  constexpr double off = 0x1p-30;
  Vector way;
  for (int i = 0; i < steps; ++i) {
    constraints_.evaluate(t, q, v, value_, gradient_);
    if (!find_way(-value_, way)) return false;
    v += way;
  }
  constraints_.evaluate(t, q, v, value_, gradient_);
  const double speed = length(terms_.mass, v);
  for (Index b = 0; b < value_.size(); ++b) {
    double size = 0;
    for (Index s = 0; s < v.size(); ++s) {
      const double mass = terms_.mass(s, s);
      size += std::abs(gradient_(b, s)) * (mass > 0 ? speed / std::sqrt(mass) : std::abs(v[s]));
    }
    if (!(std::abs(value_[b]) <= off * size)) return false;
  }
  return true;
}

void ConstrainedMotion::project_by_all_rows(double t, Vector& q, Vector& v) {
  if (friction_.begins()) remove_slips_across(v);
  if (model_->normalize) model_->normalize(q);
  const bool is_decomposed = has_positions_ && project_position(t, q, v);
  if (active().empty() || project_by_newton(t, q, v, is_decomposed)) return;
  impulse_.solve(active(), t, q, v, projected_);
  v = projected_.velocity;
}

/// Removes the slips across their directions in a step in which slips begin: friction prevents them. Where
/// the constraints leave a slip only one direction, as a wire does, it turns with them and keeps all of it.
void ConstrainedMotion::remove_slips_across(Vector& v) {
  constexpr double one_way = 1e-9;  // least mobility relative to the greatest, above its rounding
  Vector change;
  Vector along;
  Vector lambda;
  const Vector no_gamma = Vector::Zero(lambda_.size());
  for (const SlidingFriction::Across& across : friction_.across()) {
    if (!respond(across.along, no_gamma, along, lambda)) continue;
    if (!respond(across.gradient, no_gamma, change, lambda)) continue;
    const double mobility = across.gradient.dot(change);
    const double mobility_along = across.along.dot(along);
    const double coupling = across.along.dot(change);
    const double size = mobility + mobility_along;
    if (mobility * mobility_along - coupling * coupling <= one_way * size * size) continue;
    v -= across.slip / mobility * change;
  }
}

/// The shortest way (n), in the metric of M, along which the constraints take up what is missing to them (g).
bool ConstrainedMotion::find_way(const Vector& missing, Vector& way) {
  const Vector& wanted = kept_.of(missing);
  if (is_regular_ && schur_complement_.decompose(terms_.mass, gradient_, kept_.rows())) {
    way.setZero(gradient_.cols());
    schur_complement_.add_shortest(wanted, way);
    return way.allFinite();
  }
  is_regular_ = false;
  const SaddlePoint::Outcome outcome =
      saddle_point_.solve(terms_.mass, kept_.of(gradient_), Vector::Zero(gradient_.cols()), wanted, way,
                          kept_multipliers_, &wanted);
  return outcome == SaddlePoint::Outcome::regular || outcome == SaddlePoint::Outcome::redundant;
}

/// Takes the drift of positions back, along the shortest way on which the other constraints hold, too. After
/// a way this short, relative to the coordinates, C has hardly changed.
/// @return  whether C has been decomposed that near
bool ConstrainedMotion::project_position(double t, Vector& q, const Vector& v) {
  constexpr int few = 3;
  constexpr double near = 0x1p-26;
  Vector rate;
  bool is_decomposed = false;
  for (int i = 0; i < few; ++i) {
    if (!is_decomposed) constraints_.evaluate(t, q, v, value_, gradient_);
    Vector missing = missing_positions(t, q);
    if ((missing.array() == 0).all()) return is_decomposed;
    Vector way;
    if (is_decomposed) {
      way.setZero(v.size());
      schur_complement_.add_shortest(kept_.of(missing), way);
    } else if (!find_way(missing, way)) {
      return false;
    }
    model_->equations->rate(q, way, rate);
    const bool is_rounding = (rate.array().abs() <= 2 * DBL_EPSILON * q.array().abs()).all();
    is_decomposed = is_regular_ && rate.lpNorm<Eigen::Infinity>() <= near * q.lpNorm<Eigen::Infinity>();
    q += rate;
    if (is_rounding) return is_decomposed;
  }
  return is_decomposed;
}

/// The positions of the active constraints (g), taken off; 0 of those that have none.
Vector ConstrainedMotion::missing_positions(double t, const Vector& q) const {
  Vector missing = Vector::Zero(value_.size());
  Vector position;
  Index row = 0;
  for (const std::size_t constraint : active()) {
    const ConstraintFunction& function = *model_->constraints[constraint].function;
    function.position(t, q, position);
    missing.segment(row, function.size()) = -position;
    row += function.size();
  }
  return missing;
}

/// By the mass matrix of the last evaluation, which has been near here.
/// @param is_decomposed  with a C near here
/// @return  whether that succeeds in a step or two; otherwise v is unchanged
bool ConstrainedMotion::project_by_newton(double t, const Vector& q, Vector& v, bool is_decomposed) {
  constexpr int few = 3;
  if (!is_regular_) return false;
  projected_.velocity = v;
  for (int i = 0; i < few; ++i) {
    constraints_.evaluate(t, q, projected_.velocity, value_, gradient_);
    if (residual_of(value_, gradient_, projected_.velocity) <= strict_tolerance(v.size())) {
      if ((gradient_.array() == 0).rowwise().all().any()) return false;
      v = projected_.velocity;
      return true;
    }
    const bool is_at_hand = is_decomposed && i == 0;
    if (!is_at_hand && !schur_complement_.decompose(terms_.mass, gradient_)) return false;
    schur_complement_.add_shortest(-value_, projected_.velocity);
  }
  return false;
}

}  // namespace hybrid_sphere::mechanics
