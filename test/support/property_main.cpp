// Runs properties on more cases than the hundred that RapidCheck takes by itself. RC_PARAMS overrides this,
// to repeat a failure with the seed that it printed: RC_PARAMS="reproduce=..."

#include <gtest/gtest.h>

#include <cstdlib>

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  setenv("RC_PARAMS", "max_success=1000 max_discard_ratio=50", 0);
  return RUN_ALL_TESTS();
}
