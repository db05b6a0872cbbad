#pragma once

#include <cstdint>
#include <vector>

#include "study/study.hpp"

namespace hybrid_sphere::study {

/// The values of the variables in each run.
class Samples {
 public:
  explicit Samples(const Study& study);

  std::size_t variables() const { return distributions_.size(); }

  /// Fills the values of the runs first .. first + count - 1, a run after another.
  /// @param out  count * variables() numbers
  void values(std::uint64_t first, std::uint64_t count, double* out) const;

 private:
  Sampler sampler_;
  std::vector<Distribution> distributions_;
  std::vector<Correlation> correlations_;
  std::vector<double> means_;  // of their variables, a correlation after another
};

}  // namespace hybrid_sphere::study
