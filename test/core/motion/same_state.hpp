#pragma once

#include <gtest/gtest.h>

#include <string>

#include "motion/motion.hpp"

namespace hybrid_sphere::testing {

/// The same to the bit.
inline void expect_same(const MotionState& a, const MotionState& b, const std::string& where) {
  EXPECT_EQ(a.center.position, b.center.position) << where;
  EXPECT_EQ(a.center.velocity, b.center.velocity) << where;
  EXPECT_EQ(a.contact_velocity, b.contact_velocity) << where;
  EXPECT_EQ(a.angular_velocity, b.angular_velocity) << where;
}

}  // namespace hybrid_sphere::testing
