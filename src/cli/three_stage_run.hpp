#pragma once

#include <functional>
#include <iosfwd>

#include "cli/three_stage_options.hpp"

namespace hybrid_sphere::cli::three_stage {

/// Does what `three_stage` was asked to do and returns its exit code. Texts asked for and a table asked for
/// with "-" go to `out`; all else that is said goes to `err`. Ctrl-C ends a motion, and what is computed up
/// to there is written.
/// @param cancelled  asked after each step unless it is empty; true ends the motion as Ctrl-C does
int run(const Options& options, std::ostream& out, std::ostream& err,
        const std::function<bool()>& cancelled = {});

}  // namespace hybrid_sphere::cli::three_stage
