// `simulate --html`.

#include <gtest/gtest.h>

#include <csignal>

#include "support/command_line.hpp"
#include "support/page.hpp"
#include "support/temporary_file.hpp"

namespace hybrid_sphere::testing::simulate_html_test {
namespace {

const std::string scene_path = std::string(TEST_DATA_DIR) + "/oracle/o05_bounce_back.yaml";

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

class SimulateHtml : public ::testing::Test {
 protected:
  TemporaryFile page_{"page.html"};
};

TEST_F(SimulateHtml, WritesAPageAndNothingElse) {
  const CommandResult result = simulate({scene_path, "--html", page_.path(), "--duration", "2", "--quiet"});
  EXPECT_EQ(result.exit_code, cli::done) << result.err;
  EXPECT_EQ(result.out + result.err, "");
  const YAML::Node data = data_of(page_.text());
  EXPECT_EQ(data["title"].as<std::string>(), "o05_bounce_back.yaml");
  EXPECT_EQ(data["ended"].as<std::string>(), "");
  EXPECT_EQ(numbers_of<double>(data["states"]["time"].as<std::string>()).size(), 201U);
  EXPECT_EQ(numbers_of<double>(data["switches"]["time"].as<std::string>()).size(), 2U);
}

TEST_F(SimulateHtml, HasTheNumbersOfTheTables) {
  const CommandResult result =
      simulate({scene_path, "--html", page_.path(), "--states", "-", "--times", "0.5,1.25,3", "--quiet"});
  const std::vector<std::string> rows = split(result.out, '\n');
  ASSERT_EQ(rows.size(), 4U);
  const YAML::Node data = data_of(page_.text());
  const auto times = numbers_of<double>(data["states"]["time"].as<std::string>());
  const std::vector<double> positions = floats_of(data["states"]["position"]);
  const auto turns = numbers_of<std::int16_t>(data["states"]["orientation"].as<std::string>());
  for (std::size_t i = 0; i < 3; ++i) {
    const std::vector<std::string> row = split(rows[i + 1], ',');
    EXPECT_EQ(times[i], std::stod(row[0]));
    EXPECT_NEAR(positions[2 * i] + data["origin"][0].as<double>(), std::stod(row[1]), 1e-6);
    EXPECT_NEAR(positions[2 * i + 1] + data["origin"][1].as<double>(), std::stod(row[2]), 1e-6);
    for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(turns[4 * i + k] / 32767.0, std::stod(row[3 + k]), 2e-5);
  }
}

TEST_F(SimulateHtml, GoesToStandardOutputAlone) {
  const CommandResult result = simulate({scene_path, "--html", "-", "--explain", "--timing", "--quiet"});
  EXPECT_EQ(result.exit_code, cli::done);
  EXPECT_EQ(result.out.rfind("<!DOCTYPE html>", 0), 0U);
  EXPECT_EQ(result.out.substr(result.out.size() - 8), "</html>\n");
  EXPECT_TRUE(contains(result.err, "\"wall_s\""));
}

TEST_F(SimulateHtml, RefusesFilesThatClash) {
  const std::string page = page_.path();
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{scene_path, "--html", ""},
                                             {scene_path, "--html", "-", "--states", "-"},
                                             {scene_path, "--html", "-", "--switches", "-"},
                                             {scene_path, "--html", page, "--states", page},
                                             {scene_path, "--html", scene_path}}) {
    const CommandResult result = simulate(arguments);
    EXPECT_EQ(result.exit_code, cli::usage) << result.err;
    EXPECT_TRUE(contains(result.err, "--html: ") && contains(result.err, " is refused; allowed: a file"))
        << result.err;
  }
}

TEST_F(SimulateHtml, ThatCannotBeWrittenIsTold) {
  const CommandResult result = simulate({scene_path, "--html", "/nowhere/page.html"});
  EXPECT_EQ(result.exit_code, cli::could_not_go_on);
  EXPECT_TRUE(contains(result.err, "\"/nowhere/page.html\" cannot be written: No such file")) << result.err;
  const CommandResult full = simulate({scene_path, "--html", "/dev/full"});
  EXPECT_EQ(full.exit_code, cli::could_not_go_on);
  EXPECT_TRUE(contains(full.err, "cannot be written: No space left")) << full.err;
}

TEST_F(SimulateHtml, SaysWhatItLeavesOut) {
  const std::vector<std::string> arguments{scene_path, "--html", page_.path(), "--rate", "2000"};
  const CommandResult result = simulate(arguments);
  const std::string note = "of 20001 outputs the page has 10001, evenly chosen";
  EXPECT_TRUE(contains(result.err, "simulate: --html: " + note + "\n")) << result.err;
  EXPECT_EQ(data_of(page_.text())["leftOut"][0].as<std::string>(), note);
}

TEST_F(SimulateHtml, OfARunThatHaltsEndsThere) {
  const TemporaryFile scene("halts.yaml");
  scene.fill(
      "sphere: {mass: 1, radius: 0.1, body: solid}\n"
      "initial_state: {position: [-1, 0], velocity: [1, 0]}\n"
      "surface:\n"
      "  livelock: stop\n"
      "  base: {law: rough, belt: [1, 0]}\n"
      "  regions:\n"
      "    - {name: against, half_plane: {point: [0, 0], normal: [1, 0]}, law: rough, belt: [-4, 0]}\n");
  const CommandResult result = simulate({scene.path(), "--html", page_.path()});
  EXPECT_EQ(result.exit_code, cli::could_not_go_on);
  const YAML::Node data = data_of(page_.text());
  const std::string ended = data["ended"].as<std::string>();
  EXPECT_EQ(ended.rfind("stopped at t = ", 0), 0U) << ended;
  EXPECT_TRUE(contains(result.err, ended)) << result.err;
  const auto times = numbers_of<double>(data["states"]["time"].as<std::string>());
  ASSERT_FALSE(times.empty());
  EXPECT_LT(times.back(), 10);
}

/// Sends SIGINT to the test's own process at the first block.
class Interrupting : public cli::OutputSink {
 public:
  void write(const cli::OutputBlock& /*block*/) override {
    if (!sent_) raise(SIGINT);
    sent_ = true;
  }

 private:
  bool sent_ = false;
};

TEST_F(SimulateHtml, OfARunThatIsInterruptedEndsThere) {
  signal(SIGINT, SIG_DFL);  // ignored in a job in the background of a shell
  const cli::BagFormat format{
      1e9, [](const std::string&, const scene::Scene&) { return std::make_unique<Interrupting>(); }};
  cli::Options options;
  options.scene = scene_path;
  options.rate = 1000;
  options.duration = 1e6;
  options.bag = "nowhere";
  options.html = page_.path();
  std::ostringstream out;
  std::ostringstream err;
  EXPECT_EQ(cli::run(options, out, err, &format), 128 + SIGINT);
  const YAML::Node data = data_of(page_.text());
  EXPECT_EQ(data["ended"].as<std::string>().rfind("ended by signal 2 at t = ", 0), 0U);
  EXPECT_GE(numbers_of<double>(data["states"]["time"].as<std::string>()).size(), 4096U);
}

}  // namespace
}  // namespace hybrid_sphere::testing::simulate_html_test
