// The program of docs/cpp.md, built outside the tree with other flags than the library.

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "core/docs/shell.hpp"

namespace hybrid_sphere::testing::cpp_page_test {
namespace {

const std::filesystem::path page = CPP_PAGE_DIRECTORY;

/// Where find_package looks: the workspace or, without ROS, an installed library.
std::string prefix_in(const Scratch& scratch) {
#ifdef DEVEL_DIRECTORY
  (void)scratch;
  return DEVEL_DIRECTORY;
#else
  const std::filesystem::path prefix = scratch.path() / "prefix";
  const Outcome installed = call("cmake --install " + shell_quoted(BINARY_DIRECTORY) +
                                 " --component library --prefix " + shell_quoted(prefix));
  EXPECT_EQ(installed.exit_code, 0) << installed.output;
  return prefix;
#endif
}

TEST(CppPage, ProgramGivesTheSameBitsWithOtherFlags) {
  const Scratch scratch;
  for (const char* file : {"roll.cpp", "CMakeLists.txt"}) {
    std::filesystem::copy_file(page / file, scratch.path() / file);
  }
  const Outcome built = scratch.call_here(
      "env -u CMAKE_PREFIX_PATH cmake -G Ninja -S . -B build -DPYTHON_EXECUTABLE=" + shell_quoted(PYTHON) +
      " -DCMAKE_PREFIX_PATH=" + shell_quoted(prefix_in(scratch)) +
      " -DCMAKE_CXX_FLAGS='-O3 -march=native' && cmake --build build");
  ASSERT_EQ(built.exit_code, 0) << built.output;
  // The page reads a scene from the root of the repository.
  const Outcome outcome =
      call("cd " + shell_quoted(SOURCE_DIRECTORY) + " && " + shell_quoted(scratch.path() / "build" / "roll"));
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.output, text_of(page / "roll.expected.txt"));
}

TEST(CppPage, AnotherAlignmentIsRefusedByTheCompiler) {
  const Scratch scratch;
  const Outcome outcome = scratch.call_here(
      "c++ -std=c++17 -fsyntax-only -DEIGEN_MAX_ALIGN_BYTES=32 -isystem /usr/include/eigen3 -I " +
      shell_quoted(std::filesystem::path(SOURCE_DIRECTORY) / "include") + " " +
      shell_quoted(page / "roll.cpp"));
  EXPECT_NE(outcome.exit_code, 0);
  EXPECT_NE(outcome.output.find("hybrid_sphere needs Eigen's alignment of 16 bytes"), std::string::npos)
      << outcome.output;
}

}  // namespace
}  // namespace hybrid_sphere::testing::cpp_page_test
