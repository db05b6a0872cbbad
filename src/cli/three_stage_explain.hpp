#pragma once

#include <string>

#include "catalogue/catalogue.hpp"

namespace hybrid_sphere::cli::three_stage {

/// A line for each entry: its name and its title.
std::string list();

/// What the entry is, what may be set, and what a run of it writes.
std::string explain(const mechanics::catalogue::Entry& entry);

}  // namespace hybrid_sphere::cli::three_stage
