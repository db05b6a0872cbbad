#pragma once

#include <cmath>

namespace hybrid_sphere {

/// Whether shorter panels err less in a time. Where they do not, what is left of the error is noise of the
/// angular velocity itself, or, where it does not depend on the length either, of a panel.
class ShorterPanels {
 public:
  /// @param part  of the best length so far, from which on they tell
  explicit ShorterPanels(double part) : part_(part) {}

  bool are_no_better(double length, double error) {
    gains_ = !std::isfinite(error) || length_ == 0 || error / length <= 0.5 * (error_ / length_);
    if (gains_ && std::isfinite(error)) {
      length_ = length;
      error_ = error;
    }
    constexpr double much = 1e-3;  // what errs by more than that many radians is not noise
    return error <= much && length <= part_ * length_;
  }
  /// What the last one has told.
  bool gains() const { return gains_; }
  double best_length() const { return length_; }
  bool is_constant(double error) const { return error > 0.5 * error_; }

 private:
  double part_;
  bool gains_ = true;
  double length_ = 0;
  double error_ = 0;
};

}  // namespace hybrid_sphere
