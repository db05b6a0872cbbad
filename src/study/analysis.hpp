#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "study/results.hpp"
#include "study/sobol_indices.hpp"
#include "study/statistics.hpp"

namespace hybrid_sphere::study {

/// Of one number that each run leaves.
struct NumberAnalysis {
  std::string name;  ///< end/position[0]
  std::string unit;
  Summary summary;
  SobolIndices sensitivity;  ///< empty unless the study asks for it
};

/// How many runs entered a region, and the probability of that.
struct Entered {
  std::string region;
  std::uint64_t runs = 0;
  double probability = 0;
  Interval interval{0, 1};  ///< 95 %
};

/// What follows from all runs together.
struct Analysis {
  std::uint64_t done = 0;
  std::uint64_t halted = 0;
  std::uint64_t refused = 0;
  std::vector<std::pair<std::string, std::uint64_t>> halts;     ///< why, and how often
  std::vector<std::pair<std::string, std::uint64_t>> refusals;  ///< which path, and how often
  std::vector<NumberAnalysis> numbers;  ///< if the study asks for summaries or sensitivities
  std::vector<Entered> entered;         ///< of the runs that were neither halted nor refused
};

Analysis analyse(const Results& results);

/// "end/position[0]": an element of a column.
std::string name_of(const Column& column, std::size_t element);

}  // namespace hybrid_sphere::study
