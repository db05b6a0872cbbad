// How `three_stage run` is made to end early, and what is left then.

#include <gtest/gtest.h>
#include <signal.h>

#include <cstdlib>
#include <regex>

#include "cli/interrupt.hpp"
#include "support/temporary_file.hpp"
#include "support/three_stage_line.hpp"

namespace hybrid_sphere::testing::three_stage_stop_test {
namespace {

using cli::Interrupt;

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::size_t lines_of(const std::string& text) { return split(text, '\n').size(); }

cli::three_stage::Options options_of(const std::vector<std::string>& arguments) {
  std::vector<const char*> argv{"three_stage", "run", "chaplygin_sleigh"};
  for (const std::string& argument : arguments) argv.push_back(argument.c_str());
  std::ostringstream nowhere;
  return cli::three_stage::parse_options(static_cast<int>(argv.size()), argv.data(), nowhere, nowhere)
      .options.value();
}

/// Steps in the summary.
double steps_of(const CommandResult& result) {
  std::smatch found;
  return std::regex_search(result.err, found, std::regex(", (\\d+) steps?,"))
             ? std::strtod(found[1].str().c_str(), nullptr)
             : -1;
}

/// The handler of SIGINT.
auto handler() {
  struct sigaction action {};
  sigaction(SIGINT, nullptr, &action);
  return action.sa_handler;
}

TEST(ThreeStageSteps, AreAsManyAndAsLongAsTheEngineAllowsUnlessAskedOtherwise) {
  EXPECT_EQ(options_of({}).max_steps, mechanics::Options{}.max_steps);
  EXPECT_EQ(options_of({}).max_step, mechanics::Options{}.max_step);
  const auto options = options_of({"--most-steps", "1e3", "--longest-step", "0.5"});
  EXPECT_EQ(options.max_steps, 1000U);
  EXPECT_EQ(options.max_step, 0.5);
}

TEST(ThreeStageSteps, AreNoLongerThanAskedFor) {
  const CommandResult result =
      three_stage({"run", "chaplygin_sleigh", "--duration", "4", "--longest-step", "0.01"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_GE(steps_of(result), 400) << result.err;
  EXPECT_LT(steps_of(three_stage({"run", "chaplygin_sleigh", "--duration", "4"})), 100) << "as a rule";
}

const std::vector<std::string> small_steps = {"run",    "chaplygin_sleigh", "--longest-step",
                                              "0.0625", "--states",         "-"};

TEST(ThreeStageSteps, EndTheMotionWhenTheyAreTooManyAndAllUpToThereIsWritten) {
  const CommandResult whole = three_stage(small_steps);
  std::vector<std::string> arguments = small_steps;
  arguments.insert(arguments.end(), {"--most-steps", "20"});
  const CommandResult cut = three_stage(arguments);
  EXPECT_EQ(whole.exit_code, 0);
  EXPECT_EQ(cut.exit_code, 4);
  EXPECT_TRUE(contains(cut.err, "three_stage: stopped at t = ")) << cut.err;
  EXPECT_TRUE(contains(cut.err, "too_many_steps: more than 20 steps")) << cut.err;
  EXPECT_EQ(steps_of(cut), 20) << cut.err;
  EXPECT_GT(lines_of(cut.out), 14U) << "the motion has left stage 1";
  EXPECT_LT(lines_of(cut.out), lines_of(whole.out));
  EXPECT_EQ(whole.out.rfind(cut.out, 0), 0U) << "rows up to there are those of the whole motion";
}

/// Runs with small steps, and calls `at_the_twentieth` after as many of them.
template <class Function>
CommandResult run_until(Function at_the_twentieth) {
  const TemporaryFile switches("cancelled.csv");
  cli::three_stage::Options options = options_of({"--longest-step", "0.0625"});
  options.states = "-";
  options.switches = switches.path();
  std::ostringstream out;
  std::ostringstream err;
  int asked = 0;
  const int exit_code = cli::three_stage::run(
      options, out, err, [&] { return ++asked >= 20 && (asked > 20 || at_the_twentieth()); });
  EXPECT_EQ(asked, 20);
  EXPECT_EQ(lines_of(switches.text()), 2U) << "the blade was put down before";
  return {exit_code, out.str(), err.str()};
}

void expect_cancelled(const CommandResult& result, int exit_code, const char* reason) {
  EXPECT_EQ(result.exit_code, exit_code);
  EXPECT_TRUE(contains(result.err, "three_stage: chaplygin_sleigh: cancelled at t = ")) << result.err;
  EXPECT_TRUE(contains(result.err, reason)) << result.err;
  EXPECT_EQ(steps_of(result), 20) << result.err;
  const std::string whole = three_stage(small_steps).out;
  EXPECT_GT(lines_of(result.out), 14U);
  EXPECT_LT(lines_of(result.out), lines_of(whole));
  EXPECT_EQ(whole.rfind(result.out, 0), 0U) << "rows up to there are those of the whole motion";
}

TEST(ThreeStageInterrupt, WritesWhatItHasComputed) {
  expect_cancelled(run_until([] { return true; }), 4, "three_stage: stopped at t = ");
}

TEST(ThreeStageInterrupt, ByCtrlCWritesWhatItHasComputed) {
  const auto before = handler();
  const CommandResult result = run_until([] {
    raise(SIGINT);
    return false;
  });
  expect_cancelled(result, 128 + SIGINT, "three_stage: ended by signal 2 (Interrupt) at t = ");
  EXPECT_EQ(handler(), before);
}

TEST(Interrupt, IsSeenOnceItHasCome) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const Interrupt interrupt;
    EXPECT_FALSE(interrupt.seen());
    EXPECT_EQ(interrupt.signal(), 0);
    raise(signal);
    EXPECT_TRUE(interrupt.seen());
    EXPECT_EQ(interrupt.signal(), signal);
  }
  const Interrupt next;
  EXPECT_FALSE(next.seen());
}

TEST(Interrupt, IsSeenAgainWhereOneOfTheOtherKindComes) {
  const Interrupt interrupt;
  raise(SIGINT);
  EXPECT_FALSE(interrupt.seen_again());
  raise(SIGTERM);
  EXPECT_TRUE(interrupt.seen_again());
  EXPECT_EQ(interrupt.signal(), SIGINT);
}

TEST(Interrupt, EndsTheProcessTheSecondTime) {
  EXPECT_EXIT(
      {
        const Interrupt interrupt;
        raise(SIGINT);
        raise(SIGINT);
      },
      ::testing::KilledBySignal(SIGINT), "");
}

TEST(Interrupt, EndsTheProcessAfterItsTime) {
  EXPECT_EXIT(
      {
        { const Interrupt interrupt; }
        raise(SIGINT);
      },
      ::testing::KilledBySignal(SIGINT), "");
}

TEST(Interrupt, StaysIgnoredWhereItIs) {
  const auto before = signal(SIGINT, SIG_IGN);
  {
    const Interrupt interrupt;
    raise(SIGINT);
    EXPECT_FALSE(interrupt.seen());
  }
  EXPECT_EQ(handler(), SIG_IGN);
  signal(SIGINT, before);
}

TEST(ThreeStageSummary, SaysThatNothingIsKnown) {
  EXPECT_TRUE(contains(three_stage({"run", "chaplygin_ball"}).err, "  no known solution to compare with\n"));
  EXPECT_TRUE(contains(three_stage({"explain", "chaplygin_ball"}).out, "K3; no known solution.\n"));
}

TEST(ThreeStageSummary, SaysThatNoOutputIsCoveredByWhatIsKnown) {
  const CommandResult result =
      three_stage({"run", "visiting_particle", "--set", "y_dot=0", "--set", "y=-0.1"});
  EXPECT_TRUE(contains(result.err, "  the known solution covers 0 of 101 outputs\n")) << result.err;
}

// y = -0.4 + 0.0075 i at each output, a multiple of period/2.
TEST(ThreeStageSummary, SaysThatEveryOutputIsTooNearToASwitch) {
  for (const char* accuracy : {"1e-6", "1e-10"}) {
    const CommandResult result = three_stage(
        {"run", "visiting_particle", "--set", "period=5e-3", "--duration", "1", "--accuracy", accuracy});
    EXPECT_TRUE(contains(result.err, "  the known solution covers 101 of 101 outputs; compared at none: "))
        << accuracy << ": " << result.err;
  }
}

}  // namespace
}  // namespace hybrid_sphere::testing::three_stage_stop_test
