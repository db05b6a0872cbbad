#pragma once

#include <cstdint>
#include <functional>

#include "study/experiment.hpp"
#include "study/journal.hpp"
#include "study/team.hpp"

namespace hybrid_sphere::study {

/// What rank 0 is told and asked while it computes.
struct Observer {
  std::function<bool()> should_stop;                                     ///< by a signal
  std::function<void(std::uint64_t finished, std::uint64_t runs)> show;  ///< progress, in runs
};

/// Rank 0: computes the chunks that the journal does not have yet, together with the other ranks, and appends
/// them. @return  whether all are there; false if it was to stop
/// @throws FileError  if the journal cannot be written; the others are stopped then
bool compute_chunks(const Study& study, Experiment& experiment, Team& team, Journal& journal,
                    const Observer& observer);

/// Any other rank: computes the chunks that it is given.
void compute_given_chunks(const Study& study, Experiment& experiment, Team& team);

}  // namespace hybrid_sphere::study
