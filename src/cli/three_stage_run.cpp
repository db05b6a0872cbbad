#include "cli/three_stage_run.hpp"

#include <unistd.h>

#include <algorithm>
#include <iostream>
#include <new>
#include <ostream>
#include <stdexcept>

#include "cli/arguments.hpp"
#include "cli/interrupt.hpp"
#include "cli/output_times.hpp"
#include "cli/progress.hpp"
#include "cli/table.hpp"
#include "cli/three_stage_csv.hpp"
#include "cli/three_stage_explain.hpp"
#include "cli/three_stage_summary.hpp"

namespace hybrid_sphere::cli::three_stage {
namespace {

using mechanics::Solution;
using mechanics::catalogue::Entry;
using mechanics::catalogue::Example;
using mechanics::catalogue::Parameter;
using mechanics::catalogue::Values;

constexpr std::uint64_t usual_outputs = 100;  // after the one at the start
constexpr std::size_t block = 1 << 20;        // bytes of a table between two writes
constexpr std::uint64_t glance = 1000;        // steps between two looks at the clock

/// The system is refused.
struct Refused : std::runtime_error {
  using std::runtime_error::runtime_error;
};

Values values_from(const Entry& entry, const Options& options) {
  Values values(entry.parameters);
  for (const auto& [key, text] : options.values) {
    const std::string& name = key;
    const auto parameter = std::find_if(entry.parameters.begin(), entry.parameters.end(),
                                        [&name](const Parameter& one) { return one.name == name; });
    if (parameter == entry.parameters.end()) {
      std::string allowed;
      for (const Parameter& one : entry.parameters) allowed += (allowed.empty() ? "" : ", ") + one.name;
      throw Refused(refusal("--set", key + "=" + text, allowed));
    }
    try {
      values.set(key, number_from("--set " + key, text, parameter->low, parameter->high));
    } catch (const UsageError& error) {
      throw Refused(error.what());
    }
  }
  return values;
}

OutputTimes output_times(const Options& options, double duration) {
  if (options.times) return OutputTimes(*options.times);
  if (options.rate) return {duration, *options.rate};
  std::vector<double> times{0};
  for (std::uint64_t i = 1; i <= usual_outputs && duration > 0; ++i) {
    times.push_back(duration * (static_cast<double>(i) / static_cast<double>(usual_outputs)));
  }
  return OutputTimes(std::move(times));
}

/// One system with its numbers, and how long it is to move.
struct Question {
  explicit Question(const Options& options)
      : entry(mechanics::catalogue::entry(options.name)),
        example(entry.build(values_from(entry, options))),
        model(options.by_hand ? example.by_hand : example.model),
        duration(options.times ? options.times->back() : options.duration.value_or(entry.duration)) {
    solver.accuracy = options.accuracy;
    solver.project_initial = options.project;
    solver.max_steps = options.max_steps;
    solver.max_step = options.max_step;
  }

  /// Refuses what is wrong with the question.
  void check() const { mechanics::solve(model, example.initial, 0, solver); }

  const Entry& entry;
  Example example;
  const mechanics::Model& model;
  double duration;
  mechanics::Options solver;
};

/// Shows how far it is; ended by a signal, and where `cancelled` answers true.
/// @param signal  out: the signal that has come meanwhile, or 0
Solution solve(const Question& question, bool quiet, std::ostream& err,
               const std::function<bool()>& cancelled, int& signal) {
  Progress progress(err, quiet || &err != &std::cerr || isatty(STDERR_FILENO) == 0);
  const Interrupt interrupt;
  mechanics::Options solver = question.solver;
  solver.monitor = [&](const mechanics::Progress& so_far) {
    if (so_far.steps % glance == 0) {
      progress.show(so_far.time - question.example.initial.time, question.duration);
    }
    return !(cancelled && cancelled()) && !interrupt.seen();
  };
  Solution solution = mechanics::solve(question.model, question.example.initial, question.duration, solver);
  signal = interrupt.signal();
  return solution;
}

void warn_of_singularity(const Solution& solution, std::ostream& err) {
  constexpr double near = 1e-3;
  if (solution.regularity() >= near) return;
  err << "three_stage: warning: M is nearly singular at t = " << solution.least_regular_time()
      << " s, as where coordinates degenerate: its smallest pivot there, relative to its diagonal, is "
      << solution.regularity() << "; results lose digits\n";
}

void write_switches(const Question& question, const Solution& solution, Table& table) {
  if (!table.wanted()) return;
  for (const mechanics::Switch& event : solution.switches()) {
    append_row(question.model, event, table.rows());
    if (table.rows().size() >= block) table.write();
  }
  table.write();
}

/// Times count from the start of the motion; those behind its end are left out.
void write_states(const Solution& solution, OutputTimes times, Table& table, Summary& summary) {
  for (; !times.at_end(); times.advance()) {
    const double time = solution.begin() + times.current();
    if (time > solution.end()) break;
    const mechanics::State state = solution.at(time);
    summary.add(state);
    if (!table.wanted()) continue;
    append_row(state, table.rows());
    if (table.rows().size() >= block) table.write();
  }
  table.write();
}

int compute(const Question& question, const Options& options, std::ostream& out, std::ostream& err,
            const std::function<bool()>& cancelled) {
  question.check();  // before a file is touched
  Table states(options.states, states_header(question.model), out);
  const bool neither = options.states.empty() && options.switches.empty();
  Table switches(neither ? "-" : options.switches, switches_header(question.model), out);

  int signal = 0;
  const Solution solution = solve(question, options.quiet, err, cancelled, signal);
  write_switches(question, solution, switches);
  const double step =
      options.rate ? 1 / *options.rate : question.duration / static_cast<double>(usual_outputs);
  Summary summary(question.example, question.model, solution, step, options.accuracy);
  write_states(solution, output_times(options, question.duration), states, summary);
  if (!out.flush()) throw WriteError("standard output cannot be written");
  if (!options.quiet) {
    summary.write(question.entry.name, err);
    warn_of_singularity(solution, err);
  }
  const mechanics::Status& status = solution.status();
  if (status.stop == mechanics::Stop::reached_end) return done;
  if (signal != 0) return ended_by("three_stage", signal, status.time, err);
  err << "three_stage: stopped at t = " << status.time << " s: " << mechanics::to_string(status.stop) << ": "
      << status.message << '\n';
  return could_not_go_on;
}

int run_system(const Options& options, std::ostream& out, std::ostream& err,
               const std::function<bool()>& cancelled) {
  if (same_file(options.states, options.switches)) {
    write_error("three_stage", refusal("--switches", options.switches, "a file other than that of --states"),
                err);
    return usage;
  }
  const Question question(options);
  return compute(question, options, out, err, cancelled);
}

}  // namespace

int run(const Options& options, std::ostream& out, std::ostream& err,
        const std::function<bool()>& cancelled) {
  try {
    switch (options.command) {
      case Command::list: out << list(); break;
      case Command::explain: out << explain(mechanics::catalogue::entry(options.name)); break;
      case Command::run: return run_system(options, out, err, cancelled);
    }
    if (!out.flush()) throw WriteError("standard output cannot be written");
    return done;
  } catch (const Refused& error) {
    write_error("three_stage", error.what(), err);
    return refused;
  } catch (const std::invalid_argument& error) {
    write_error("three_stage", error.what(), err);
    return refused;
  } catch (const std::bad_alloc&) {
    write_error("three_stage", "the motion is too large for the available memory", err);
    return could_not_go_on;
  } catch (const std::exception& error) {
    write_error("three_stage", error.what(), err);
    return could_not_go_on;
  }
}

}  // namespace hybrid_sphere::cli::three_stage
