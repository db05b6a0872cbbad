#include "html/recording.hpp"

#include <algorithm>

namespace hybrid_sphere::html {
namespace {

/// Kept of a long run, of which the even choice is made at the end.
constexpr std::size_t max_kept = 8 * Recording::max_states;

}  // namespace

std::string_view Recording::kept(std::string_view name) {
  const auto found = names_.find(name);
  return found != names_.end() ? *found : *names_.emplace(name).first;
}

void Recording::add(const State& state) {
  last_ = state;
  last_.region = kept(state.region);
  if (states_in_all_++ % stride_ != 0) return;
  states_.push_back(last_);
  if (states_.size() < max_kept) return;
  for (std::size_t i = 0; 2 * i < states_.size(); ++i) states_[i] = states_[2 * i];
  states_.resize(states_.size() / 2);
  stride_ *= 2;
}

void Recording::add(const Switch& event, bool has_cause) {
  ++switches_in_all_;
  if (switches_.size() == max_switches) return;
  switches_.push_back(event);
  has_cause_.push_back(has_cause);
  switches_.back().from_region = kept(event.from_region);
  switches_.back().to_region = kept(event.to_region);
}

std::vector<State> Recording::states() const {
  const bool last_is_kept = states_in_all_ == 0 || (states_in_all_ - 1) % stride_ == 0;
  std::vector<State> chosen;
  const std::size_t size = states_.size() + (last_is_kept ? 0 : 1);
  const std::size_t count = std::min(size, max_states);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t at = count < 2 ? 0 : i * (size - 1) / (count - 1);
    chosen.push_back(at < states_.size() ? states_[at] : last_);
  }
  return chosen;
}

}  // namespace hybrid_sphere::html
