#pragma once

#include <string>

#include "study/analysis.hpp"

namespace hybrid_sphere::cli::studies {

/// What follows from a study, for people: outcomes, probabilities, summaries, sensitivities.
std::string report(const study::Results& results, const study::Analysis& analysis);

/// Writes runs.csv, summary.csv and, if asked for, sensitivity.csv into a directory, which is made.
/// @throws WriteError
void write_tables(const std::string& directory, const study::Results& results,
                  const study::Analysis& analysis);

}  // namespace hybrid_sphere::cli::studies
