#pragma once

#include "motion/motion.hpp"

namespace hybrid_sphere {

/// omega_3 as a function of the time since the beginning of a segment:
///   omega_3' = torque_rate - drag omega_3 - friction_rate sign(omega_3 - ground_rate)
/// When omega_3 reaches the rate of the ground it stays there if friction can hold it, that is if
/// abs(torque_rate - drag ground_rate) <= friction_rate; else it passes, with the friction reversed.
/// Source: docs/theory.md 4.3.
class NormalSpin {
 public:
  /// Constant: prescribed by rubber, or free of torques.
  /// @param omega_3  [rad/s]
  explicit NormalSpin(double omega_3 = 0) : start_(omega_3), after_{omega_3, 0} {}

  /// @param omega_3        at tau = 0 [rad/s]
  /// @param torque_rate    [rad/s^2]
  /// @param drag           >= 0 [1/s]
  /// @param friction_rate  >= 0 [rad/s^2]
  /// @param ground_rate    [rad/s]
  NormalSpin(double omega_3, double torque_rate, double drag, double friction_rate, double ground_rate);

  /// @param tau  >= 0 [s]
  double at(double tau) const;
  /// omega_3'; at the kink, the value after it.
  double derivative(double tau) const;
  /// When omega_3 reaches the rate of the ground and its derivative jumps; `never` if it does not [s].
  double kink() const { return kink_; }
  bool constant() const { return constant_; }

 private:
  // omega_3' = torque - drag omega_3 from a start
  struct Piece {
    double start;
    double torque;
  };

  double value(const Piece& piece, double time) const;
  double slope(const Piece& piece, double time) const;

  double start_ = 0;
  double torque_ = 0;  // with friction, before the kink
  double drag_ = 0;
  double kink_ = never;
  Piece after_{0, 0};
  bool stays_ = false;  // after the kink
  bool constant_ = true;
};

}  // namespace hybrid_sphere
