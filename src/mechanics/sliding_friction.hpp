#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hybrid_sphere/mechanics/model.hpp"

namespace hybrid_sphere::mechanics {

/// The Coulomb friction of the constraints that slide, lambda_s = -mu N u, where u is the direction of the
/// slip f_s: forces where the loads N are known, and, where N is the multiplier of a unilateral constraint, a
/// change of the direction in which that one reacts, from c^T to c^T - mu c_s^T u. Source: docs/theory.md
/// 7.8.
///
/// Within a step the motion must be smooth where the slip passes 0. So u is measured from the direction e
/// that the slip has at the step's start: it is that of f_s where this leads forward, f_s e > 0, and of -f_s
/// beyond 0. With one function u = e; with two also in a step that starts without a slip, where e is the
/// direction in which it begins. Friction would take from such a step the part of its slip that is across e.
class SlidingFriction {
 public:
  /// @param model  must outlive this object
  explicit SlidingFriction(const Model& model) : model_(&model) {}

  void set(const ActiveSet& active, const Slides& sliding);
  /// The constraints that slide, with the directions e.
  const Slides& sliding() const { return sliding_; }
  /// Takes e from the slip at (t, q, v), where it is not too slow, and otherwise as it was set. Throws
  /// NotFinite.
  void aim(double t, const Vector& q, const Vector& v);
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
  /// u of all that slide, at the last evaluation.
  using Directions = std::vector<Eigen::Vector2d>;
  const Directions& directions() const { return directions_; }
  /// Whether the direction of a slip may change: one with two functions slides.
  bool turns() const {
    return std::any_of(speeds_.begin(), speeds_.end(), [](double speed) { return speed > 0; });
  }
  /// Whether the slip of one with two functions has no direction of its own where the step starts.
  bool begins() const;
  /// The slips of those across e at the last evaluation, with the derivatives by v of slips across and along.
  struct Across {
    double slip;
    Vector gradient;  // (n)
    Vector along;     // (n)
  };
  std::vector<Across> across() const;
  /// While this object exists, the directions are those that aim() has set, however the slips turn: the
  /// motion without their fast turn.
  class Held {
   public:
    explicit Held(SlidingFriction& friction) : friction_(&friction) { friction_->turned_ = none(); }
    ~Held() { friction_->turned_.reset(); }
    Held(const Held&) = delete;
    Held& operator=(const Held&) = delete;
    /// Turns the direction of the slide at a place in sliding(). @param angle  [rad]
    void turn(std::size_t place, double angle) { friction_->turned_ = {place, angle}; }
    /// The directions are again those of aim().
    void turn_back() { friction_->turned_ = none(); }
    /// Angle by which the slip at the last evaluation is turned off e, if it is small [rad]; 0 of a slip
    /// whose direction does not follow it.
    double turn_of_slip(std::size_t place) const;

   private:
    static std::pair<std::size_t, double> none() { return {0, 0.0}; }
    SlidingFriction* friction_;
  };
  /// f_s e of a constraint that slides, at the last evaluation: negative once the slip has passed 0.
  double slip(std::size_t constraint) const;
  /// abs(f_s) where the step starts, of one with two functions; 0 of others.
  double speed_at_start(std::size_t constraint) const { return speeds_[place_of(constraint)]; }
  /// Slips of two functions that have directions of their own.
  struct Speed {
    std::size_t constraint;
    double at_start;  // abs(f_s), where the step starts
    double now;       // abs(f_s) at the last evaluation
    double forward;   // f_s e there
  };
  std::vector<Speed> speeds() const;
  /// Size of the terms of f_s e.
  double slip_size(std::size_t constraint, const Vector& v) const;

 private:
  std::size_t place_of(std::size_t constraint) const;
  Eigen::Vector2d direction_of(std::size_t i) const;

  const Model* model_;
  Slides sliding_;
  Slides set_;  // with the directions as they were set
  Directions directions_;
  std::vector<bool> begins_;                              // in this step
  std::vector<double> speeds_;                            // where it starts
  std::optional<std::pair<std::size_t, double>> turned_;  // place and angle, while directions are held
  std::vector<Contact> contacts_;
  Vector loads_;  // that are known; 0 where they are multipliers
  std::vector<Vector> values_;
  std::vector<Matrix> gradients_;
};

/// Refuses coefficients that are negative, not finite, or less for sticking than for sliding, by
/// std::invalid_argument with the subject, the value and what is allowed.
void check_coefficients(const std::string& subject, const Friction& friction);

/// The load of a friction [N], by which abs(lambda) is bounded: N if it is known, otherwise the
/// multiplier of its contact. Throws NotFinite, and Undefined if N is negative.
/// @param multipliers  as Model::multipliers()
double load_of(const Model& model, const Friction& friction, double t, const Vector& q, const Vector& v,
               const Vector& multipliers);

}  // namespace hybrid_sphere::mechanics
