#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "hybrid_sphere/simulation/records.hpp"

namespace hybrid_sphere::html {

/// What a page keeps of a run, in bounded memory however long the run is: of many states an even choice, of
/// many switches the first ones. It holds the names of the regions itself.
class Recording {
 public:
  static constexpr std::size_t max_states = 10'001;
  static constexpr std::size_t max_switches = 2'000;

  Recording() = default;
  Recording(const Recording&) = delete;  // the states point to its names
  Recording& operator=(const Recording&) = delete;

  /// In the order of time. Of a state the slip is not used, of a switch neither the index nor the slip.
  void add(const State& state);
  /// @param has_cause  a table of switches has none
  void add(const Switch& event, bool has_cause = true);

  /// At most max_states, the first and the last one among them.
  std::vector<State> states() const;
  /// At most max_switches.
  const std::vector<Switch>& switches() const { return switches_; }
  /// Of each of these, whether its cause is known.
  const std::vector<bool>& has_cause() const { return has_cause_; }
  /// How many were added.
  std::uint64_t states_in_all() const { return states_in_all_; }
  std::uint64_t switches_in_all() const { return switches_in_all_; }

 private:
  std::string_view kept(std::string_view name);

  std::vector<State> states_;  // every stride_-th of those that were added
  std::uint64_t stride_ = 1;
  State last_;
  std::vector<Switch> switches_;
  std::vector<bool> has_cause_;
  std::uint64_t states_in_all_ = 0;
  std::uint64_t switches_in_all_ = 0;
  std::set<std::string, std::less<>> names_;
};

}  // namespace hybrid_sphere::html
