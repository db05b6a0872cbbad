#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hybrid_sphere/simulation/records.hpp"
#include "python/forward.hpp"

namespace hybrid_sphere::python {

/// Switches of one run or several, and the array of them: its fields are the columns of the switches that
/// `simulate` writes, and `cause`.
class KeptSwitches {
 public:
  void add(const Switch& event, std::uint64_t run = 0);
  void clear() { kept_.clear(); }
  std::size_t size() const { return kept_.size(); }
  /// Puts those of others behind these.
  void append(KeptSwitches&& others);

  /// To be called with the lock of the interpreter.
  /// @param with_runs     the first field is `run` then
  /// @param region_width  characters of the longest name of a region
  pybind11::array array(bool with_runs, std::size_t region_width) const;

 private:
  struct Kept {
    Switch event;  // but for its names
    std::string from_region;
    std::string to_region;
    std::uint64_t run;
  };

  std::vector<Kept> kept_;
};

}  // namespace hybrid_sphere::python
