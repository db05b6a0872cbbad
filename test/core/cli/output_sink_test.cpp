// What `simulate` hands to an output that is not a table, such as a bag.

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <functional>
#include <sstream>
#include <thread>

#include "cli/run.hpp"
#include "cli/table.hpp"
#include "support/command_line.hpp"
#include "support/patience.hpp"
#include "support/temporary_file.hpp"

namespace hybrid_sphere::testing::output_sink_test {
namespace {

/// A job in the background of a shell is begun with SIGINT ignored, and the program leaves it so.
class SignalsAreHeard : public ::testing::Environment {
  void SetUp() override { signal(SIGINT, SIG_DFL); }
};
[[maybe_unused]] const auto* const signals_are_heard =
    ::testing::AddGlobalTestEnvironment(new SignalsAreHeard);

// Thrown back at t = 1; 2 switches.
const std::string scene_path = std::string(TEST_DATA_DIR) + "/oracle/o05_bounce_back.yaml";

/// What came to the sink of a run.
struct Received {
  std::vector<double> times;
  std::vector<Vector3d> reactions;
  std::size_t switches = 0;
  int finished = 0;
};

class Recorder : public cli::OutputSink {
 public:
  Recorder(Received& received, const std::function<void()>& at_write)
      : received_(received), at_write_(at_write) {}
  bool wants_reactions() const override { return true; }
  void write(const cli::OutputBlock& block) override {
    at_write_();
    for (const State& state : block.states) received_.times.push_back(state.time);
    received_.reactions.insert(received_.reactions.end(), block.reactions.begin(), block.reactions.end());
    received_.switches += block.switches.size();
  }
  void finish() override { ++received_.finished; }

 private:
  Received& received_;
  std::function<void()> at_write_;
};

/// Sends a signal to the test's own process, once: a second one would end it.
std::function<void()> once(int signal) {
  return [signal, sent = false]() mutable {
    if (!sent) raise(signal);
    sent = true;
  };
}

/// Calls `simulate` with a format of bags that gives its sink to `received`, and `at_write` before each
/// block.
CommandResult simulate_into(
    Received& received, const std::vector<std::string>& arguments,
    const std::function<void()>& at_write = [] {}) {
  std::vector<const char*> argv{"simulate"};
  for (const std::string& argument : arguments) argv.push_back(argument.c_str());
  std::ostringstream out;
  std::ostringstream err;
  const cli::BagFormat format{1000, [&](const std::string&, const scene::Scene&) {
                                return std::make_unique<Recorder>(received, at_write);
                              }};
  const cli::Parsed parsed = cli::parse_options(static_cast<int>(argv.size()), argv.data(), out, err);
  const int code = parsed.options ? cli::run(*parsed.options, out, err, &format) : parsed.exit_code;
  return {code, out.str(), err.str()};
}

TEST(OutputSink, GetsEveryStateWithItsReactionAndEverySwitch) {
  Received received;
  // More outputs than a block has.
  const CommandResult result =
      simulate_into(received, {scene_path, "--bag", "b", "--duration", "2", "--rate", "5000", "--quiet"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out, "");
  ASSERT_EQ(received.times.size(), 10001U);
  for (std::size_t i = 0; i < received.times.size(); ++i) {
    ASSERT_EQ(received.times[i], static_cast<double>(i) / 5000);
  }
  EXPECT_EQ(received.reactions.size(), received.times.size());
  EXPECT_GT(received.reactions.front().z(), 0) << "the normal force";
  EXPECT_EQ(received.switches, 2U);
  EXPECT_EQ(received.finished, 1);
}

TEST(OutputSink, ThatFailsKeepsNothingFromTheTables) {
  const TemporaryFile states("states.csv");
  Received received;
  const CommandResult result = simulate_into(
      received, {scene_path, "--bag", "b", "--duration", "0.5", "--rate", "10", "--states", states.path()},
      [] { throw cli::WriteError("no space"); });
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_NE(result.err.find("no space"), std::string::npos) << result.err;
  EXPECT_EQ(split(states.text(), '\n').size(), 7U) << "a header and six rows, each once";
}

TEST(OutputSink, IsFinishedWhereTheComputationCannotGoOn) {
  const TemporaryFile scene("halts.yaml");
  scene.fill(
      "sphere: {mass: 2.0, radius: 0.25, body: solid}\n"
      "initial_state: {position: [0.0, -0.1]}\n"
      "surface:\n"
      "  base: {law: rough, belt: [0.0, 1.0]}\n"
      "  regions:\n"
      "    - {name: upper, half_plane: {point: [0, 0], normal: [0, 1]}, law: rough, belt: [0.0, -1.0]}\n"
      "  livelock: stop\n");
  Received received;
  const CommandResult result = simulate_into(received, {scene.path(), "--bag", "b", "--rate", "100"});
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_GT(received.times.size(), 0U);
  EXPECT_EQ(received.reactions.size(), received.times.size());
  EXPECT_EQ(received.finished, 1);
}

// Outputs come in blocks; the signal comes while the first one is written.
TEST(OutputSink, IsFinishedWhereASignalEndsTheRun) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const TemporaryFile states("states.csv");
    Received received;
    const CommandResult result = simulate_into(
        received,
        {scene_path, "--bag", "b", "--duration", "2", "--rate", "5000", "--states", states.path(), "--quiet"},
        once(signal));
    EXPECT_EQ(result.exit_code, 128 + signal);
    ASSERT_GT(received.times.size(), 0U);
    EXPECT_LT(received.times.size(), 10001U) << "of the whole run";
    EXPECT_EQ(received.reactions.size(), received.times.size());
    EXPECT_EQ(received.finished, 1);
    EXPECT_EQ(split(states.text(), '\n').size(), 1 + received.times.size()) << "each state, and the header";
    std::ostringstream end;
    end << "simulate: ended by signal " << signal << " (" << strsignal(signal)
        << ") at t = " << received.times.back() << " s: everything up to there is written\n";
    EXPECT_EQ(result.err, end.str());
  }
}

TEST(OutputSink, HasAllOfARunThatIsCompleteWhenTheSignalComes) {
  Received received;
  const CommandResult result =
      simulate_into(received, {scene_path, "--bag", "b", "--times", "0,2", "--quiet"}, once(SIGINT));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  EXPECT_EQ(received.times, (std::vector<double>{0, 2}));
  EXPECT_EQ(received.finished, 1);
}

// Switches between two outputs are written when 65536 have come, which is when the signal comes.
TEST(OutputSink, IsFinishedWhereASignalEndsTheRunBetweenTwoOutputs) {
  const TemporaryFile scene("strips.yaml");
  std::string text =
      "sphere: {mass: 1.0, radius: 0.1, body: solid}\n"
      "initial_state: {position: [-0.05, 0.0], velocity: [14000.0, 0.0]}\n"
      "surface:\n  regions:\n";
  constexpr int strips = 33000;
  for (int i = 0; i < strips; ++i) {
    std::ostringstream strip;
    strip << "    - {name: s" << i << ", law: rough, polygon: [[" << 0.2 * i << ", -1], [" << 0.2 * i + 0.1
          << ", -1], [" << 0.2 * i + 0.1 << ", 1], [" << 0.2 * i << ", 1]]}\n";
    text += strip.str();
  }
  scene.fill(text);
  Received received;
  const CommandResult result =
      simulate_into(received, {scene.path(), "--bag", "b", "--times", "10", "--quiet"}, once(SIGINT));
  EXPECT_EQ(result.exit_code, 128 + SIGINT) << result.err;
  EXPECT_EQ(received.switches, 65536U) << "of " << 2 * strips;
  EXPECT_EQ(received.times.size(), 0U);
  EXPECT_EQ(received.finished, 1);
}

/// While one lives, a thread waits until SIGINT has a handler, and a little longer, and sends it. Where the
/// run is over by then, none is sent.
class LateSignal {
 public:
  explicit LateSignal(std::chrono::milliseconds delay)
      : thread_([this, delay] {
          wait_until([this] {
            struct sigaction action {};
            sigaction(SIGINT, nullptr, &action);
            return action.sa_handler != SIG_DFL || is_over_;
          });
          give_way(delay);
          if (!is_over_) kill(getpid(), SIGINT);
        }) {}
  ~LateSignal() {
    is_over_ = true;
    thread_.join();
  }
  LateSignal(const LateSignal&) = delete;
  LateSignal& operator=(const LateSignal&) = delete;

 private:
  std::atomic<bool> is_over_{false};
  std::thread thread_;
};

// Rolling on a tilted turntable, its axis turns as fast as the sphere: one output would take years.
TEST(OutputSink, IsFinishedWhereASignalEndsAComputationThatTakesLong) {
  const TemporaryFile scene("spinning.yaml");
  scene.fill(
      "sphere: {mass: 1.0, radius: 0.1, body: solid}\n"
      "initial_state: {position: [0.05, 0], velocity: [1.0, 0.0]}\n"
      "surface: {base: {law: rough, turntable: {rate: 1.0e+11, center: [0, 0]}}}\n"
      "gravity: [1.0, 0.0, -9.81]\n");
  const HangGuard guard;
  Received received;
  CommandResult result{128 + SIGINT, "", ""};
  // If the signal arrives before the first output, the next signal is sent later.
  for (std::chrono::milliseconds delay(200); received.times.empty() && result.exit_code == 128 + SIGINT;
       delay *= 2) {
    received = {};
    const LateSignal signal(delay);
    result = simulate_into(received, {scene.path(), "--bag", "b", "--times", "0,0.1", "--quiet"});
  }
  EXPECT_EQ(result.exit_code, 128 + SIGINT) << result.err;
  EXPECT_EQ(received.times, std::vector<double>{0});
  EXPECT_EQ(received.finished, 1);
}

TEST(OutputSink, IsNotAskedForMoreThanItsStampsTell) {
  Received received;
  CommandResult result = simulate_into(received, {scene_path, "--bag", "b", "--times", "0,1000.5"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("--times: 1000.5 s is refused; allowed: at most 1000 s with --bag"),
            std::string::npos)
      << result.err;
  EXPECT_EQ(received.finished, 0);
  result = simulate_into(received, {scene_path, "--bag", "b", "--times", "0,1000", "--quiet"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
}

TEST(OutputSink, IsRefusedAsABagWithoutRos) {
  const TemporaryFile bag("run.bag");
  const CommandResult result = simulate({scene_path, "--bag", bag.path()});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("--bag: \"" + bag.path() + "\" is refused: simulate was built without ROS"),
            std::string::npos)
      << result.err;
  EXPECT_FALSE(std::filesystem::exists(bag.path()));
}

TEST(OutputSink, OverwritesNoOtherFileOfTheRun) {
  const TemporaryFile file("one");
  Received received;
  for (const char* other : {"--states", "--switches"}) {
    const CommandResult result =
        simulate_into(received, {scene_path, other, file.path(), "--bag", file.path()});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(result.err.find("--bag: \"" + file.path() +
                              "\" is refused; allowed: a file other than that of " + other),
              std::string::npos)
        << result.err;
  }
}

TEST(OutputSink, TellsOneFileThatIsNotYetThereThroughTwoLinks) {
  const TemporaryFile file("one"), first("first"), second("second");
  std::filesystem::create_symlink(std::filesystem::path(file.path()).filename(), first.path());
  std::filesystem::create_symlink(first.path(), second.path());
  const CommandResult result = simulate({scene_path, "--states", first.path(), "--switches", second.path()});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("a file other than that of --states"), std::string::npos) << result.err;
  EXPECT_FALSE(std::filesystem::exists(file.path()));
}

}  // namespace
}  // namespace hybrid_sphere::testing::output_sink_test
