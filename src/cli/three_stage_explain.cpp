#include "cli/three_stage_explain.hpp"

#include <algorithm>
#include <iomanip>
#include <sstream>

#include "cli/three_stage_csv.hpp"

namespace hybrid_sphere::cli::three_stage {
namespace {

using mechanics::catalogue::Entry;
using mechanics::catalogue::Example;
using mechanics::catalogue::Parameter;

template <class Named>
int width_of(const std::vector<Named>& all) {
  std::size_t width = 0;
  for (const Named& one : all) width = std::max(width, one.name.size());
  return static_cast<int>(width);
}

void write_parameters(const Entry& entry, std::ostream& text) {
  text << "Parameters (--set KEY=VALUE):\n";
  const int width = width_of(entry.parameters);
  for (const Parameter& parameter : entry.parameters) {
    std::ostringstream value;
    value << parameter.value;
    std::ostringstream range;
    range << parameter.low << " to " << parameter.high;
    text << "  " << std::left << std::setw(width) << parameter.name << "  " << std::setw(9) << value.str()
         << "  " << std::setw(16) << range.str() << "  " << parameter.meaning << '\n';
  }
}

}  // namespace

std::string list() {
  const auto& entries = mechanics::catalogue::entries();
  const int width = width_of(entries);
  std::ostringstream text;
  for (const Entry& entry : entries) {
    text << std::left << std::setw(width) << entry.name << "  " << entry.title << '\n';
  }
  return text.str();
}

std::string explain(const Entry& entry) {
  const Example example = entry.build(mechanics::catalogue::Values(entry.parameters));
  std::ostringstream text;
  text << entry.name << ": " << entry.title << "\n\n" << entry.description;
  if (!entry.description.empty() && entry.description.back() != '\n') text << '\n';
  text << '\n';
  write_parameters(entry, text);
  text << "\nDefault duration: " << entry.duration << " s; characteristic time " << entry.characteristic_time
       << " s.\nMonitored: ";
  for (const auto& invariant : example.invariants) text << invariant.name << "; ";
  text << (example.known ? "the difference from the known solution" : "no known solution")
       << ".\nColumns of --states: " << states_header(example.model)
       << "\nColumns of --switches: " << switches_header(example.model) << '\n';
  return text.str();
}

}  // namespace hybrid_sphere::cli::three_stage
