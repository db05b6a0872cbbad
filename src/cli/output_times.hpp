#pragma once

#include <optional>
#include <vector>

namespace hybrid_sphere::cli {

/// The times asked for: a list, or n/rate for n = 0, 1, 2 ... up to the duration, as in the node.
class OutputTimes {
 public:
  /// @param times  ascending [s]
  explicit OutputTimes(std::vector<double> times) : times_(std::move(times)) {}
  /// @param duration  [s] @param rate  [Hz]
  OutputTimes(double duration, double rate) : duration_(duration), rate_(rate) {}

  bool at_end() const { return times_ ? next_ == times_->size() : current() > duration_; }
  double current() const { return times_ ? (*times_)[next_] : static_cast<double>(next_) / rate_; }
  void advance() { ++next_; }
  double last() const { return times_ ? (times_->empty() ? 0 : times_->back()) : duration_; }

 private:
  std::optional<std::vector<double>> times_;
  double duration_ = 0;
  double rate_ = 1;
  std::size_t next_ = 0;
};

}  // namespace hybrid_sphere::cli
