// The programs themselves, where their standard streams are closed, full or without a reader.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <functional>

#include "scene/printable.hpp"
#include "support/command_line.hpp"
#include "support/temporary_file.hpp"

namespace hybrid_sphere::testing::program_test {
namespace {

const std::string scene_path = std::string(TEST_DATA_DIR) + "/oracle/o05_bounce_back.yaml";

/// Runs a program whose standard error goes to a file. @param prepare  called in it before it begins
CommandResult run_program(const std::vector<std::string>& arguments, const std::function<void()>& prepare) {
  const TemporaryFile out("program_out");
  const TemporaryFile err("program_err");
  const pid_t child = fork();
  if (child == 0) {
    dup2(open(out.path().c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0600), STDOUT_FILENO);
    dup2(open(err.path().c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0600), STDERR_FILENO);
    for (int file = STDERR_FILENO + 1; file < 20; ++file) close(file);
    prepare();
    std::vector<char*> argv;
    for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    execv(argv[0], argv.data());
    _exit(127);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), out.text(), err.text()};
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

void to_full_disk() { dup2(open("/dev/full", O_WRONLY), STDOUT_FILENO); }

void to_nobody() {
  std::signal(SIGPIPE, SIG_DFL);  // as a shell has it
  int ends[2];
  if (pipe(ends) != 0) _exit(126);
  dup2(ends[1], STDOUT_FILENO);
  close(ends[0]);
  close(ends[1]);
}

TEST(Program, WithAClosedStandardOutputPutsNothingElseIntoATable) {
  const TemporaryFile table("closed_out.csv");
  const CommandResult result = run_program(
      {SIMULATE, scene_path, "--states", table.path(), "--timing", "--explain"}, [] { close(1); });
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_TRUE(contains(result.err, "standard output cannot be written")) << result.err;
  const std::vector<std::string> lines = split(table.text(), '\n');
  ASSERT_EQ(lines.size(), 1002U);
  for (const std::string& line : lines) EXPECT_EQ(split(line, ',').size(), 15U) << line;
}

TEST(Program, WithAClosedStandardErrorPutsNothingElseIntoATable) {
  const TemporaryFile table("closed_err.csv");
  const CommandResult result = run_program({SIMULATE, scene_path, "--states", table.path()}, [] {
    for (const int stream : {0, 1, 2}) close(stream);
  });
  EXPECT_EQ(result.exit_code, 0);
  for (const std::string& line : split(table.text(), '\n')) EXPECT_EQ(split(line, ',').size(), 15U) << line;
}

TEST(Program, DoesNotClaimToHaveWrittenWhatTheDiskHasNoRoomFor) {
  const std::vector<std::string> commands[] = {{SIMULATE, "--help"},
                                               {SIMULATE, scene_path},
                                               {SIMULATE, scene_path, "--explain"},
                                               {SIMULATE, scene_path, "--timing", "--quiet"},
                                               {THREE_STAGE, "--help"},
                                               {THREE_STAGE, "run", "--help"},
                                               {THREE_STAGE, "list"},
                                               {THREE_STAGE, "explain", "knife_edge_incline"},
                                               {THREE_STAGE, "run", "knife_edge_incline"}};
  for (const std::vector<std::string>& command : commands) {
    for (const auto& prepare : {to_full_disk, to_nobody}) {
      const CommandResult result = run_program(command, prepare);
      EXPECT_EQ(result.exit_code, 4) << command[0] << ' ' << command[1];
      EXPECT_TRUE(contains(result.err, "standard output cannot be written"))
          << command[1] << ": " << result.err;
    }
  }
}

TEST(Program, WritesTheOtherTableToItsEndWhereAPipeHasNoReader) {
  const TemporaryFile table("beside_pipe.csv");
  const CommandResult result = run_program(
      {SIMULATE, scene_path, "--states", "-", "--switches", table.path(), "--rate", "1"}, to_nobody);
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_TRUE(contains(result.err, "standard output cannot be written: Broken pipe")) << result.err;
  EXPECT_EQ(split(table.text(), '\n').size(), 3U);
}

TEST(Program, SaysWhereAFileHasReachedAnyLimitOfItsSize) {
  const TemporaryFile states("any_states.csv");
  const TemporaryFile switches("any_switches.csv");
  const auto run = [&](rlim_t bytes) {
    return run_program(
        {SIMULATE, scene_path, "--states", states.path(), "--switches", switches.path(), "--quiet"}, [bytes] {
          const rlimit limit{bytes, bytes};
          setrlimit(RLIMIT_FSIZE, &limit);
        });
  };
  EXPECT_EQ(run(RLIM_INFINITY).exit_code, 0);
  const std::string whole = states.text();
  for (const std::size_t bytes : {0UL, 1UL, 100UL, 4096UL, 8191UL, 8192UL, whole.size() - 1}) {
    const CommandResult result = run(bytes);
    EXPECT_EQ(result.exit_code, 4) << bytes;
    // Standard error goes to a file, which the limit cuts off, too.
    const bool told = contains(result.err, "cannot be written");
    EXPECT_TRUE(told || result.err.size() == bytes) << bytes << ": " << result.err;
    EXPECT_TRUE(told || bytes < 100) << bytes << ": " << result.err;
    EXPECT_EQ(states.text(), whole.substr(0, states.text().size()));
  }
  EXPECT_EQ(run(whole.size()).exit_code, 0);
}

TEST(Program, SaysWhereAFileHasReachedTheLimitOfItsSize) {
  const TemporaryFile table("limited.csv");
  const CommandResult result =
      run_program({SIMULATE, scene_path, "--states", table.path(), "--rate", "10000"}, [] {
        std::signal(SIGXFSZ, SIG_DFL);
        const rlimit limit{1'000'000, 1'000'000};
        setrlimit(RLIMIT_FSIZE, &limit);
      });
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_TRUE(contains(result.err, "\"" + table.path() + "\" cannot be written: File too large"))
      << result.err;
  EXPECT_TRUE(contains(result.err, "stopped at t = ")) << result.err;
}

TEST(Program, EchoesArgumentsThatAreNoUtf8AsUtf8) {
  const CommandResult result = run_program({SIMULATE, scene_path, "--duration", "1\xff"}, [] {});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_TRUE(contains(result.err, "--duration: \"1\\xff\" is refused")) << result.err;
  const std::vector<std::vector<std::string>> refused = {
      {SIMULATE, "no\xffscene.yaml"},
      {SIMULATE, scene_path, "--no\xffoption"},
      {SIMULATE, scene_path, "one\xffmore"},
      {SIMULATE, scene_path, "--states", "/no\xff/directory.csv"},
      {SIMULATE, scene_path, "--bag", "same\xff", "--states", "same\xff"},
      {THREE_STAGE, "run", "no\xffsystem"},
      {THREE_STAGE, "explain", "no\xffsystem"},
      {THREE_STAGE,
       "no\xff"
       "command"},
      {THREE_STAGE, "run", "knife_edge_incline", "--states", "/no\xff/directory.csv"},
  };
  for (const auto& command : refused) {
    const CommandResult other = run_program(command, [] {});
    EXPECT_NE(other.exit_code, 0);
    EXPECT_TRUE(contains(other.err, "\\xff")) << other.err;
    EXPECT_TRUE(scene::is_utf8(other.err)) << other.err;
  }
}

}  // namespace
}  // namespace hybrid_sphere::testing::program_test
