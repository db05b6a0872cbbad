#include "cli/study_options.hpp"

#include <cmath>
#include <filesystem>
#include <ostream>

#include "cli/arguments.hpp"
#include "cli/table.hpp"

namespace hybrid_sphere::cli::studies {
namespace {

struct Texts {
  std::optional<std::string> output;
  std::optional<std::string> resume;
  std::optional<std::string> processes;
  std::optional<std::string> scene;
  std::optional<std::string> csv;
};

void declare(CommandLine& app, Options& options, Texts& texts) {
  app.add_argument("STUDY", options.study, "study file (YAML)");
  app.add_option("-o", texts.output, "F.h5",
                 "file of the results; without it the name of the study with .h5");
  app.add_option("--resume", texts.resume, "F.h5", "go on with the file of a study that was ended");
  app.add_option("--processes", texts.processes, "N",
                 "without mpirun: how many; without it one for each core");
  app.add_option("--scene", texts.scene, "I", "write run I as a scene to standard output; computes nothing");
  app.add_option("--csv", texts.csv, "DIR", "write tables into this directory, too");
  app.add_flag("--timing", options.timing, "print one JSON line: what was computed and how long it took");
  app.add_flag("--quiet", options.quiet, "no progress bar, no report");
  app.set_footer(
      "mpirun -n N study ... computes on N processes, of one machine or many.\n"
      "Exit code: 0 done, 2 usage, 3 study or scene refused, 4 the computation could not go on,\n"
      "           128 + N ended by signal N; --resume goes on from what is finished.");
}

std::uint64_t whole_number(const std::string& option, const std::string& text, double low, double high) {
  const double number = number_from(option, text, low, high);
  if (number != std::floor(number)) throw UsageError(refusal(option, text, "a whole number"));
  return static_cast<std::uint64_t>(number);
}

std::string file_from(const std::string& option, const std::string& file, const char* allowed) {
  if (file.empty()) throw UsageError(refusal(option, file, allowed));
  return file;
}

void read_texts(const Texts& texts, Options& options) {
  if (texts.output && texts.resume) {
    throw UsageError(refusal("-o", *texts.output, "one of -o and --resume, which names the file itself"));
  }
  options.output = std::filesystem::path(options.study).stem().string() + ".h5";
  if (texts.output) options.output = file_from("-o", *texts.output, "a file");
  if (texts.resume) options.output = file_from("--resume", *texts.resume, "a file");
  options.resume = texts.resume.has_value();
  constexpr double most_processes = 4096;
  if (texts.processes) {
    options.processes = static_cast<int>(whole_number("--processes", *texts.processes, 1, most_processes));
  }
  constexpr double last_run = 1e12;
  if (texts.scene) options.scene = whole_number("--scene", *texts.scene, 0, last_run);
  if (texts.csv) options.csv = file_from("--csv", *texts.csv, "a directory");
}

}  // namespace

Parsed parse_options(int argc, const char* const* argv, std::ostream& out, std::ostream& err) {
  CommandLine app("Many runs of a scene whose numbers are uncertain, on one core or a cluster.", "study");
  Options options;
  Texts texts;
  declare(app, options, texts);
  const std::optional<ExitCode> exit_code =
      app.parse(argc, argv, out, err, [&] { read_texts(texts, options); });
  if (exit_code) return {std::nullopt, *exit_code};
  return {options, done};
}

}  // namespace hybrid_sphere::cli::studies
