#pragma once

#include <string>

#include "study/analysis.hpp"
#include "study/results.hpp"

namespace hybrid_sphere::study {

/// Writes the results as HDF5 (docs/studies.md): the study, the samples, a dataset of each kept quantity,
/// what follows from them. Its bytes depend on the study and the version alone. It is there as a whole or not
/// at all.
/// @throws FileError
void write_results_file(const std::string& file, const Results& results, const Analysis& analysis);

/// What tells a study of this version from others: in the file, and in the journal.
std::string identity_of(const Study& study);

}  // namespace hybrid_sphere::study
