#include "cli/command_line.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <sstream>

#include "cli/arguments.hpp"
#include "cli/table.hpp"

namespace hybrid_sphere::cli {
namespace {

/// The error of CLI11 in the words of the other refusals.
std::string reason_of(const CLI::Error& error) {
  const std::string text = error.what();
  const std::size_t colon = text.find(": ");
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) == nullptr || colon == std::string::npos)
    return text;
  const bool is_missing = text.find("missing", colon) != std::string::npos;
  return text.substr(0, colon) +
         (is_missing ? ": a value is required" : " is given more than once; allowed: once");
}

ExitCode exit_code_of(const CLI::App& app, const CLI::Error& error, std::ostream& out, std::ostream& err) {
  std::ostringstream ignored;
  if (app.exit(error, out, ignored) != 0) {
    write_error(app.get_name(), reason_of(error), err);
    err << "Run with --help for more information.\n";
    return usage;
  }
  if (out.flush()) return done;
  write_error(app.get_name(), "standard output cannot be written", err);
  return could_not_go_on;
}

}  // namespace

struct CommandLine::Impl {
  std::unique_ptr<CLI::App> owned;  // none of a command
  CLI::App* app = nullptr;
  std::vector<std::pair<std::string, CLI::Option*>>
      options;         // with a value. CLI11's own search aborts without memory
  std::string usages;  // of the commands
  std::vector<std::unique_ptr<CommandLine>> commands;

  /// Returns the refusal of a missing or unknown command.
  std::string refused_command() const {
    const std::vector<std::string> others = app->remaining();
    const bool is_command = !others.empty() && others.front().compare(0, 1, "-") != 0;
    return is_command ? refusal("command", others.front(), usages)
                      : "a command is required; allowed: " + usages;
  }
};

CommandLine::CommandLine(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

CommandLine::CommandLine(const std::string& description, const std::string& program)
    : impl_(std::make_unique<Impl>()) {
  impl_->owned = std::make_unique<CLI::App>(description, program);
  impl_->app = impl_->owned.get();
}

CommandLine::~CommandLine() = default;

void CommandLine::add_argument(const std::string& name, std::string& value, const std::string& description) {
  impl_->app->add_option(name, value, description)->required()->type_name("");
}

void CommandLine::add_arguments(const std::string& name, std::vector<std::string>& values,
                                const std::string& description) {
  impl_->app->add_option(name, values, description)->type_name("");
}

void CommandLine::add_option(const std::string& name, std::optional<std::string>& value,
                             const std::string& type, const std::string& description,
                             const std::string& default_text, const std::vector<std::string>& excluded) {
  CLI::Option* option = impl_->app->add_option(name, value, description)->type_name(type);
  if (!default_text.empty()) option->default_str(default_text);
  for (const auto& [other_name, other] : impl_->options) {
    if (std::find(excluded.begin(), excluded.end(), other_name) != excluded.end()) option->excludes(other);
  }
  impl_->options.emplace_back(name, option);
}

void CommandLine::add_repeated_option(const std::string& name, std::vector<std::string>& values,
                                      const std::string& type, const std::string& description) {
  impl_->app->add_option(name, values, description)->type_name(type)->allow_extra_args(false);
}

void CommandLine::add_flag(const std::string& name, bool& value, const std::string& description) {
  impl_->app->add_flag(name, value, description);
}

CommandLine& CommandLine::add_command(const std::string& name, const std::string& usage,
                                      const std::string& description) {
  impl_->app->require_subcommand(1);
  impl_->usages += (impl_->usages.empty() ? "" : ", ") + usage;
  auto command = std::make_unique<Impl>();
  command->app = impl_->app->add_subcommand(name, description);
  impl_->commands.push_back(std::unique_ptr<CommandLine>(new CommandLine(std::move(command))));
  return *impl_->commands.back();
}

void CommandLine::set_footer(const std::string& text) { impl_->app->footer(text); }

bool CommandLine::is_given() const { return impl_->app->parsed(); }

std::optional<ExitCode> CommandLine::parse(int argc, const char* const* argv, std::ostream& out,
                                           std::ostream& err, const std::function<void()>& read) {
  CLI::App& app = *impl_->app;
  try {
    app.parse(argc, argv);
    read();
    return std::nullopt;
  } catch (const UsageError& error) {
    return exit_code_of(app, CLI::ValidationError(error.what()), out, err);
  } catch (const CLI::RequiredError& error) {
    const bool has_command = impl_->commands.empty() || !app.get_subcommands().empty();
    if (has_command) return exit_code_of(app, error, out, err);
    return exit_code_of(app, CLI::ValidationError(impl_->refused_command()), out, err);
  } catch (const CLI::ParseError& error) {
    return exit_code_of(app, error, out, err);
  }
}

}  // namespace hybrid_sphere::cli
