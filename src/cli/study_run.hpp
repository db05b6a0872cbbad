#pragma once

#include <iosfwd>

#include "cli/study_options.hpp"
#include "study/team.hpp"

namespace hybrid_sphere::cli::studies {

/// Runs a study as `study` does, on one of the ranks of a team, and returns its exit code, the same on all
/// ranks. Rank 0 alone writes and speaks.
int run(const Options& options, study::Team& team, std::ostream& out, std::ostream& err);

/// How many processes compute a study that is not under mpirun: never more than it has chunks.
/// @param exit_code  out: done, or why the study is refused, which is said; the result is 0 then
int processes_for(const Options& options, std::ostream& err, int& exit_code);

/// Writes one run as a scene.
int write_scene(const Options& options, std::ostream& out, std::ostream& err);

}  // namespace hybrid_sphere::cli::studies
