#include "motion/normal_spin.hpp"

#include <cmath>

namespace hybrid_sphere {
namespace {

// How long a size takes to vanish: size' = -decay - drag size.
double time_to_vanish(double size, double decay, double drag) {
  const double share = drag * (size / decay);
  return size / decay * (share == 0 ? 1 : std::log1p(share) / share);
}

}  // namespace

NormalSpin::NormalSpin(double omega_3, double torque_rate, double drag, double friction_rate,
                       double ground_rate)
    : start_(omega_3), torque_(torque_rate), drag_(drag), after_{ground_rate, torque_rate} {
  if (friction_rate > 0) {
    const double excess = omega_3 - ground_rate;
    const double push = torque_rate - drag * ground_rate;  // omega_3' at the ground's rate without friction
    const bool held = std::abs(push) <= friction_rate;
    const double way = excess != 0 ? std::copysign(1.0, excess) : std::copysign(1.0, push);
    torque_ = torque_rate - way * friction_rate;
    after_.torque = torque_rate - std::copysign(friction_rate, push);
    if (excess == 0 && held) {
      kink_ = 0;
    } else if (excess != 0 && friction_rate - way * push > 0) {
      kink_ = time_to_vanish(std::abs(excess), friction_rate - way * push, drag);
    }
    stays_ = held;
    if (kink_ == 0 && held) {  // from the start
      torque_ = drag_ = 0;
      kink_ = never;
    }
  }
  constant_ = kink_ == never && torque_ - drag_ * start_ == 0;
}

double NormalSpin::slope(const Piece& piece, double time) const {
  return (piece.torque - drag_ * piece.start) * std::exp(-drag_ * time);
}

double NormalSpin::at(double tau) const {
  if (constant_) return start_;
  if (tau < kink_) return value({start_, torque_}, decay_at(drag_, tau));
  return stays_ ? after_.start : value(after_, decay_at(drag_, tau - kink_));
}

double NormalSpin::derivative(double tau) const {
  if (constant_) return 0;
  if (tau < kink_) return slope({start_, torque_}, tau);
  return stays_ ? 0 : slope(after_, tau - kink_);
}

}  // namespace hybrid_sphere
