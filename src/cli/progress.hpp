#pragma once

#include <chrono>
#include <iosfwd>

namespace hybrid_sphere::cli {

/// A bar on a terminal for what takes longer than two seconds.
class Progress {
 public:
  /// @param silent  never show anything: asked for, or no terminal
  Progress(std::ostream& err, bool silent) : err_(err), silent_(silent) {}
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// @param done, whole  in the same unit
  /// @param unit         if it is not empty, how many of them a second, and the time that is left, are shown,
  /// too
  void show(double done, double whole, const char* unit = "");

  /// Ends the line of the bar, so that something else can be said.
  void give_way();

 private:
  using Clock = std::chrono::steady_clock;

  std::ostream& err_;
  bool silent_;
  bool shown_ = false;
  Clock::time_point begin_ = Clock::now();
  Clock::time_point next_ = begin_ + std::chrono::seconds(2);
  double done_at_begin_ = -1;
};

}  // namespace hybrid_sphere::cli
