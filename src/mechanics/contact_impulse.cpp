#include "mechanics/contact_impulse.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <limits>

#include "interrupt/interrupt.hpp"

namespace hybrid_sphere::mechanics {

ContactImpulse::ContactImpulse(const Model& model) : model_(&model), rows_(model), bilateral_(model) {}

void ContactImpulse::evaluate(double t, const Vector& q, const Phase& phase) {
  Matrix gradient;
  rows_.motion().evaluate_stage(t, q, phase.v);
  bilateral_.evaluate(t, q, phase.v, bilateral_values_, gradient);
  rows_.evaluate(t, q, phase.v);
  rows_.respond();
}

/// Square roots of masses: velocities times them have the metric of M.
Vector ContactImpulse::weights() { return rows_.motion().terms().mass.diagonal().cwiseMax(0).cwiseSqrt(); }

/// How far v is off p = p before + D reactions, and f off what the last step expects, relative to the size of
/// v in the metric of M. The reactions may be one choice of many: another one is no error.
double ContactImpulse::error_of(const Phase& phase) {
  const Vector force =
      phase.momentum - rows_.motion().terms().momentum + rows_.directions() * phase.reactions;
  Vector change;
  Vector bilateral;
  if (!rows_.motion().respond(force, -bilateral_values_, change, bilateral)) throw NotFinite("the impulse");
  double error = change.cwiseProduct(weights()).norm();
  for (Index i = 0; i < rows_.size(); ++i) {
    const double off = std::abs(rows_.values()[i] - phase.rates[i]);
    const double own = rows_.effect()(i, i);
    if (own > 0) error = std::max(error, off / std::sqrt(own));
  }
  return error / std::max(phase.size, DBL_MIN);
}

/// A step of Newton's method.
void ContactImpulse::step(double t, const Vector& q, Phase& phase) {
  Vector force = phase.momentum - rows_.motion().terms().momentum;
  force += rows_.directions().leftCols(rows_.contacts()) * phase.least;
  Vector change;
  Vector bilateral;
  if (!rows_.motion().respond(force, -bilateral_values_, change, bilateral)) throw NotFinite("the impulse");
  const Vector free = rows_.values() + rows_.gradient() * change;
  const Vector sizes =
      rows_.gradient().cwiseAbs() * (phase.v.cwiseAbs() + change.cwiseAbs()) + rows_.values().cwiseAbs();
  Vector coefficients(rows_.frictions());
  Vector limits = Vector::Zero(rows_.frictions());
  for (Index j = 0; j < rows_.frictions(); ++j) {
    const std::size_t friction = rows_.candidates().frictions[std::size_t(j)];
    const Index contact = rows_.contact_of(friction);
    coefficients[j] = model_->constraints[friction].friction->coefficient;
    if (contact >= 0) limits[j] = coefficients[j] * phase.least[contact];
  }
  const std::optional<ContactReactions> solution = rows_.solve(free, sizes, coefficients, limits);
  if (!solution) rows_.refuse(t, q);
  phase.rates = free + rows_.effect() * solution->reactions;
  phase.v += change + rows_.responses() * solution->reactions;
  phase.reactions = solution->reactions;
  phase.reactions.head(rows_.contacts()) += phase.least;
  phase.bilateral = bilateral + rows_.multipliers() * solution->reactions;
  const Vector terms = phase.start.cwiseAbs() + phase.v.cwiseAbs() + change.cwiseAbs() +
                       rows_.responses().cwiseAbs() * solution->reactions.cwiseAbs();
  phase.size = terms.cwiseProduct(weights()).norm();
}

/// One phase of an impulse: Newton's method, each step of which is a complementarity problem (Josephy). For
/// linear f and quadratic L the first step is the solution.
void ContactImpulse::run(double t, const Vector& q, Phase& phase) {
  constexpr int most = 50;
  constexpr double noise = 1e-9;  // of steps that do not get shorter any more
  double length_before = std::numeric_limits<double>::infinity();
  phase.v = phase.start;
  for (int i = 0; i < most; ++i) {
    interruption_point();
    const Vector before = phase.v;
    evaluate(t, q, phase);
    step(t, q, phase);
    const double length = (phase.v - before).cwiseProduct(weights()).norm();
    if (length <= contact_roundoff * phase.size) return;
    if (!(length < length_before)) {
      if (length <= noise * phase.size) return;
      // Two solutions may take turns.
      evaluate(t, q, phase);
      if (error_of(phase) <= noise) return;
    }
    length_before = length;
  }
  throw ConstraintError(ConstraintError::Reason::no_velocity,
                        "no velocity after an impulse was found, at " + describe(*model_, t, q));
}

ContactImpulse::Outcome ContactImpulse::solve(double t, const Vector& q, const Vector& v,
                                              const ContactCandidates& candidates,
                                              const std::vector<Bounce>& bounces) {
  rows_.set(candidates);
  bilateral_.set(candidates.bilateral);
  MotionTerms terms;
  model_->equations->momentum(t, q, v, terms.momentum, terms.mass);
  Phase phase{terms.momentum, v, Vector::Zero(rows_.contacts())};
  run(t, q, phase);
  Vector reactions = phase.reactions;
  Vector bilateral = phase.bilateral;
  Vector returned = Vector::Zero(rows_.contacts());
  for (Index i = 0; i < rows_.contacts(); ++i) {
    const Bounce& bounce = bounces[std::size_t(i)];
    const double back = bounce.restitution * reactions[i];
    if (back * rows_.effect()(i, i) > bounce.least_speed) returned[i] = back;
  }
  if ((returned.array() > 0).any()) {
    model_->equations->momentum(t, q, phase.v, terms.momentum, terms.mass);
    phase.momentum = terms.momentum;
    phase.start = phase.v;
    phase.least = returned;
    run(t, q, phase);
    reactions += phase.reactions;
    bilateral += phase.bilateral;
  }
  Outcome outcome{phase.v, spread(*model_, candidates.bilateral, bilateral)};
  for (Index row = 0; row < rows_.contacts(); ++row) {
    outcome.multipliers[model_->multiplier_of(candidates.contacts[std::size_t(row)])] = reactions[row];
  }
  for (std::size_t i = 0; i < candidates.frictions.size(); ++i) {
    const ContactRows::Rows& rows = rows_.rows_of(i);
    outcome.multipliers.segment(model_->multiplier_of(candidates.frictions[i]), rows.size) =
        reactions.segment(rows.first, rows.size);
  }
  if (!(outcome.v.allFinite() && outcome.multipliers.allFinite())) throw NotFinite("the impulse");
  return outcome;
}

}  // namespace hybrid_sphere::mechanics
