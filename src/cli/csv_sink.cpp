#include "cli/csv_sink.hpp"

#include "cli/csv.hpp"

namespace hybrid_sphere::cli {

StatesSink::StatesSink(const std::string& path, std::ostream& out) : table_(path, states_header, out) {}

void StatesSink::write(const OutputBlock& block) {
  for (const State& state : block.states) append_row(state, table_.rows());
  table_.write();
}

SwitchesSink::SwitchesSink(const std::string& path, std::ostream& out) : table_(path, switches_header, out) {}

void SwitchesSink::write(const OutputBlock& block) {
  for (const Switch& event : block.switches) append_row(event, table_.rows());
  table_.write();
}

}  // namespace hybrid_sphere::cli
