// A latched topic, with subscribers that connect while a message is sent.
#include "ros/node/publish_latched.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace hybrid_sphere::ros_interface::publish_latched_test {
namespace {

/// When a subscriber connects while `publish` runs.
enum class Connects { never, before_sending, between, after_keeping };

/// Sends a message first and keeps it for later subscribers then, as a publisher of roscpp 1.15.
class SlowPublisher {
 public:
  explicit SlowPublisher(Connects connects) : connects_(connects) {}

  // NOLINTNEXTLINE(readability-identifier-naming): ros::Publisher calls it so
  std::uint32_t getNumSubscribers() const { return static_cast<std::uint32_t>(inboxes_.size()); }

  void publish(int message) const {
    connect_at(Connects::before_sending);
    for (std::vector<int>& inbox : inboxes_) inbox.push_back(message);
    connect_at(Connects::between);
    last_ = message;
    connect_at(Connects::after_keeping);
    connects_ = Connects::never;
  }

  void connect() const {
    inboxes_.emplace_back();
    if (last_ != 0) inboxes_.back().push_back(last_);
  }

  const std::vector<std::vector<int>>& inboxes() const { return inboxes_; }

 private:
  void connect_at(Connects now) const {
    if (connects_ == now) connect();
  }

  mutable Connects connects_;
  mutable int last_ = 0;
  mutable std::vector<std::vector<int>> inboxes_;
};

class LatchedPublisher : public ::testing::TestWithParam<Connects> {};

TEST_P(LatchedPublisher, ReachesWhoeverConnectsMeanwhile) {
  const SlowPublisher publisher(GetParam());
  publish_latched(publisher, 7);
  publisher.connect();
  for (const std::vector<int>& inbox : publisher.inboxes()) {
    ASSERT_FALSE(inbox.empty());
    EXPECT_EQ(inbox.back(), 7);
  }
}

INSTANTIATE_TEST_SUITE_P(, LatchedPublisher,
                         ::testing::Values(Connects::never, Connects::before_sending, Connects::between,
                                           Connects::after_keeping));

TEST(PublishLatched, SendsOnceToThoseThatAreThere) {
  const SlowPublisher publisher(Connects::never);
  publisher.connect();
  publish_latched(publisher, 7);
  publisher.connect();
  publish_latched(publisher, 8);
  EXPECT_EQ(publisher.inboxes(), (std::vector<std::vector<int>>{{7, 8}, {7, 8}}));
}

}  // namespace
}  // namespace hybrid_sphere::ros_interface::publish_latched_test
