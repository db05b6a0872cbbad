#pragma once

#include <functional>
#include <iosfwd>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/exit_code.hpp"

namespace hybrid_sphere::cli {

/// Arguments and options of a program, read by CLI11. The variables passed to the add functions must outlive
/// the call of parse(), which sets them.
class CommandLine {
 public:
  /// @param program  its name in the help and in errors
  CommandLine(const std::string& description, const std::string& program);
  ~CommandLine();
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  /// Adds a required positional argument.
  void add_argument(const std::string& name, std::string& value, const std::string& description);
  /// Adds any number of positional arguments.
  void add_arguments(const std::string& name, std::vector<std::string>& values,
                     const std::string& description);
  /// Adds an option with a value.
  /// @param type          what the help calls the value
  /// @param default_text  the default in the help; empty: none is shown
  /// @param excluded      names of earlier options that may not be given together with this one
  void add_option(const std::string& name, std::optional<std::string>& value, const std::string& type,
                  const std::string& description, const std::string& default_text = "",
                  const std::vector<std::string>& excluded = {});
  /// Adds an option that may be given several times.
  void add_repeated_option(const std::string& name, std::vector<std::string>& values, const std::string& type,
                           const std::string& description);
  void add_flag(const std::string& name, bool& value, const std::string& description);
  /// Adds a command of its own arguments; one of the commands is required. It lives as long as this.
  /// @param usage  how the refusal of a missing or unknown command lists it
  CommandLine& add_command(const std::string& name, const std::string& usage, const std::string& description);
  /// Sets the text at the end of the help.
  void set_footer(const std::string& text);

  /// Returns true if parse() has found this command.
  bool is_given() const;

  /// Parses the arguments, then calls `read`, which may throw UsageError. Writes the help to `out`, or what
  /// is wrong to `err`.
  /// @return  nothing, or the code with which the program must exit: done after the help, could_not_go_on if
  /// the
  ///          help cannot be written, usage
  std::optional<ExitCode> parse(int argc, const char* const* argv, std::ostream& out, std::ostream& err,
                                const std::function<void()>& read);

 private:
  struct Impl;
  explicit CommandLine(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace hybrid_sphere::cli
