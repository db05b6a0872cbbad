#pragma once

#include <string>

#include "hybrid_sphere/mechanics/solution.hpp"

/// The two tables that `three_stage` writes, with a column for each coordinate, velocity and multiplier of
/// the model.
namespace hybrid_sphere::cli::three_stage {

std::string states_header(const mechanics::Model& model);
std::string switches_header(const mechanics::Model& model);

/// Puts a row with its line feed at the end of `text`.
void append_row(const mechanics::State& state, std::string& text);
void append_row(const mechanics::Model& model, const mechanics::Switch& event, std::string& text);

}  // namespace hybrid_sphere::cli::three_stage
