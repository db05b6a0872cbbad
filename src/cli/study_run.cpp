#include "cli/study_run.hpp"

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <ostream>
#include <sstream>

#include "cli/arguments.hpp"
#include "cli/interrupt.hpp"
#include "cli/progress.hpp"
#include "cli/study_processes.hpp"
#include "cli/study_report.hpp"
#include "cli/table.hpp"
#include "hybrid_sphere/scene/scene_error.hpp"
#include "study/compute.hpp"
#include "study/fnv1a.hpp"
#include "study/results_file.hpp"
#include "study/study_scene.hpp"

namespace hybrid_sphere::cli::studies {
namespace {

using study::Experiment;
using study::Journal;
using study::Study;
using study::Team;

constexpr const char* program = "study";

/// What a rank begins with.
struct Begun {
  std::unique_ptr<Study> study;  // to which the experiment refers
  std::unique_ptr<Experiment> experiment;
  std::string refusal;  // why it cannot begin; empty if it can
};

Begun begin(const std::string& file) {
  Begun begun;
  try {
    begun.study = std::make_unique<Study>(study::read_study_file(file));
    begun.experiment = std::make_unique<Experiment>(*begun.study);
  } catch (const scene::SceneError& error) {
    begun.refusal = error.what();
  } catch (const std::bad_alloc&) {
    begun.refusal = "study file \"" + file + "\": too large for the available memory";
  }
  return begun;
}

/// What a rank is to agree on with rank 0: 'r' and why it refuses, or 'i' and a sum of what identifies study
/// and version.
std::string statement_of(const Begun& begun) {
  if (!begun.refusal.empty()) return "r" + begun.refusal;
  const std::string identity = study::identity_of(*begun.study);
  return "i" + std::to_string(identity.size()) + "," + std::to_string(study::fnv1a(identity));
}

/// The exit code where the ranks do not agree, said; 0 where they do.
int disagreement(const std::vector<std::string>& statements, std::ostream& err) {
  for (std::size_t rank = 0; rank < statements.size(); ++rank) {
    const std::string& statement = statements[rank];
    const std::string who = rank == 0 ? "" : "rank " + std::to_string(rank) + ": ";
    if (statement[0] == 'r') {
      write_error(program, who + statement.substr(1), err);
      return refused;
    }
    if (statement != statements.front()) {
      write_error(program, who + "has another study file, another scene or another version than rank 0", err);
      return refused;
    }
  }
  return done;
}

std::string journal_of(const std::string& output) { return output + ".unfinished"; }

/// What must not be overwritten, or is not there; empty when all is well.
std::string clash(const Options& options) {
  const bool has_output = std::filesystem::exists(options.output);
  const bool has_journal = std::filesystem::exists(journal_of(options.output));
  if (!options.resume && has_output) return refusal("-o", options.output, "a file that is not there yet");
  if (!options.resume && has_journal) {
    return refusal("-o", options.output,
                   "a file that is not there yet, or --resume " + options.output + ", as \"" +
                       journal_of(options.output) + "\" is there");
  }
  if (options.resume && !has_journal) {
    return refusal("--resume", options.output,
                   has_output ? "the file of a study that was ended; this one is complete"
                              : "the file of a study that was ended");
  }
  return "";
}

struct Figures {
  std::uint64_t runs = 0;
  int processes = 1;
  double computing = 0;  // [s]
  double whole = 0;      // [s]
  std::uint64_t bytes = 0;
};

void write_timing(const Figures& figures, std::ostream& out) {
  std::ostringstream line;
  line << "{\"runs\": " << figures.runs << ", \"processes\": " << figures.processes
       << ", \"compute_s\": " << figures.computing << ", \"wall_s\": " << figures.whole
       << ", \"runs_per_s\": " << static_cast<double>(figures.runs) / figures.computing
       << ", \"bytes\": " << figures.bytes << "}\n";
  out << line.str();
}

/// Rank 0, once all agree.
class Runner {
 public:
  Runner(const Options& options, const Begun& begun, Team& team, std::ostream& out, std::ostream& err)
      : options_(options),
        study_(*begun.study),
        experiment_(*begun.experiment),
        team_(team),
        out_(out),
        err_(err),
        progress_(err, options.quiet || !is_watched()) {}

  int run(Journal& journal) {
    const auto start = std::chrono::steady_clock::now();
    const Interrupt interrupt;
    const bool is_complete = study::compute_chunks(study_, experiment_, team_, journal,
                                                   {[&] { return interrupt.seen(); },
                                                    [&](std::uint64_t finished, std::uint64_t runs) {
                                                      progress_.show(static_cast<double>(finished),
                                                                     static_cast<double>(runs), "runs");
                                                    }});
    progress_.give_way();
    figures_.computing = seconds_since(start);
    if (!is_complete) return ended_by_signal(interrupt.signal());
    try {
      finish(journal, interrupt);
    } catch (const Interrupted&) {
      return ended_by_signal(interrupt.signal());
    }
    figures_.whole = seconds_since(start);
    if (options_.timing) write_timing(figures_, out_);
    if (!out_.flush()) throw WriteError("standard output cannot be written");
    return done;
  }

 private:
  static double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }

  void finish(const Journal& journal, const Interrupt& interrupt) {
    const study::Results results(study_, experiment_.columns(), journal, [&] { return interrupt.seen(); });
    const study::Analysis analysis = study::analyse(results);
    study::write_results_file(options_.output, results, analysis);
    if (!options_.csv.empty()) write_tables(options_.csv, results, analysis);
    std::remove(journal_of(options_.output).c_str());
    figures_.runs = study_.runs;
    figures_.processes = team_.size();
    figures_.bytes = std::filesystem::file_size(options_.output);
    if (!options_.quiet) out_ << report(results, analysis);
  }

  int ended_by_signal(int signal) {
    err_ << program << ": ended by signal " << signal << "; --resume " << options_.output
         << " goes on from what is finished\n";
    return by_signal + signal;
  }

  const Options& options_;
  const Study& study_;
  Experiment& experiment_;
  Team& team_;
  std::ostream& out_;
  std::ostream& err_;
  Progress progress_;
  Figures figures_;
};

/// Why the study is not begun, said; done if it can be.
int refuse(const Options& options, const std::vector<std::string>& statements, std::ostream& err) {
  const int disagrees = disagreement(statements, err);
  if (disagrees != done) return disagrees;
  const std::string clashes = clash(options);
  if (clashes.empty()) return done;
  write_error(program, clashes, err);
  return usage;
}

/// Says what has been thrown. @return  the exit code
int say(const std::exception_ptr& thrown, std::ostream& err) {
  try {
    std::rethrow_exception(thrown);
  } catch (const study::ForeignFile& error) {
    write_error(program, error.what(), err);
    return refused;
  } catch (const scene::SceneError& error) {
    write_error(program, error.what(), err);
    return refused;
  } catch (const std::exception& error) {
    write_error(program, error.what(), err);
    return could_not_go_on;
  }
}

/// Rank 0: says what is to be said before the runs, and opens the journal. @return  the exit code
int open_journal(const Options& options, const Begun& begun, std::optional<Journal>& journal,
                 std::ostream& err) {
  try {
    for (const std::string& warning : study::warnings(*begun.study, begun.experiment->variation())) {
      write_error(program, "warning: " + warning, err);
    }
    const std::string identity = study::identity_of(*begun.study);
    const std::string file = journal_of(options.output);
    journal.emplace(options.resume ? Journal::open(file, identity) : Journal::create(file, identity));
    return done;
  } catch (...) {
    return say(std::current_exception(), err);
  }
}

}  // namespace

int processes_for(const Options& options, std::ostream& err, int& exit_code) {
  const Begun begun = begin(options.study);
  exit_code = refuse(options, {statement_of(begun)}, err);
  if (exit_code != done) return 0;
  const std::uint64_t chunks = (begun.study->runs + begun.study->chunk - 1) / begun.study->chunk;
  const auto asked = static_cast<std::uint64_t>(options.processes.value_or(cores()));
  return static_cast<int>(std::min(asked, chunks));
}

int run(const Options& options, Team& team, std::ostream& out, std::ostream& err) {
  const Begun begun = begin(options.study);
  const std::vector<std::string> statements = team.gather(statement_of(begun));
  std::optional<Journal> journal;
  int code = done;
  if (team.rank() == 0) {
    code = refuse(options, statements, err);
    if (code == done) code = open_journal(options, begun, journal, err);
  }
  code = team.from_first(code);
  if (code != done) return code;
  if (team.rank() > 0) {
    study::compute_given_chunks(*begun.study, *begun.experiment, team);
    return team.from_first(code);
  }
  try {
    code = Runner(options, begun, team, out, err).run(*journal);
  } catch (...) {
    code = say(std::current_exception(), err);
  }
  return team.from_first(code);
}

int write_scene(const Options& options, std::ostream& out, std::ostream& err) {
  const Begun begun = begin(options.study);
  if (!begun.refusal.empty()) {
    write_error(program, begun.refusal, err);
    return refused;
  }
  if (*options.scene >= begun.study->runs) {
    const std::string last = std::to_string(begun.study->runs - 1);
    write_error(program,
                refusal("--scene", std::to_string(*options.scene), "a run of the study, 0 to " + last), err);
    return usage;
  }
  out << scene::to_yaml(begun.experiment->scene_of_run(*options.scene));
  if (out.flush()) return done;
  write_error(program, "standard output cannot be written", err);
  return could_not_go_on;
}

}  // namespace hybrid_sphere::cli::studies
