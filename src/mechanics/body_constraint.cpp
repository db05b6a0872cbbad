#include "mechanics/body_constraint.hpp"

namespace hybrid_sphere::mechanics {

void BodyConstraint::evaluate(double /*t*/, const Vector& q, const Vector& v, const Vector& rate,
                              ConstraintTerms& terms) const {
  Bodies bodies = motions(q, v);
  for (std::size_t i = 0; i < bodies.size(); ++i) bodies[i].move(bodies_[i], q, rate);
  BodyRows rows(size_);
  fill(bodies, rows);
  terms.value = rows.value;
  terms.gamma = rows.gamma;
  spread(rows, v.size(), terms.gradient);
  require_finite(terms.value);
  if (!(is_finite(rows.gradient) && is_finite(rows.gamma))) throw NotFinite("derivative of " + label_);
}

void BodyConstraint::evaluate(double /*t*/, const Vector& q, const Vector& v, Vector& value,
                              Matrix& gradient) const {
  Bodies bodies = motions(q, v);
  for (BodyMotion& body : bodies) body.move();
  BodyRows rows(size_);
  fill(bodies, rows);
  value = rows.value;
  spread(rows, v.size(), gradient);
  require_finite(value);
  if (!is_finite(rows.gradient)) throw NotFinite("derivative of " + label_);
}

void BodyConstraint::require_finite(const Vector& value) const {
  if (!is_finite(value)) throw NotFinite(label_);
}

void BodyConstraint::spread(const BodyRows& rows, Index columns, Matrix& gradient) const {
  gradient.setZero(size_, columns);
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (bodies_[i] == world_body) continue;
    gradient.middleCols<body_velocities>(body_velocities * bodies_[i]) =
        rows.gradient.middleCols<body_velocities>(body_velocities * static_cast<Index>(i));
  }
}

}  // namespace hybrid_sphere::mechanics
