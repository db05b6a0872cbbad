#pragma once

namespace hybrid_sphere::cli::studies {

/// Replaces this process by the same program under mpirun. Returns only if there is no mpirun.
/// @param processes  how many of them
void run_under_mpirun(int processes, int argc, char** argv);

/// How many cores this process may use.
int cores();

/// Whether standard error of this process, or of the one that has started mpirun, is a terminal.
bool is_watched();

}  // namespace hybrid_sphere::cli::studies
