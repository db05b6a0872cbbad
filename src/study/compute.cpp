#include "study/compute.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

namespace hybrid_sphere::study {
namespace {

std::uint64_t runs_of(const Study& study, std::uint64_t chunk) {
  return std::min(study.chunk, study.runs - chunk * study.chunk);
}

void compute(const Study& study, Experiment& experiment, std::uint64_t number, Chunk& chunk,
             const std::function<bool()>& should_stop, std::vector<unsigned char>& bytes) {
  experiment.run(number * study.chunk, runs_of(study, number), chunk, should_stop);
  chunk.encode(bytes);
}

/// Hands out chunks, and keeps what comes back.
class Coordinator {
 public:
  Coordinator(const Study& study, Team& team, Journal& journal, const Observer& observer)
      : study_(study), team_(team), journal_(journal), observer_(observer) {
    const std::uint64_t chunks = (study.runs + study.chunk - 1) / study.chunk;
    for (std::uint64_t chunk = 0; chunk < chunks; ++chunk) {
      if (journal.has(chunk)) finished_ += runs_of(study, chunk);
    }
    chunks_ = chunks;
  }

  /// The next chunk that nobody computes yet.
  std::optional<std::uint64_t> next() {
    while (next_ < chunks_ && journal_.has(next_)) ++next_;
    if (next_ == chunks_ || is_stopping_) return std::nullopt;
    return next_++;
  }

  void begin() {
    constexpr int ahead = 2;  // so that nobody waits for an answer
    for (int i = 0; i < ahead; ++i) {
      for (int rank = 1; rank < team_.size(); ++rank) assign(rank);
    }
  }

  void keep(std::uint64_t chunk, const std::vector<unsigned char>& bytes) {
    journal_.append(chunk, bytes);
    finished_ += runs_of(study_, chunk);
    observer_.show(finished_, study_.runs);
  }

  /// Takes what has come from others. Throws nothing, as it is called from within a simulation.
  /// @return  whether all is to stop
  bool serve() {
    while (auto result = team_.receive()) {
      assign(result->rank);
      if (failure_) continue;  // what comes is thrown away
      try {
        keep(result->chunk, result->bytes);
      } catch (...) {
        fail(std::current_exception());
      }
    }
    if (observer_.should_stop()) stop();
    return is_stopping_;
  }

  /// Until the others have nothing more. @throws  what has been noted
  void serve_to_the_end() {
    while (!team_.have_all_finished()) {
      serve();
      std::this_thread::sleep_for(std::chrono::microseconds(50));
    }
    serve();
    if (failure_) std::rethrow_exception(failure_);
  }

  /// Notes why nothing more can be done.
  void fail(const std::exception_ptr& failure) {
    failure_ = failure;
    stop();
  }

  bool is_complete() const { return finished_ == study_.runs; }

 private:
  void stop() {
    if (!std::exchange(is_stopping_, true)) team_.stop();
  }

  void assign(int rank) {
    const std::optional<std::uint64_t> chunk = next();
    team_.assign(rank, chunk ? static_cast<std::int64_t>(*chunk) : Team::no_more);
  }

  const Study& study_;
  Team& team_;
  Journal& journal_;
  const Observer& observer_;
  std::uint64_t chunks_ = 0;
  std::uint64_t next_ = 0;
  std::uint64_t finished_ = 0;  // runs
  bool is_stopping_ = false;
  std::exception_ptr failure_;
};

}  // namespace

bool compute_chunks(const Study& study, Experiment& experiment, Team& team, Journal& journal,
                    const Observer& observer) {
  Coordinator coordinator(study, team, journal, observer);
  Chunk chunk(experiment.columns().all);
  std::vector<unsigned char> bytes;
  coordinator.begin();
  try {
    while (const auto number = coordinator.next()) {
      compute(
          study, experiment, *number, chunk, [&] { return coordinator.serve(); }, bytes);
      coordinator.keep(*number, bytes);
    }
  } catch (const Interrupted&) {
    // What is not finished is computed again.
  } catch (...) {
    coordinator.fail(std::current_exception());
  }
  coordinator.serve_to_the_end();
  return coordinator.is_complete();
}

void compute_given_chunks(const Study& study, Experiment& experiment, Team& team) {
  Chunk chunk(experiment.columns().all);
  try {
    for (std::int64_t number = team.next_chunk(); number != Team::no_more; number = team.next_chunk()) {
      std::vector<unsigned char> bytes;
      compute(
          study, experiment, static_cast<std::uint64_t>(number), chunk, [&] { return team.is_stopped(); },
          bytes);
      team.send(static_cast<std::uint64_t>(number), std::move(bytes));
    }
  } catch (const Interrupted&) {
    // What is not finished is computed again.
  }
  team.finish();
}

}  // namespace hybrid_sphere::study
