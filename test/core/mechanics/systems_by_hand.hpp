#pragma once

#include <string>
#include <utility>
#include <vector>

#include "hybrid_sphere/mechanics/by_hand.hpp"
#include "hybrid_sphere/mechanics/impulse.hpp"
#include "hybrid_sphere/mechanics/model.hpp"

namespace hybrid_sphere::testing {

/// L = v M(q) v / 2 in coordinates with q' = v. @param mass  Matrix(const Vector& q)
template <class Mass>
std::shared_ptr<const mechanics::EquationsOfMotion> equations_of_mass(mechanics::Index n, Mass mass) {
  using mechanics::Vector;
  return mechanics::equations_by_hand(
      n, n, [mass](double, const Vector& q, const Vector& v, mechanics::MotionTerms& terms) {
        terms.mass = mass(q);
        terms.momentum = terms.mass * v;
        terms.lagrangian = v.dot(terms.momentum) / 2;
        terms.rate = v;
        terms.force.setZero();
      });
}

/// f = C(q) v - u(q). @param rows  std::pair<Matrix, Vector>(const Vector& q): C and u
template <class Rows>
mechanics::Constraint linear_constraint(const std::string& name, mechanics::Index size, Rows rows) {
  using mechanics::Vector;
  return {name,
          mechanics::constraint_by_hand(size,
                                        [rows](double, const Vector& q, const Vector& v, const Vector&,
                                               mechanics::ConstraintTerms& terms) {
                                          const auto [gradient, offset] = rows(q);
                                          terms.gradient = gradient;
                                          terms.value = gradient * v - offset;
                                          terms.gamma.setZero();
                                        }),
          {}};
}

/// f = C v - u with constant C and u.
inline mechanics::Constraint fixed_constraint(const std::string& name, const mechanics::Matrix& gradient,
                                              const mechanics::Vector& offset) {
  return linear_constraint(name, gradient.rows(),
                           [=](const mechanics::Vector&) { return std::pair(gradient, offset); });
}

/// f = v S v - u with constant symmetric S, not linear in v.
inline mechanics::Constraint quadratic_constraint(const std::string& name, const mechanics::Matrix& form,
                                                  double offset) {
  using mechanics::Vector;
  return {name,
          mechanics::constraint_by_hand(
              1,
              [=](double, const Vector&, const Vector& v, const Vector&, mechanics::ConstraintTerms& terms) {
                terms.gradient = 2 * (form * v).transpose();
                terms.value[0] = v.dot(form * v) - offset;
                terms.gamma.setZero();
              },
              [=](double, const Vector&, const Vector&, const Vector& multipliers, mechanics::Matrix& sum) {
                sum += 2 * multipliers[0] * form;
              }),
          {}};
}

inline mechanics::Model model_of(const std::vector<std::string>& coordinates,
                                 std::shared_ptr<const mechanics::EquationsOfMotion> equations,
                                 const std::vector<mechanics::Constraint>& constraints) {
  mechanics::Model model;
  model.coordinates = coordinates;
  for (const std::string& name : coordinates) model.velocities.push_back(name + "_dot");
  model.equations = std::move(equations);
  model.constraints = constraints;
  mechanics::check(model);
  return model;
}

/// The impulse that all constraints of the model need.
inline mechanics::Impulse impulse_of(const mechanics::Model& model, const mechanics::Vector& q,
                                     const mechanics::Vector& v1) {
  mechanics::ActiveSet all;
  for (std::size_t i = 0; i < model.constraints.size(); ++i) all.push_back(i);
  mechanics::ImpulseSolver solver(model);
  mechanics::Impulse impulse;
  solver.solve(all, 0, q, v1, impulse);
  return impulse;
}

/// The energy of the velocities v in the mass matrix at q.
inline double kinetic_energy(const mechanics::Model& model, const mechanics::Vector& q,
                             const mechanics::Vector& v) {
  mechanics::Vector p;
  mechanics::Matrix mass;
  model.equations->momentum(0, q, v, p, mass);
  return v.dot(mass * v) / 2;
}

}  // namespace hybrid_sphere::testing
