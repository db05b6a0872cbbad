#pragma once

#include <iosfwd>
#include <string>

#include "cli/three_stage_deviation.hpp"

namespace hybrid_sphere::cli::three_stage {

/// What is said about a run when it has ended: how it ended, and how well it agrees with what is known.
class Summary {
 public:
  /// @param example   has to live as long as this, like the others
  /// @param step      time between two outputs, as a rule [s]
  /// @param accuracy  that was asked for
  Summary(const mechanics::catalogue::Example& example, const mechanics::Model& model,
          const mechanics::Solution& solution, double step, double accuracy);

  /// Takes in an output.
  void add(const mechanics::State& state);

  /// Several lines, the first one begins with "three_stage: NAME: ".
  void write(const std::string& name, std::ostream& err) const;

 private:
  bool comparable(const mechanics::State& state) const;
  void write_deviation(std::ostream& err) const;
  void write_invariants(std::ostream& err) const;
  void write_constraints(std::ostream& err) const;

  const mechanics::catalogue::Example* example_;
  const mechanics::Model* model_;
  const mechanics::Solution* solution_;
  double window_;  // of time about a guard's switch in which nothing is compared [s]
  Deviation deviation_;
  double begin_;  // of the motion after the last switch [s]
  std::uint64_t outputs_ = 0;
  std::uint64_t covered_ = 0;  // outputs at which something is known
  double residual_ = 0;
  std::vector<double> invariants_;  // at begin_; empty where no constraint holds then
  std::vector<double> drifts_;      // largest abs so far
};

}  // namespace hybrid_sphere::cli::three_stage
