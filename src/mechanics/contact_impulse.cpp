#include "mechanics/contact_impulse.hpp"

#include <cmath>
#include <limits>

#include "interrupt/interrupt.hpp"

namespace hybrid_sphere::mechanics {

ContactImpulse::ContactImpulse(const Model& model) : model_(&model), rows_(model), bilateral_(model) {}

/// @param start  velocities before the phase
ContactImpulse::Step ContactImpulse::step(double t, const Vector& q, const Vector& start, Phase& phase) {
  Vector bilateral_values;
  Matrix bilateral_rows;
  rows_.motion().evaluate_stage(t, q, phase.v);
  bilateral_.evaluate(t, q, phase.v, bilateral_values, bilateral_rows);
  rows_.evaluate(t, q, phase.v);
  rows_.respond();
  Vector force = phase.momentum - rows_.motion().terms().momentum;
  force += rows_.directions().leftCols(rows_.contacts()) * phase.least;
  Vector change;
  Vector bilateral;
  if (!rows_.motion().respond(force, -bilateral_values, change, bilateral)) throw NotFinite("the impulse");
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
  const Vector after = phase.v + change + rows_.responses() * solution->reactions;
  phase.reactions = solution->reactions;
  phase.reactions.head(rows_.contacts()) += phase.least;
  phase.bilateral = bilateral + rows_.multipliers() * solution->reactions;
  const Vector weights = rows_.motion().terms().mass.diagonal().cwiseMax(0).cwiseSqrt();
  const Vector terms = start.cwiseAbs() + after.cwiseAbs() + change.cwiseAbs() +
                       rows_.responses().cwiseAbs() * solution->reactions.cwiseAbs();
  return {after, terms.cwiseProduct(weights).norm()};
}

/// One phase of an impulse: Newton's method, each step of which is a complementarity problem (Josephy). For
/// linear f and quadratic L the first step is the solution.
void ContactImpulse::run(double t, const Vector& q, Phase& phase) {
  constexpr int most = 50;
  constexpr double noise = 1e-9;  // of steps that do not get shorter any more
  const Vector start = phase.v;
  double length_before = std::numeric_limits<double>::infinity();
  for (int i = 0; i < most; ++i) {
    interruption_point();
    const Step taken = step(t, q, start, phase);
    const Vector weights = rows_.motion().terms().mass.diagonal().cwiseMax(0).cwiseSqrt();
    const double length = (taken.v - phase.v).cwiseProduct(weights).norm();
    phase.v = taken.v;
    if (length <= contact_roundoff * taken.size) return;
    if (length <= noise * taken.size && !(length < length_before)) return;
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
  Phase phase{terms.momentum, Vector::Zero(rows_.contacts()), v, {}, {}};
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
