#include "cli/run.hpp"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <memory>
#include <new>
#include <sstream>
#include <utility>

#include "cli/arguments.hpp"
#include "cli/csv_sink.hpp"
#include "cli/explain.hpp"
#include "cli/html_sink.hpp"
#include "cli/interrupt.hpp"
#include "cli/output_times.hpp"
#include "cli/progress.hpp"
#include "cli/table.hpp"
#include "html/page.hpp"
#include "hybrid_sphere/scene/read_scene.hpp"
#include "hybrid_sphere/simulation/simulation.hpp"
#include "simulation/check_method.hpp"
#include "simulation/error_estimate.hpp"
#include "text/refusal.hpp"

namespace hybrid_sphere::cli {
namespace {

constexpr std::size_t block = 4096;          // outputs computed between two writes
constexpr std::size_t max_switches = 65536;  // kept between two writes

struct Measured {
  std::chrono::steady_clock::duration wall{};
  std::uint64_t outputs = 0;
  std::uint64_t switches = 0;
  std::uint64_t evaluations = 0;  // right-hand sides
  double simulated = 0;
  double fastest_spin = 0;  // |omega| [rad/s]
  double error = 0;
  double integrated = 0;  // the part of it that the steps of a method have
};

void write_timing(const Measured& measured, std::ostream& out) {
  const double wall = std::max(1e-9, std::chrono::duration<double>(measured.wall).count());
  std::ostringstream line;
  line << std::setprecision(9) << "{\"simulated_s\": " << measured.simulated << ", \"wall_s\": " << wall
       << ", \"real_time_factor\": " << measured.simulated / wall << ", \"outputs\": " << measured.outputs
       << ", \"ns_per_output\": "
       << 1e9 * wall / static_cast<double>(std::max<std::uint64_t>(1, measured.outputs))
       << ", \"switches\": " << measured.switches << ", \"rhs_evaluations\": " << measured.evaluations
       << ", \"estimated_error\": " << measured.error << "}\n";
  out << line.str();
}

void warn_of_error(const Measured& measured, const scene::Solver& solver, std::ostream& err) {
  if (measured.error <= solver.accuracy) return;
  err << "simulate: warning: the estimated error " << measured.error << " exceeds the requested accuracy "
      << solver.accuracy << ": "
      << (solver.has_fixed_step()                     ? "the fixed step"
          : measured.integrated > solver.accuracy / 2 ? "the method"
                                                      : "binary64")
      << " cannot do better over this time\n";
}

void write_summary(const Measured& measured, std::ostream& err) {
  err << "simulate: " << measured.outputs << (measured.outputs == 1 ? " output" : " outputs")
      << " up to t = " << measured.simulated << " s, " << measured.switches
      << (measured.switches == 1 ? " switch\n" : " switches\n");
}

void report_livelock(const Switch& event, std::ostream& err) {
  err << "simulate: livelock at t = " << event.time << " s, x = " << event.position.x()
      << " m, y = " << event.position.y() << " m: \"" << event.from_region << "\" and \"" << event.to_region
      << "\" throw the sphere at each other; it slides along the edge between them\n";
}

/// Of the outputs the states alone have an orientation.
bool writes_states(const Options& options) {
  return !options.states.empty() || !options.bag.empty() || !options.html.empty();
}

class Runner {
 public:
  /// @param bag  used where the options want a bag
  Runner(const Options& options, const scene::Scene& scene, const BagFormat* bag, std::ostream& out,
         std::ostream& err)
      : times_(options.times ? OutputTimes(*options.times) : OutputTimes(*options.duration, *options.rate)),
        err_(err),
        quiet_(options.quiet),
        progress_(err, options.quiet || &err != &std::cerr || isatty(STDERR_FILENO) == 0),
        estimate_(scene),
        simulation_(scene) {
    states_.reserve(block);
    simulation_.set_interrupt([this] { return interrupt_.seen(); });
    if (!writes_states(options)) simulation_.follow_orientation(false);
    if (!options.states.empty()) sinks_.push_back(std::make_unique<StatesSink>(options.states, out));
    if (!options.switches.empty()) sinks_.push_back(std::make_unique<SwitchesSink>(options.switches, out));
    if (!options.bag.empty()) sinks_.push_back(bag->open(options.bag, scene));
    if (!options.html.empty()) {
      const std::string title = std::filesystem::path(options.scene).filename().string();
      sinks_.push_back(
          std::make_unique<HtmlSink>(options.html, title, scene, out, options.quiet ? nullptr : &err));
    }
    for (const auto& sink : sinks_) with_reactions_ = with_reactions_ || sink->wants_reactions();
  }

  /// Where the computation cannot go on, all up to there is written before the reason is thrown. Ended by a
  /// signal, too.
  void run() {
    do {
      std::exception_ptr halt;
      const auto begin = std::chrono::steady_clock::now();
      try {
        compute();
      } catch (const Interrupted&) {
        interrupted_ = true;
      } catch (...) {
        halt = std::current_exception();
      }
      measured_.wall += std::chrono::steady_clock::now() - begin;
      write();
      if (halt) std::rethrow_exception(halt);
      progress_.show(simulation_.time(), times_.last());
    } while (!times_.at_end() && !interrupted_);
  }

  /// The signal that has ended the run before its end; 0: none.
  int signal() const { return interrupted_ ? interrupt_.signal() : 0; }
  /// Time of the last output or switch [s].
  double last() const {
    return std::max(
        {last_, states_.empty() ? 0 : states_.back().time, switches_.empty() ? 0 : switches_.back().time});
  }

  /// Nothing is written after this.
  /// @param why  it has stopped before its end; empty if it has not
  void finish(const std::string& why) {
    std::exception_ptr failure;
    progress_.give_way();
    for (const auto& sink : sinks_) {
      try {
        if (!why.empty()) sink->ended_early(why);
        sink->finish();
      } catch (...) {
        if (!failure) failure = std::current_exception();
      }
    }
    if (failure) std::rethrow_exception(failure);
  }

  /// Of the run so far.
  const Measured& measured() const { return measured_; }
  double time() const { return simulation_.time(); }

 private:
  void compute() {
    const Simulation::SwitchSink keep = [this](const Switch& event) {
      // All switches of an instant, or none.
      if (interrupt_.seen() && event.time > last()) throw Interrupted();
      switches_.push_back(event);
      if (switches_.size() < max_switches) return;
      const auto pause = std::chrono::steady_clock::now();
      write();
      measured_.wall -= std::chrono::steady_clock::now() - pause;
    };
    for (; states_.size() < block && !times_.at_end() && !interrupt_.seen(); times_.advance()) {
      simulation_.advance_to(times_.current(), keep);
      states_.push_back(simulation_.state());
      if (with_reactions_) reactions_.push_back(simulation_.reaction());
    }
    if (times_.at_end()) {
      simulation_.advance_to(times_.last(), keep);
    } else {
      interrupted_ = interrupt_.seen();
    }
  }

  void write() {
    for (const State& state : states_) {
      measured_.fastest_spin = std::max(measured_.fastest_spin, state.twist.angular_velocity.norm());
    }
    for (const Switch& event : switches_) {
      if (event.cause != Cause::livelock || quiet_) continue;
      progress_.give_way();
      report_livelock(event, err_);
    }
    measured_.outputs += states_.size();
    measured_.switches += switches_.size();
    measured_.evaluations = simulation_.evaluations();
    measured_.simulated = simulation_.time();
    measured_.integrated = simulation_.estimated_error();
    measured_.error = estimate_(static_cast<double>(measured_.switches), measured_.simulated,
                                measured_.fastest_spin, measured_.integrated);
    hand_over();
  }

  /// Each sink gets an output once, also where another one fails.
  void hand_over() {
    std::exception_ptr failure;
    for (const auto& sink : sinks_) {
      try {
        sink->write({states_, reactions_, switches_});
      } catch (...) {
        if (!failure) failure = std::current_exception();
      }
    }
    last_ = last();
    states_.clear();
    reactions_.clear();
    switches_.clear();
    if (failure) std::rethrow_exception(failure);
  }

  Interrupt interrupt_;
  bool interrupted_ = false;
  double last_ = 0;  // of those that are written
  std::vector<std::unique_ptr<OutputSink>> sinks_;
  bool with_reactions_ = false;
  OutputTimes times_;
  std::ostream& err_;
  bool quiet_;
  Progress progress_;
  ErrorEstimate estimate_;
  Simulation simulation_;
  std::vector<State> states_;
  std::vector<Vector3d> reactions_;
  std::vector<Switch> switches_;
  Measured measured_;
};

/// What a run must not overwrite; empty when all is well.
std::string clash(const Options& options) {
  const std::pair<const char*, const std::string&> files[] = {
      {"the scene", options.scene}, {"--states", options.states}, {"--switches", options.switches},
      {"--bag", options.bag},       {"--html", options.html},
  };
  for (auto file = std::begin(files) + 1; file != std::end(files); ++file) {
    for (auto other = std::begin(files); other != file; ++other) {
      if (!same_file(file->second, other->second)) continue;
      const std::string whose = other == std::begin(files) ? "" : "that of ";
      return refusal(file->first, file->second, "a file other than " + whose + other->first);
    }
  }
  return "";
}

/// Why no bag of the run can be written; empty when all is well.
std::string no_bag(const Options& options, const BagFormat* bag) {
  if (options.bag.empty()) return "";
  if (bag == nullptr) {
    return "--bag: \"" + options.bag +
           "\" is refused: simulate was built without ROS (HYBRID_SPHERE_CORE_ONLY)";
  }
  const double last = options.times ? options.times->back() : *options.duration;
  if (last <= bag->max_time) return "";
  return text::refusal((options.times ? "--times: " : "--duration: ") + text::shortest(last) + " s",
                       "at most " + text::shortest(bag->max_time) + " s with --bag, where ROS stamps end");
}

/// Why no page of the run can be written; empty when all is well.
std::string no_page(const Options& options) {
  if (options.html.empty() || html::can_write_pages()) return "";
  return "--html: \"" + options.html + "\" is refused: simulate was built without three.js (libjs-three)";
}

bool is_on_standard_output(const Options& options) {
  return options.states == "-" || options.switches == "-" || options.html == "-";
}

/// Why a run has ended before its time; empty if it has not.
std::string why_ended(const std::exception_ptr& halt, const Runner& runner) {
  std::ostringstream why;
  try {
    if (halt) std::rethrow_exception(halt);
    if (runner.signal() != 0) {
      why << "ended by signal " << runner.signal() << " at t = " << runner.last() << " s";
    }
  } catch (const std::exception& error) {
    why << "stopped at t = " << runner.time() << " s: " << error.what();
  }
  return why.str();
}

int run_scene(const Options& options, const scene::Scene& scene, const BagFormat* bag, std::ostream& out,
              std::ostream& err) {
  double reached = 0;
  try {
    // What is written to standard output is alone there.
    std::ostream& talk = is_on_standard_output(options) ? err : out;
    if (options.explain) talk << explain(scene, writes_states(options));
    Runner runner(options, scene, bag, out, err);
    std::exception_ptr halt;
    try {
      runner.run();
    } catch (...) {
      halt = std::current_exception();
      reached = runner.time();
    }
    try {
      runner.finish(why_ended(halt, runner));
    } catch (...) {
      reached = runner.time();
      if (!halt) halt = std::current_exception();
    }
    if (options.timing) write_timing(runner.measured(), talk);
    warn_of_error(runner.measured(), scene.solver, err);
    if (halt) std::rethrow_exception(halt);
    if (!options.quiet) write_summary(runner.measured(), err);
    if (!out.flush()) throw WriteError("standard output cannot be written");
    if (runner.signal() == 0) return done;
    return ended_by("simulate", runner.signal(), runner.last(), err);
  } catch (const std::exception& error) {
    std::ostringstream stopped;
    stopped << "stopped at t = " << reached << " s: " << error.what();
    write_error("simulate", stopped.str(), err);
    return could_not_go_on;
  }
}

}  // namespace

int run(const Options& options, std::ostream& out, std::ostream& err, const BagFormat* bag) {
  for (const std::string& refusal : {clash(options), no_bag(options, bag), no_page(options)}) {
    if (refusal.empty()) continue;
    write_error("simulate", refusal, err);
    return usage;
  }
  scene::Scene scene{};
  try {
    scene = scene::read_scene_file(options.scene);
    if (options.method) scene.solver.method = *options.method;
    if (options.accuracy) scene.solver.accuracy = *options.accuracy;
    if (options.step) scene.solver.step = *options.step;
    check_method(scene);
  } catch (const scene::SceneError& error) {
    write_error("simulate", error.what(), err);
    return refused;
  } catch (const std::bad_alloc&) {
    write_error("simulate", "scene file \"" + options.scene + "\": too large for the available memory", err);
    return refused;
  }
  for (const std::string& warning : scene.warnings) write_error("simulate", "warning: " + warning, err);
  Options asked = options;
  const bool nothing =
      asked.states.empty() && asked.switches.empty() && asked.bag.empty() && asked.html.empty();
  if (nothing && !asked.explain && !asked.timing) asked.switches = "-";
  return run_scene(asked, scene, bag, out, err);
}

}  // namespace hybrid_sphere::cli
