#include "cli/three_stage_csv.hpp"

#include "cli/csv_row.hpp"

namespace hybrid_sphere::cli::three_stage {
namespace {

using mechanics::Index;
using mechanics::Vector;

void put(CsvRow& row, const Vector& values) {
  for (const double value : values) row << value;
}

void put(CsvRow& row, const std::vector<std::string>& names, const std::string& prefix,
         const std::string& suffix) {
  for (const std::string& name : names) row << prefix + name + suffix;
}

/// "lambda_rolling", or "lambda_rolling_1", ... where a constraint has several functions.
void put_multipliers(CsvRow& row, const mechanics::Model& model, const std::string& prefix) {
  for (const mechanics::Constraint& constraint : model.constraints) {
    const Index size = constraint.function->size();
    for (Index i = 1; i <= size; ++i) {
      row << prefix + constraint.name + (size > 1 ? "_" + std::to_string(i) : "");
    }
  }
}

/// "blade;rolling"
std::string joined(const mechanics::Model& model, const mechanics::ActiveSet& set) {
  std::string text;
  for (const std::size_t i : set) text += (text.empty() ? "" : ";") + model.constraints[i].name;
  return text;
}

}  // namespace

std::string states_header(const mechanics::Model& model) {
  std::string text;
  CsvRow row(text);
  row << "t"
      << "stage";
  put(row, model.coordinates, "", "");
  put(row, model.velocities, "", "");
  put_multipliers(row, model, "lambda_");
  row << "energy"
      << "kinetic_energy"
      << "residual";
  return text;
}

std::string switches_header(const mechanics::Model& model) {
  std::string text;
  CsvRow row(text);
  row << "index"
      << "t"
      << "applied"
      << "released";
  put(row, model.coordinates, "", "");
  put(row, model.velocities, "", "_before");
  put(row, model.velocities, "", "_after");
  put_multipliers(row, model, "Lambda_");
  put(row, model.velocities, "P_", "");
  row << "rank"
      << "energy_before"
      << "energy_after"
      << "kinetic_energy_before"
      << "kinetic_energy_after";
  return text;
}

void append_row(const mechanics::State& state, std::string& text) {
  CsvRow row(text);
  row << state.time << static_cast<std::uint64_t>(state.stage);
  put(row, state.q);
  put(row, state.v);
  put(row, state.multipliers);
  row << state.energy << state.kinetic_energy << state.residual;
  row.end();
}

void append_row(const mechanics::Model& model, const mechanics::Switch& event, std::string& text) {
  CsvRow row(text);
  row << event.index << event.time << joined(model, event.applied) << joined(model, event.released);
  put(row, event.q);
  put(row, event.v_before);
  put(row, event.v_after);
  put(row, event.multipliers);
  put(row, event.impulse);
  row << static_cast<std::uint64_t>(event.rank) << event.energy_before << event.energy_after
      << event.kinetic_energy_before << event.kinetic_energy_after;
  row.end();
}

}  // namespace hybrid_sphere::cli::three_stage
