#pragma once

#include <vector>

#include "hybrid_sphere/mechanics/model.hpp"

namespace hybrid_sphere::mechanics {

/// The Coulomb friction of the constraints that slide, lambda_s = -mu N sign(f_s): forces where the loads N
/// are known, and, where N is the multiplier of a unilateral constraint, a change of the direction in which
/// that one reacts, from c^T to c^T - mu sign(f_s) c_s^T. Source: docs/theory.md 7.8.
class SlidingFriction {
 public:
  /// @param model  must outlive this object
  explicit SlidingFriction(const Model& model) : model_(&model) {}

  void set(const ActiveSet& active, const Slides& sliding);
  const Slides& sliding() const { return sliding_; }
  bool is_empty() const { return sliding_.empty(); }

  /// Evaluates directions and loads at (t, q, v), and adds the forces of known loads to `force` (n). Throws
  /// NotFinite.
  void evaluate(double t, const Vector& q, const Vector& v, Vector& force);

  /// A unilateral constraint that holds and by whose reaction others slide.
  struct Contact {
    std::size_t constraint = 0;
    Index row = 0;     // of it among the functions that hold
    Vector direction;  // what friction adds to c^T (n)
  };
  const std::vector<Contact>& contacts() const { return contacts_; }

  /// lambda_s of each that slides, 0 elsewhere, added to all multipliers of the model.
  /// @param all  with those of the constraints that hold
  void add_multipliers(Vector& all) const;
  /// f_s of a constraint that slides, at the last evaluation.
  double slip(std::size_t constraint) const;
  /// Size of the terms of f_s.
  double slip_size(std::size_t constraint, const Vector& v) const;

 private:
  std::size_t place_of(std::size_t constraint) const;

  const Model* model_;
  Slides sliding_;
  std::vector<Contact> contacts_;
  Vector loads_;  // that are known; 0 where they are multipliers
  std::vector<Vector> values_;
  std::vector<Matrix> gradients_;
};

/// The load of a friction [N], by which abs(lambda) is bounded: N if it is known, otherwise the
/// multiplier of its contact. Throws NotFinite, and Undefined if N is negative.
/// @param multipliers  as Model::multipliers()
double load_of(const Model& model, const Friction& friction, double t, const Vector& q, const Vector& v,
               const Vector& multipliers);

}  // namespace hybrid_sphere::mechanics
