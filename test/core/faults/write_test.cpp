// Every write to standard output fails in turn: exit code 4 with a line that says so, never a silent end, and
// the table in a file has all that the run has computed up to there.

#include <gtest/gtest.h>

#include <streambuf>

#include "support/command_line.hpp"
#include "support/temporary_file.hpp"
#include "support/three_stage_line.hpp"

namespace hybrid_sphere::testing::write_test {
namespace {

/// Takes so many writes and flushes, then fails. A write fails whole or, as on a full disk, in its middle.
class Failing : public std::streambuf {
 public:
  Failing(std::size_t writes, bool in_the_middle) : left_(writes), in_the_middle_(in_the_middle) {}

  bool has_failed() const { return failed_; }
  const std::string& text() const { return text_; }

 protected:
  int_type overflow(int_type character) override {
    const char c = traits_type::to_char_type(character);
    return xsputn(&c, 1) == 1 ? character : traits_type::eof();
  }
  std::streamsize xsputn(const char* text, std::streamsize size) override {
    const std::streamsize taken = take() ? size : in_the_middle_ ? size / 2 : 0;
    text_.append(text, static_cast<std::size_t>(taken));
    return taken;
  }
  int sync() override { return take() ? 0 : -1; }

 private:
  bool take() {
    if (left_ == 0) failed_ = true;
    left_ -= left_ > 0 ? 1 : 0;
    return !failed_;
  }

  std::size_t left_;
  bool in_the_middle_;
  bool failed_ = false;
  std::string text_;
};

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// @param run  gives the exit code. Returns how many writes there are.
template <class Run>
std::size_t expect_told(const Run& run) {
  std::size_t writes = 0;
  for (bool failed = true; failed; ++writes) {
    for (const bool in_the_middle : {false, true}) {
      Failing buffer(writes, in_the_middle);
      std::ostream out(&buffer);
      std::ostringstream err;
      const int code = run(out, err);
      failed = buffer.has_failed();
      EXPECT_EQ(code, failed ? cli::could_not_go_on : cli::done) << "write " << writes;
      EXPECT_EQ(contains(err.str(), "standard output cannot be written"), failed) << err.str();
    }
  }
  return writes;
}

const std::string scene_path = std::string(TEST_DATA_DIR) + "/oracle/o05_bounce_back.yaml";

TEST(Write, OfStatesFailsInTurn) {
  const TemporaryFile switches("beside.csv");
  const auto run = [&](std::ostream& out, std::ostream& err) {
    cli::Options options;
    options.scene = scene_path;
    options.rate = 8000;
    options.duration = 2;
    options.states = "-";
    options.switches = switches.path();
    const int code = cli::run(options, out, err);
    // The switches at t = 1 are in their table where a row of a later time is in the other one.
    const std::string& text = static_cast<const Failing&>(*out.rdbuf()).text();
    const std::vector<std::string> rows = split(text.substr(0, text.rfind('\n') + 1), '\n');
    const bool passed = rows.size() > 1 && std::stod(rows.back()) > 1;
    if (code == cli::done) {
      EXPECT_TRUE(passed);
    }
    if (passed) {
      EXPECT_GT(split(switches.text(), '\n').size(), 1U) << rows.back();
    }
    return code;
  };
  EXPECT_GT(expect_told(run), 9U);
}

TEST(Write, OfSwitchesExplanationAndTimingFailsInTurn) {
  cli::Options options;
  options.scene = scene_path;
  options.switches = "-";
  EXPECT_GT(expect_told([&](std::ostream& out, std::ostream& err) { return cli::run(options, out, err); }),
            2U);
  options.switches.clear();
  options.explain = options.timing = true;
  EXPECT_GT(expect_told([&](std::ostream& out, std::ostream& err) { return cli::run(options, out, err); }),
            1U);
}

TEST(Write, OfHelpFailsInTurn) {
  const char* const argv[] = {"program", "--help"};
  expect_told(
      [&](std::ostream& out, std::ostream& err) { return cli::parse_options(2, argv, out, err).exit_code; });
  expect_told([&](std::ostream& out, std::ostream& err) {
    return cli::three_stage::parse_options(2, argv, out, err).exit_code;
  });
}

TEST(Write, OfThreeStageFailsInTurn) {
  for (const std::vector<const char*>& arguments :
       {std::vector<const char*>{"three_stage", "list"},
        {"three_stage", "explain", "knife_edge_incline"},
        {"three_stage", "run", "knife_edge_incline", "--states", "-"}}) {
    expect_told([&](std::ostream& out, std::ostream& err) {
      const auto parsed =
          cli::three_stage::parse_options(static_cast<int>(arguments.size()), arguments.data(), out, err);
      return parsed.options ? cli::three_stage::run(*parsed.options, out, err) : parsed.exit_code;
    });
  }
}

}  // namespace
}  // namespace hybrid_sphere::testing::write_test
