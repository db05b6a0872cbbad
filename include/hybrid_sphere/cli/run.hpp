#pragma once

#include <iosfwd>

#include "hybrid_sphere/cli/options.hpp"

namespace hybrid_sphere::cli {

/// Runs a scene as `simulate` does and returns its exit code. Files are written as the options say; a table
/// asked for with "-" goes to `out`, and so do explanations and timings unless a table does; all else that is
/// said goes to `err`.
int run(const Options& options, std::ostream& out, std::ostream& err);

}  // namespace hybrid_sphere::cli
