// `three_stage` from its command line to its tables.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <regex>
#include <set>

#include "catalogue/catalogue.hpp"
#include "support/temporary_file.hpp"
#include "support/three_stage_line.hpp"

namespace hybrid_sphere::testing::three_stage_test {
namespace {

using mechanics::Solution;
using mechanics::Vector;
using mechanics::catalogue::entries;
using mechanics::catalogue::Entry;
using mechanics::catalogue::entry;
using mechanics::catalogue::Example;
using mechanics::catalogue::Values;

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

Example example_of(const Entry& entry) { return entry.build(Values(entry.parameters)); }

std::vector<std::string> lines_of(const std::string& text) { return split(text, '\n'); }

/// A table by the names of its columns.
class Csv {
 public:
  explicit Csv(const std::string& text) : lines_(lines_of(text)) {
    if (!lines_.empty()) columns_ = split(lines_[0], ',');
  }
  std::size_t rows() const { return lines_.size() - 1; }
  const std::vector<std::string>& columns() const { return columns_; }
  std::string text(std::size_t row, const std::string& column) const {
    const auto found = std::find(columns_.begin(), columns_.end(), column);
    if (found == columns_.end()) return "no column " + column;
    return split(lines_[row + 1], ',')[static_cast<std::size_t>(found - columns_.begin())];
  }
  double number(std::size_t row, const std::string& column) const {
    return std::strtod(text(row, column).c_str(), nullptr);
  }

 private:
  std::vector<std::string> lines_;
  std::vector<std::string> columns_;
};

/// Names of the multipliers' columns.
std::vector<std::string> multipliers(const mechanics::Model& model, const std::string& prefix) {
  std::vector<std::string> names;
  for (const mechanics::Constraint& constraint : model.constraints) {
    const auto size = constraint.function->size();
    for (mechanics::Index i = 1; i <= size; ++i) {
      names.push_back(prefix + constraint.name + (size > 1 ? "_" + std::to_string(i) : ""));
    }
  }
  return names;
}

void expect_numbers(const Csv& table, std::size_t row, const std::vector<std::string>& columns,
                    const Vector& numbers) {
  ASSERT_EQ(static_cast<mechanics::Index>(columns.size()), numbers.size());
  for (std::size_t i = 0; i < columns.size(); ++i) {
    EXPECT_EQ(table.number(row, columns[i]), numbers[static_cast<mechanics::Index>(i)])
        << columns[i] << " in row " << row << ": " << table.text(row, columns[i]);
  }
}

std::vector<std::string> named(const std::string& before, const std::vector<std::string>& names,
                               const std::string& after = "") {
  std::vector<std::string> all;
  for (const std::string& name : names) all.push_back(before + name + after);
  return all;
}

class ThreeStageRun : public ::testing::TestWithParam<std::string> {};

TEST_P(ThreeStageRun, WithStatesThatAreTheSolutions) {
  const Entry& system = entry(GetParam());
  const Example example = example_of(system);
  const Solution solution = mechanics::solve(example.model, example.initial, system.duration);
  const CommandResult result = three_stage({"run", GetParam(), "--states", "-", "--quiet"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.err, "");
  const Csv table(result.out);
  ASSERT_EQ(table.rows(), 101U);
  const std::set<std::string> names(table.columns().begin(), table.columns().end());
  EXPECT_EQ(names.size(), table.columns().size()) << "two columns have one name";
  for (const std::size_t row : {0U, 33U, 77U, 100U}) {
    const mechanics::State state = solution.at(system.duration * (static_cast<double>(row) / 100));
    EXPECT_EQ(table.number(row, "t"), state.time);
    EXPECT_EQ(table.number(row, "stage"), state.stage);
    expect_numbers(table, row, example.model.coordinates, state.q);
    expect_numbers(table, row, example.model.velocities, state.v);
    expect_numbers(table, row, multipliers(example.model, "lambda_"), state.multipliers);
    EXPECT_EQ(table.number(row, "energy"), state.energy);
    EXPECT_EQ(table.number(row, "kinetic_energy"), state.kinetic_energy);
    EXPECT_EQ(table.number(row, "residual"), state.residual);
  }
}

TEST_P(ThreeStageRun, WithSwitchesThatAreTheSolutions) {
  const Entry& system = entry(GetParam());
  const Example example = example_of(system);
  const Solution solution = mechanics::solve(example.model, example.initial, system.duration);
  const CommandResult result = three_stage({"run", GetParam(), "--quiet"});
  const Csv table(result.out);
  ASSERT_EQ(table.rows(), solution.switches().size());
  const std::set<std::string> names(table.columns().begin(), table.columns().end());
  EXPECT_EQ(names.size(), table.columns().size()) << "two columns have one name";
  const mechanics::Model& model = example.model;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const mechanics::Switch& event = solution.switches()[row];
    EXPECT_EQ(table.number(row, "index"), static_cast<double>(row));
    EXPECT_EQ(table.number(row, "t"), event.time);
    const std::string applied = table.text(row, "applied");
    EXPECT_EQ(applied.empty(), event.applied.empty());
    for (const std::size_t i : event.applied) {
      EXPECT_TRUE(contains(applied, model.constraints[i].name)) << applied;
    }
    for (const std::size_t i : event.released)
      EXPECT_EQ(table.text(row, "released"), model.constraints[i].name);
    expect_numbers(table, row, model.coordinates, event.q);
    expect_numbers(table, row, named("", model.velocities, "_before"), event.v_before);
    expect_numbers(table, row, named("", model.velocities, "_after"), event.v_after);
    expect_numbers(table, row, multipliers(model, "Lambda_"), event.multipliers);
    expect_numbers(table, row, named("P_", model.velocities), event.impulse);
    EXPECT_EQ(table.number(row, "rank"), static_cast<double>(event.rank));
    EXPECT_EQ(table.number(row, "energy_before"), event.energy_before);
    EXPECT_EQ(table.number(row, "energy_after"), event.energy_after);
    EXPECT_EQ(table.number(row, "kinetic_energy_before"), event.kinetic_energy_before);
    EXPECT_EQ(table.number(row, "kinetic_energy_after"), event.kinetic_energy_after);
  }
}

TEST_P(ThreeStageRun, WithASummaryThatComparesWithWhatIsKnown) {
  const Example example = example_of(entry(GetParam()));
  const CommandResult result = three_stage({"run", GetParam(), "--accuracy", "1e-8"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.err.rfind("three_stage: " + GetParam() + ": reached_end at t = ", 0), 0U) << result.err;
  for (const auto& invariant : example.invariants) {
    EXPECT_TRUE(contains(result.err, "  " + invariant.name + " has drifted by at most ")) << result.err;
  }
  for (const mechanics::Constraint& constraint : example.model.constraints) {
    EXPECT_TRUE(contains(result.err, "  " + constraint.name + ": applied ")) << result.err;
  }
  const std::regex deviation("deviation from the known solution.*: q (\\S+), v (\\S+)");
  std::smatch found;
  if (std::regex_search(result.err, found, deviation)) {
    EXPECT_LE(std::strtod(found[1].str().c_str(), nullptr), 1e-8) << result.err;
    EXPECT_LE(std::strtod(found[2].str().c_str(), nullptr), 1e-8) << result.err;
  } else {
    EXPECT_TRUE(contains(result.err, "no known solution to compare with")) << result.err;
    EXPECT_FALSE(example.known);
  }
}

TEST_P(ThreeStageRun, AndExplainsWhatItRuns) {
  const Entry& system = entry(GetParam());
  const CommandResult result = three_stage({"explain", GetParam()});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.err, "");
  EXPECT_TRUE(contains(result.out, system.title));
  EXPECT_TRUE(contains(result.out, system.description));
  for (const auto& parameter : system.parameters) {
    EXPECT_TRUE(contains(result.out, "\n  " + parameter.name + " ")) << parameter.name;
    EXPECT_TRUE(contains(result.out, parameter.meaning)) << parameter.name;
  }
  const CommandResult states = three_stage({"run", GetParam(), "--times", "0", "--states", "-", "--quiet"});
  EXPECT_TRUE(contains(result.out, "Columns of --states: " + lines_of(states.out)[0] + "\n"));
  const CommandResult switches = three_stage({"run", GetParam(), "--times", "0", "--quiet"});
  EXPECT_TRUE(contains(result.out, "Columns of --switches: " + lines_of(switches.out)[0] + "\n"));
}

std::vector<std::string> names_of_entries() {
  std::vector<std::string> names;
  for (const Entry& system : entries()) names.push_back(system.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(EverySystem, ThreeStageRun, ::testing::ValuesIn(names_of_entries()),
                         [](const auto& info) { return info.param; });

TEST(ThreeStage, ListsEverySystemOnALine) {
  const CommandResult result = three_stage({"list"});
  EXPECT_EQ(result.exit_code, 0);
  const std::vector<std::string> lines = lines_of(result.out);
  ASSERT_EQ(lines.size(), entries().size());
  for (std::size_t i = 0; i < lines.size(); ++i) {
    EXPECT_EQ(lines[i].rfind(entries()[i].name + " ", 0), 0U) << lines[i];
    EXPECT_TRUE(contains(lines[i], entries()[i].title)) << lines[i];
  }
}

TEST(ThreeStage, SetsParameters) {
  Values values(entry("chaplygin_sleigh").parameters);
  values.set("m", 3.5);
  values.set("x_dot", -0.25);
  values.set("t_switch", 0.75);
  const Example example = entry("chaplygin_sleigh").build(values);
  const Solution solution = mechanics::solve(example.model, example.initial, 1);
  const CommandResult result =
      three_stage({"run", "chaplygin_sleigh", "--set", "m=3.5", "--set", "x_dot=-0.25", "--set",
                   "t_switch=0.75", "--duration", "1", "--quiet"});
  const Csv table(result.out);
  ASSERT_EQ(table.rows(), 1U);
  EXPECT_EQ(table.number(0, "t"), 0.75);
  expect_numbers(table, 0, named("", example.model.velocities, "_after"), solution.switches()[0].v_after);
}

TEST(ThreeStage, TakesDerivativesByHandWhenAskedTo) {
  const Example example = example_of(entry("rolling_disk"));
  mechanics::Options options;
  options.accuracy = 1e-5;
  const Solution solution = mechanics::solve(example.by_hand, example.initial, 3, options);
  const CommandResult result = three_stage({"run", "rolling_disk", "--derivatives", "by_hand", "--accuracy",
                                            "1e-5", "--times", "1,3", "--states", "-", "--quiet"});
  const Csv table(result.out);
  ASSERT_EQ(table.rows(), 2U);
  expect_numbers(table, 1, example.model.coordinates, solution.at(3).q);
}

TEST(ThreeStage, GivesOutputsAtARate) {
  const CommandResult result =
      three_stage({"run", "rolling_disk", "--duration", "0.5", "--rate", "10", "--states", "-", "--quiet"});
  const Csv table(result.out);
  ASSERT_EQ(table.rows(), 6U);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(table.number(i, "t"), static_cast<double>(i) / 10);
}

TEST(ThreeStage, HasOneOutputOfAMotionWithoutDuration) {
  const CommandResult result =
      three_stage({"run", "rolling_disk", "--duration", "0", "--states", "-", "--quiet"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(Csv(result.out).rows(), 1U);
}

TEST(ThreeStage, HasTheStateAfterTheSwitchAtItsInstant) {
  const CommandResult result =
      three_stage({"run", "chaplygin_sleigh", "--times", "0.4999,0.5", "--states", "-", "--quiet"});
  const Csv table(result.out);
  EXPECT_EQ(table.text(0, "stage"), "1");
  EXPECT_EQ(table.text(1, "stage"), "3");
  EXPECT_EQ(table.number(0, "lambda_blade"), 0);
  EXPECT_NE(table.number(1, "lambda_blade"), 0);
}

TEST(ThreeStage, WritesBothTablesToFiles) {
  const TemporaryFile states("three_states.csv");
  const TemporaryFile switches("three_switches.csv");
  const CommandResult result = three_stage(
      {"run", "appell_hamel", "--states", states.path(), "--switches", switches.path(), "--quiet"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(states.text(), three_stage({"run", "appell_hamel", "--states", "-", "--quiet"}).out);
  EXPECT_EQ(switches.text(), three_stage({"run", "appell_hamel", "--quiet"}).out);
}

TEST(ThreeStage, ProjectsInitialVelocitiesOnlyWhenAskedTo) {
  const std::vector<std::string> arguments = {"run",   "visiting_particle", "--set",    "y=0.25",
                                              "--set", "z_dot=2",           "--states", "-"};
  const CommandResult result = three_stage(arguments);
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(result.out, "");
  EXPECT_TRUE(contains(result.err, "violate the constraint slope")) << result.err;
  EXPECT_TRUE(contains(result.err, "residual")) << result.err;
  std::vector<std::string> projecting = arguments;
  projecting.emplace_back("--project");
  const CommandResult projected = three_stage(projecting);
  EXPECT_EQ(projected.exit_code, 0);
  EXPECT_NE(Csv(projected.out).number(0, "z_dot"), 2);
}

TEST(ThreeStage, SaysWhenAGuardNeverOrAlwaysHolds) {
  const CommandResult never =
      three_stage({"run", "visiting_particle", "--set", "y_dot=0", "--set", "y=-0.1"});
  EXPECT_TRUE(contains(never.err, "applied 0 times, held 0 of 6 s; its guard was never positive"))
      << never.err;
  const CommandResult always =
      three_stage({"run", "visiting_particle", "--set", "y_dot=0", "--set", "y=0.25", "--set", "z_dot=0.25"});
  EXPECT_TRUE(contains(always.err, "held 6 of 6 s; its guard was positive throughout")) << always.err;
}

TEST(ThreeStage, SaysThatAConstraintWasToHoldLater) {
  const CommandResult result = three_stage({"run", "chaplygin_sleigh", "--set", "t_switch=100"});
  EXPECT_TRUE(contains(result.err, "held 0 of 4 s; scheduled to hold from t = 100 s")) << result.err;
  EXPECT_FALSE(contains(result.err, "drifted")) << "what stage 3 keeps, stage 1 need not: " << result.err;
}

TEST(ThreeStage, WarnsNearASingularityOfTheCoordinates) {
  const std::vector<std::string> arguments = {"run",        "paper_sphere", "--set",
                                              "theta=0.01", "--duration",   "0.01"};
  const CommandResult result = three_stage(arguments);
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_TRUE(contains(result.err, "warning: M is nearly singular at t = 0")) << result.err;
  EXPECT_FALSE(contains(three_stage({"run", "paper_sphere"}).err, "warning"));
}

// At rest a prescribed speed has no direction.
TEST(ThreeStage, ExitsWith4WhereTheMotionStopsAndWritesAllUpToThere) {
  const TemporaryFile states("stopped.csv");
  const CommandResult result = three_stage({"run", "constant_speed", "--set", "x_dot=0", "--set", "y_dot=2.5",
                                            "--rate", "10", "--states", states.path(), "--quiet"});
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_EQ(result.err.rfind("three_stage: stopped at t = 0.5 s: no_", 0), 0U) << result.err;
  EXPECT_TRUE(contains(result.err, "speed")) << result.err;
  EXPECT_EQ(Csv(states.text()).rows(), 6U);
}

TEST(ThreeStage, ExitsWith4WhenATableCannotBeWritten) {
  for (const char* option : {"--states", "--switches"}) {
    CommandResult result = three_stage({"run", "rolling_disk", option, "/no/such/folder/table.csv"});
    EXPECT_EQ(result.exit_code, 4) << option;
    EXPECT_TRUE(
        contains(result.err, "\"/no/such/folder/table.csv\" cannot be written: No such file or directory"))
        << result.err;
    result = three_stage({"run", "rolling_disk", option, "/dev/full"});
    EXPECT_EQ(result.exit_code, 4) << option;
    EXPECT_TRUE(contains(result.err, "\"/dev/full\" cannot be written: No space left on device"))
        << result.err;
  }
}

TEST(ThreeStage, ExitsWith4WhenStandardOutputFails) {
  for (const auto command : {cli::three_stage::Command::list, cli::three_stage::Command::explain,
                             cli::three_stage::Command::run}) {
    std::ostringstream out;
    std::ostringstream err;
    out.setstate(std::ios::badbit);
    cli::three_stage::Options options;
    options.command = command;
    options.name = "rolling_disk";
    EXPECT_EQ(cli::three_stage::run(options, out, err), 4);
    EXPECT_TRUE(contains(err.str(), "standard output cannot be written")) << err.str();
  }
}

TEST(ThreeStage, HasAPageWithEverySystemAndOption) {
  std::ostringstream page;
  page << std::ifstream(std::string(TEST_DATA_DIR) + "/../../docs/three_stage.md").rdbuf();
  for (const Entry& system : entries()) {
    EXPECT_TRUE(contains(page.str(), "| `" + system.name + "` |")) << system.name;
  }
  const std::string help = three_stage({"run", "--help"}).out;
  const std::regex option("--[a-z]+(-[a-z]+)*");
  for (std::sregex_iterator found(help.begin(), help.end(), option), end; found != end; ++found) {
    if (found->str() == "--help") continue;
    EXPECT_TRUE(contains(page.str(), "| `" + found->str())) << found->str();
  }
}

TEST(ThreeStage, PrintsItsHelp) {
  const CommandResult result = three_stage({"--help"});
  EXPECT_EQ(result.exit_code, 0);
  for (const char* command : {"list", "explain", "run"})
    EXPECT_TRUE(contains(result.out, command)) << command;
  const CommandResult run = three_stage({"run", "--help"});
  EXPECT_EQ(run.exit_code, 0);
  for (const char* option :
       {"NAME", "--set", "--duration", "--rate", "--times", "--states", "--switches", "--accuracy",
        "--most-steps", "--longest-step", "--project", "--derivatives", "--quiet"}) {
    EXPECT_TRUE(contains(run.out, option)) << option;
  }
}

}  // namespace
}  // namespace hybrid_sphere::testing::three_stage_test
