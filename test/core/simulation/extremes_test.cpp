// Scenes with extreme numbers, each against its solution in a hundred digits: every state and every switch is
// as good as binary64 allows, or the scene is refused with a reason.

#include <gtest/gtest.h>

#include <algorithm>

#include "support/extremes.hpp"
#include "support/files.hpp"

namespace hybrid_sphere::testing::extremes_test {
namespace {

// The floor counts one rounding of the input and of the state at each switch. A program rounds more than
// once: the coefficients of the motion (kappa, p_c, the time of an edge), the function of time, the sum with
// the start. That is fewer than eight in a row for each quantity.
constexpr double roundings = 8;

// An integrated motion is right to the accuracy of each of its steps, 1e-14 here, and up to ten of them add
// up.
constexpr double of_integration = 1e-13;

const std::string directory = std::string(TEST_DATA_DIR) + "/extremes";

class Extreme : public ::testing::TestWithParam<std::string> {};

TEST_P(Extreme, IsReachedAsFarAsBinary64Allows) {
  const Measured measured = measure(read_extreme(directory, GetParam()),
                                    read_expected(directory + "/" + GetParam() + ".expected.yaml"));
  ASSERT_EQ(measured.failure, "");
  if (measured.integrated) {
    EXPECT_LE(measured.relative.error, roundings * measured.relative.floor + of_integration)
        << measured.relative.where << ", relative to the scale of motion";
  } else {
    EXPECT_LE(measured.worst.error, roundings * measured.worst.floor) << measured.worst.where;
  }
  RecordProperty("worst_ratio_to_floor", std::to_string(measured.worst.ratio()));
}

std::string test_name(const ::testing::TestParamInfo<std::string>& info) { return as_test_name(info.param); }

// Those called slow take minutes; the program `extremes` runs them.
std::vector<std::string> quick_scenes() {
  std::vector<std::string> names = yaml_files("extremes");
  const auto is_slow = [](const std::string& name) { return name.rfind("slow_", 0) == 0; };
  names.erase(std::remove_if(names.begin(), names.end(), is_slow), names.end());
  return names;
}

INSTANTIATE_TEST_SUITE_P(Scenes, Extreme, ::testing::ValuesIn(quick_scenes()), test_name);

}  // namespace
}  // namespace hybrid_sphere::testing::extremes_test
