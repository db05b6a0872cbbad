#include "study/analysis.hpp"

#include <cmath>
#include <map>

namespace hybrid_sphere::study {
namespace {

/// Numbers that are counted or measured; neither the names of things nor the samples themselves.
bool is_output(const Columns& columns, std::size_t column) {
  const Column& shape = columns.all[column];
  return column >= columns.end && (shape.type == Column::Type::real || shape.names.empty());
}

bool is_sample(const Columns& columns, std::size_t column) { return column < columns.outcome; }

NumberAnalysis analyse(const Results& results, std::size_t column, std::size_t element) {
  const Study& study = results.study();
  const Column& shape = results.columns().all[column];
  NumberAnalysis number;
  number.name = name_of(shape, element);
  number.unit = shape.unit;
  const Blocks blocks = results.blocks(column, element);
  const Summarize asked = study.summarize.value_or(Summarize{});
  number.summary = summarize(blocks, asked.quantiles, asked.histogram);
  if (study.sensitivity && is_output(results.columns(), column)) {
    number.sensitivity = sobol_indices(blocks, study.variables.size(), study.seed);
  }
  return number;
}

Entered analyse_entered(const Results& results, std::size_t i, std::uint64_t trials) {
  Entered entered;
  entered.region = results.study().keep.entered[i];
  const Columns& columns = results.columns();
  for (std::uint64_t chunk = 0; chunk < results.chunks(); ++chunk) {
    const std::vector<double> times = results.values(chunk, columns.entered, i);
    const std::vector<double> outcomes = results.values(chunk, columns.outcome, 0);
    for (std::size_t k = 0; k < times.size(); ++k) {
      const bool counts = outcomes[k] == static_cast<double>(Outcome::done) && !std::isnan(times[k]);
      entered.runs += counts ? 1 : 0;
    }
  }
  entered.probability = trials > 0 ? static_cast<double>(entered.runs) / static_cast<double>(trials) : 0;
  entered.interval = probability_interval(entered.runs, trials);
  return entered;
}

void count_reasons(const Results& results, Analysis& analysis) {
  const Columns& columns = results.columns();
  const std::vector<std::string>& names = columns.all[columns.stop].names;
  if (analysis.halted > 0) {
    const std::vector<std::uint64_t> counts = results.counts_of_codes(columns.stop, names.size());
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (counts[i] > 0) analysis.halts.emplace_back(names[i], counts[i]);
    }
  }
  std::map<std::string, std::uint64_t> paths;
  for (const Refusal& refusal : results.refusals()) ++paths[refusal.path];
  analysis.refusals.assign(paths.begin(), paths.end());
}

}  // namespace

std::string name_of(const Column& column, std::size_t element) {
  std::string indices;
  for (std::size_t d = column.shape.size(); d-- > 0;) {
    indices.insert(0, "[" + std::to_string(element % column.shape[d]) + "]");
    element /= column.shape[d];
  }
  return column.name + indices;
}

Analysis analyse(const Results& results) {
  Analysis analysis;
  const Columns& columns = results.columns();
  const std::vector<std::uint64_t> outcomes = results.counts_of_codes(columns.outcome, 3);
  analysis.done = outcomes[0];
  analysis.halted = outcomes[1];
  analysis.refused = outcomes[2];
  count_reasons(results, analysis);
  const Study& study = results.study();
  for (std::size_t i = 0; i < study.keep.entered.size(); ++i) {
    analysis.entered.push_back(analyse_entered(results, i, analysis.done));
  }
  if (!study.summarize && !study.sensitivity) return analysis;
  for (std::size_t column = 0; column < columns.all.size(); ++column) {
    if (!is_output(columns, column) && !is_sample(columns, column)) continue;
    for (std::size_t i = 0; i < columns.all[column].size(); ++i) {
      analysis.numbers.push_back(analyse(results, column, i));
    }
  }
  return analysis;
}

}  // namespace hybrid_sphere::study
