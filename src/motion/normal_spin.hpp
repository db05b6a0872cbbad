#pragma once

#include "motion/motion.hpp"
#include "motion/phi.hpp"

namespace hybrid_sphere {

/// What is left of a velocity under linear drag: e^(-drag tau), and the integral of that from 0 [s].
struct Decay {
  double part;
  double time;
};
/// @param drag  [1/s]
inline Decay decay_at(double drag, double tau) {
  const Phis phi = phis(-drag * tau);
  return {phi.zero, tau * phi.one};
}

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
  /// The same at less cost.
  /// @param decay  decay_at(drag(), tau); not used where omega_3 is constant
  double at(double tau, const Decay& decay) const {
    if (constant_) return start_;
    return tau < kink_ ? value({start_, torque_}, decay) : at(tau);
  }
  /// omega_3'; at the kink, the value after it.
  double derivative(double tau) const;
  /// Coefficient of the power n + 1 of its Taylor polynomial in (time - middle)/half, from that of n > 0.
  double next_power(int n, double power, double half) const { return -drag_ * half / (n + 1) * power; }
  /// When omega_3 reaches the rate of the ground and its derivative jumps; `never` if it does not [s].
  double kink() const { return kink_; }
  bool constant() const { return constant_; }
  double drag() const { return drag_; }

 private:
  // omega_3' = torque - drag omega_3 from a start
  struct Piece {
    double start;
    double torque;
  };

  static double value(const Piece& piece, const Decay& decay) {
    return piece.start * decay.part + piece.torque * decay.time;
  }
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
