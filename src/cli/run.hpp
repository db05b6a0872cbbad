#pragma once

#include <iosfwd>

#include "cli/options.hpp"
#include "cli/output_sink.hpp"

namespace hybrid_sphere::cli {

/// Runs a scene as `simulate` does and returns its exit code. Files are written as the options say; a table
/// asked for with "-" goes to `out`, and so do explanations and timings unless a table does; all else that is
/// said goes to `err`.
/// @param bag  how bags are written; without it an option that wants one is refused
int run(const Options& options, std::ostream& out, std::ostream& err, const BagFormat* bag = nullptr);

}  // namespace hybrid_sphere::cli
