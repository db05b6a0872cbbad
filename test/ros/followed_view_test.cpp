#include "ros/view/followed_view.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "ros/view/camera.hpp"
#include "ros/view/scene_framing.hpp"

namespace hybrid_sphere::ros_interface::followed_view_test {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

constexpr double roundoff = 1e-12;  // relative to a dead zone, of a few operations at a distance of 1

/// A point as the camera sees it, in half heights of the picture, and its depth over the camera's distance.
struct Seen {
  double across;
  double up;
  double depth;
};

Seen seen_from(const Vector3d& center, double distance, const Vector3d& point) {
  const Vector3d to_camera(0, -std::cos(camera::pitch), std::sin(camera::pitch));
  const Vector3d upward(0, std::sin(camera::pitch), std::cos(camera::pitch));
  const Vector3d offset = point - center;
  const double depth = distance - offset.dot(to_camera);
  const double half = depth * camera::half_height();
  return {offset.x() / half, offset.dot(upward) / half, depth / distance};
}

void expect_in_dead_zone(const FollowedView& view, const Vector3d& body) {
  const Vector3d offset = (body - view.center()).cwiseAbs();
  const Vector3d outer = view.distance() * DeadZone::outer();
  for (int i = 0; i < 3; ++i) EXPECT_LE(offset[i], outer[i] * (1 + roundoff) + roundoff * std::abs(body[i]));
}

std::vector<Vector3d> corners_of_dead_zone() {
  std::vector<Vector3d> corners;
  for (const double x : {-1, 1}) {
    for (const double y : {-1, 1}) {
      for (const double z : {-1, 1}) corners.emplace_back(DeadZone::outer().cwiseProduct(Vector3d(x, y, z)));
    }
  }
  return corners;
}

TEST(DeadZone, IsInThePictureWithABodyOfTheGreatestSize) {
  for (const Vector3d& corner : corners_of_dead_zone()) {
    const Seen seen = seen_from(Vector3d::Zero(), 1, corner);
    const double half_width = 0.04 / (camera::half_height() * seen.depth);
    EXPECT_LT(std::abs(seen.across) + half_width, camera::least_aspect) << corner.transpose();
    EXPECT_LT(std::abs(seen.up) + half_width, 1) << corner.transpose();
  }
}

TEST(FollowedView, StandsStillInTheMiddle) {
  FollowedView view(10, {1, 2, 0}, {1, 2, 0});
  for (const double x : {0.5, 2.0, -0.9, 1.0}) {
    view.follow({1 + x, 2 - 0.7 * x, 0});
    EXPECT_EQ(view.center(), Vector3d(1, 2, 0));
  }
}

TEST(FollowedView, HasTheBodyInsideOnAnyPath) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  for (const double size : {1e-3, 0.1, 1.0, 100.0}) {  // of a step, in units of the distance
    Vector3d body = Vector3d::Zero();
    FollowedView view(2, Vector3d::Constant(50), body);
    expect_in_dead_zone(view, body);
    Vector3d velocity = Vector3d::Zero();
    for (int i = 0; i < 5000; ++i) {
      for (int k = 0; k < 3; ++k) velocity[k] += 0.1 * size * normal(random);
      if (i % 100 == 0) velocity.setZero();
      body += velocity;
      view.follow(body);
      expect_in_dead_zone(view, body);
    }
  }
}

TEST(FollowedView, TakesTheVelocityOfTheBodyWithoutAJump) {
  const double step = 1e-3;
  FollowedView view(1, Vector3d::Zero(), Vector3d::Zero());
  double last_speed = 0;
  for (int i = 1; i <= 2000; ++i) {
    const double before = view.center().x();
    view.follow({i * step, 0, 0});
    const double speed = (view.center().x() - before) / step;
    EXPECT_GE(speed, last_speed - 1e-9);
    // The acceleration is at most that at the inner edge: speed squared over the width of the edge.
    EXPECT_LE(speed - last_speed, 1.01 * step / (DeadZone::outer() - DeadZone::inner()).x());
    last_speed = speed;
  }
  EXPECT_NEAR(last_speed, 1, 1e-3);
}

TEST(FollowedView, DoesNotDependOnTheNumberOfSteps) {
  FollowedView coarse(1, Vector3d::Zero(), Vector3d::Zero());
  FollowedView fine = coarse;
  for (int i = 1; i <= 100; ++i) fine.follow(Vector3d(0.6, -0.4, 0) * (0.01 * i));
  coarse.follow({0.6, -0.4, 0});
  EXPECT_LT((coarse.center() - fine.center()).norm(), 100 * roundoff);
}

TEST(FollowedView, StaysWhereItIsWhenNothingMoves) {
  FollowedView view(1, Vector3d::Zero(), Vector3d::Zero());
  view.follow({0.5, 0.3, 0.2});
  const Vector3d center = view.center();
  view.follow({0.5, 0.3, 0.2});
  EXPECT_EQ(view.center(), center);
}

TEST(FollowedView, HasABodyInTheMiddleThatWasPutFarAway) {
  FollowedView view(1, Vector3d::Zero(), Vector3d::Zero());
  view.follow({1e6, 3, 0});
  EXPECT_EQ(view.center(), Vector3d(1e6, 3, 0));
}

TEST(SceneFraming, HasTheBodyInsideAndLargeEnough) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> exponent(-3, 4);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 2000; ++i) {
    const double half_width = std::pow(10, exponent(random));
    const double size = std::pow(10, exponent(random));
    const double speed = std::pow(10, exponent(random));
    const auto draw = [&](double scale) {
      return Vector3d(scale * normal(random), scale * normal(random),
                      i % 2 == 0 ? 0 : scale * normal(random));
    };
    AlignedBox3d map;
    if (i % 3 != 0) map = AlignedBox3d(draw(size)).extend(draw(size));
    const FramedBody body{draw(size), draw(speed), half_width};
    const Framing first = first_framing(map, body);
    expect_in_dead_zone({first.distance, first.center, body.position}, body.position);
    for (const Vector3d& corner : corners_of_dead_zone()) {
      const Seen seen = seen_from(Vector3d::Zero(), first.distance, first.distance * corner);
      const double half = half_width / (camera::half_height() * first.distance * seen.depth);
      EXPECT_LT(std::abs(seen.across) + half, camera::least_aspect);
      EXPECT_LT(std::abs(seen.up) + half, 1);
      EXPECT_GE(half * camera::picture_height, camera::least_body_width * (1 - roundoff));
    }
    EXPECT_GE(whole_framing(map, body, first).distance, first.distance);
  }
}

TEST(SceneFraming, OfTheWholeHasEachCornerInThePicture) {
  const AlignedBox3d map(Vector3d(-3, -2, 0), Vector3d(40, 7, 0));
  const FramedBody body{{0, 0, 0}, {1, 0, 0}, 0.1};
  const Framing whole = whole_framing(map, body, first_framing(map, body));
  for (const double x : {-3, 40}) {
    for (const double y : {-2, 7}) {
      const Seen seen = seen_from(whole.center, whole.distance, {x, y, 0});
      EXPECT_LT(std::abs(seen.across), camera::least_aspect);
      EXPECT_LT(std::abs(seen.up), 1);
    }
  }
}

TEST(SceneFraming, OfASmallMapIsThatOfTheWholeMap) {
  const AlignedBox3d map(Vector3d(-1, -1, 0), Vector3d(1, 1, 0));
  const Framing first = first_framing(map, {{0, 0, 0}, {0, 0, 0}, 0.1});
  EXPECT_LT((first.center).norm(), roundoff);
  for (const double x : {-1, 1}) {
    const Seen seen = seen_from(first.center, first.distance, {x, -1, 0});
    EXPECT_LT(std::abs(seen.across), camera::least_aspect);
    EXPECT_LT(std::abs(seen.up), 1);
  }
}

}  // namespace
}  // namespace hybrid_sphere::ros_interface::followed_view_test
