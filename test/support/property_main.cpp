// Runs properties on more cases than the hundred that RapidCheck takes by itself, the same ones in every run:
// what fails then fails for a change. RC_PARAMS overrides this: other cases with another seed=N, a failure
// with the reproduce=... that it printed.

#include <gtest/gtest.h>

#include <cstdlib>

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  setenv("RC_PARAMS", "seed=2005 max_success=1000 max_discard_ratio=50", 0);
  return RUN_ALL_TESTS();
}
