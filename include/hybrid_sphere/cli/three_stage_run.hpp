#pragma once

#include <iosfwd>

#include "hybrid_sphere/cli/three_stage_options.hpp"

namespace hybrid_sphere::cli::three_stage {

/// Does what `three_stage` was asked to do and returns its exit code. Texts asked for and a table asked for
/// with "-" go to `out`; all else that is said goes to `err`.
int run(const Options& options, std::ostream& out, std::ostream& err);

}  // namespace hybrid_sphere::cli::three_stage
