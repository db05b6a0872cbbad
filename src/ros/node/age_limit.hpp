#pragma once

#include <optional>

namespace hybrid_sphere::ros_interface {

/// How long an input from outside acts when no newer one comes. It acts for at least one tick, however long
/// that is.
class AgeLimit {
 public:
  /// @param longest  [s]; 0: without end
  explicit AgeLimit(double longest) : longest_(longest) {}

  double longest() const { return longest_; }

  /// There is a new input: its age counts from the next call of is_over().
  void begin() { since_.reset(); }

  /// Whether the input is older than the limit.
  /// @param clock  reading of the clock by which it ages [s], at a tick
  bool is_over(double clock) {
    if (!since_) since_ = clock;
    return longest_ != 0 && clock - *since_ > longest_;
  }

 private:
  double longest_;
  std::optional<double> since_;
};

}  // namespace hybrid_sphere::ros_interface
