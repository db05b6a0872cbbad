// The programs that docs/your_own_system.md consists of, and the one that it points to. The build has
// extracted them from the page, with what the page says they print.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "core/docs/shell.hpp"

namespace hybrid_sphere::testing::your_own_system_test {
namespace {

const std::filesystem::path page_directory = PAGE_DIRECTORY;

class PageProgram : public ::testing::TestWithParam<const char*> {};

// Numbers are printed with fewer digits than they are accurate to.
TEST_P(PageProgram, PrintsWhatThePageShows) {
  const Scratch scratch;
  const std::string name = GetParam();
  const std::string expected = text_of(page_directory / (name + ".expected.txt"));
  ASSERT_FALSE(expected.empty());
  const Outcome outcome =
      scratch.call_here(shell_quoted(name == "pursuit" ? PURSUIT : page_directory / name));
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.output, expected);
}

INSTANTIATE_TEST_SUITE_P(Every, PageProgram,
                         ::testing::Values("sledge", "steered", "gears", "wheel", "variants", "bicycle",
                                           "door", "plank", "pursuit"),
                         [](const auto& info) { return std::string(info.param); });

/// A directory that looks as the page says, to be built in `build`.
void lay_out(const Scratch& scratch, const std::string& way) {
  for (const char* file : {"sledge.hpp", "sledge.cpp"}) {
    std::filesystem::copy_file(page_directory / file, scratch.path() / file);
  }
  std::filesystem::copy_file(page_directory / way / "CMakeLists.txt", scratch.path() / "CMakeLists.txt");
}

const std::string configure =
    "env -u CMAKE_PREFIX_PATH cmake -G Ninja -S . -B build -DPYTHON_EXECUTABLE=" + shell_quoted(PYTHON) + " ";

// To build the whole package once more takes minutes.
TEST(PageBuildLines, AreConfiguredWithoutRos) {
  const Scratch scratch;
  lay_out(scratch, "without_ros");
  std::filesystem::create_directory_symlink(SOURCE_DIRECTORY, scratch.path() / "hybrid_sphere");
  const Outcome outcome = scratch.call_here(configure);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
}

#ifdef DEVEL_DIRECTORY
TEST(PageBuildLines, BuildTheProgramAgainstAWorkspace) {
  const Scratch scratch;
  lay_out(scratch, "plain");
  const Outcome outcome =
      scratch.call_here(configure + "-DCMAKE_PREFIX_PATH=" + shell_quoted(DEVEL_DIRECTORY) +
                        " && cmake --build build && build/sledge");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
}

// The same library and headers as against a workspace: a program of one call shows that the lines find them.
TEST(PageBuildLines, BuildAProgramInAWorkspace) {
  const Scratch scratch;
  lay_out(scratch, "catkin");
  std::ofstream(scratch.path() / "sledge.cpp") << "#include <cstdio>\n"
                                                  "#include \"hybrid_sphere/mechanics/solution.hpp\"\n"
                                                  "using namespace hybrid_sphere::mechanics;\n"
                                                  "int main() { std::puts(to_string(Stop::reached_end)); }\n";
  std::ofstream(scratch.path() / "package.xml")
      << "<package format=\"2\"><name>sledge</name><version>0.0.0</version><description>A "
         "sledge</description>"
         "<maintainer email=\"a@b.example\">A</maintainer><license>BSD</license>"
         "<buildtool_depend>catkin</buildtool_depend><depend>hybrid_sphere</depend></package>\n";
  const Outcome outcome =
      scratch.call_here(configure + "-DCMAKE_PREFIX_PATH=" + shell_quoted(DEVEL_DIRECTORY) +
                        " && cmake --build build && build/devel/lib/sledge/sledge");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
}
#endif

// Without matplotlib the plot is only compiled.
TEST(PagePlot, IsDrawnFromTheTableOfTheProgram) {
  const Scratch scratch;
  ASSERT_EQ(scratch.call_here(shell_quoted(page_directory / "sledge")).exit_code, 0);
  std::filesystem::copy_file(page_directory / "plot_sledge.py", scratch.path() / "plot_sledge.py");
  const std::string python = shell_quoted(PYTHON);
  const Outcome compiled = scratch.call_here(python + " -m py_compile plot_sledge.py");
  ASSERT_EQ(compiled.exit_code, 0) << compiled.output;
  if (call(python + " -c 'import matplotlib'").exit_code != 0) return;
  const Outcome drawn = scratch.call_here("MPLCONFIGDIR=. " + python + " plot_sledge.py");
  EXPECT_EQ(drawn.exit_code, 0) << drawn.output;
  EXPECT_TRUE(std::filesystem::exists(scratch.path() / "sledge.png")) << drawn.output;
}

}  // namespace
}  // namespace hybrid_sphere::testing::your_own_system_test
