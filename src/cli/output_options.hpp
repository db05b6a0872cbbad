#pragma once

#include <optional>
#include <string>
#include <vector>

namespace hybrid_sphere::cli {

/// When and where a program writes.
struct OutputOptions {
  std::optional<double> duration;            ///< [s]; none: that of the system
  std::optional<double> rate;                ///< outputs per second [Hz]; none: that of the system
  std::optional<std::vector<double>> times;  ///< output times instead of both, ascending [s]
  std::string states;                        ///< file, "-" for standard output, empty for none
  std::string switches;                      ///< the same
  bool quiet = false;
};

}  // namespace hybrid_sphere::cli
