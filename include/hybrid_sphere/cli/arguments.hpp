#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace hybrid_sphere::cli {

constexpr double longest_duration = 1e12;  ///< [s]

/// An argument that is refused, with its option, its value and what is allowed.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Reads a finite number. Throws UsageError unless low <= number <= high.
double number_from(const std::string& option, const std::string& text, double low, double high);

/// Reads ascending times [s], comma-separated. Throws UsageError.
std::vector<double> times_from(const std::string& option, const std::string& text);

}  // namespace hybrid_sphere::cli
