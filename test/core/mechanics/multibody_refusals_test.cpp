// What a MultibodySystem refuses, and how it says so.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "hybrid_sphere/mechanics/multibody_system.hpp"
#include "hybrid_sphere/mechanics/solve.hpp"

namespace hybrid_sphere::mechanics::multibody_refusals_test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

/// The message of std::invalid_argument; empty if there is none.
template <class Call>
std::string refusal(Call call) {
  try {
    call();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

MultibodySystem two_bodies() {
  MultibodySystem system;
  system.body("one", 1, {1, 1, 1}, Vector3d(0, 0, 1)).body("two", 1, {1, 1, 1}, Vector3d(1, 0, 1));
  return system;
}

std::string refusal_of_body(double mass, const Inertia& inertia) {
  return refusal([&] { MultibodySystem().body("b", mass, inertia, Vector3d(0, 0, 0)); });
}

TEST(MultibodyRefusals, NameTheMass) {
  EXPECT_EQ(refusal_of_body(0, {1, 1, 1}), "body \"b\": mass = 0 is refused; allowed: a number > 0");
  EXPECT_EQ(refusal_of_body(-2, {1, 1, 1}), "body \"b\": mass = -2 is refused; allowed: a number > 0");
  EXPECT_NE(refusal_of_body(nan, {1, 1, 1}), "");
  EXPECT_NE(refusal_of_body(infinity, {1, 1, 1}), "");
}

TEST(MultibodyRefusals, NameTheInertiaThatNoBodyHas) {
  EXPECT_EQ(
      refusal_of_body(1, {1, 2, 4}),
      "body \"b\": inertia with the principal moments (1, 2, 4) is refused; allowed: a largest moment of at "
      "most the sum of the others");
  EXPECT_EQ(refusal_of_body(1, {-1, 2, 2}),
            "body \"b\": inertia with the principal moments (-1, 2, 2) is refused; allowed: moments > 0");
  EXPECT_NE(refusal_of_body(1, {0, 1, 1}), "");
  EXPECT_NE(refusal_of_body(1, {0, 0, 0}), "");
  EXPECT_NE(refusal_of_body(1, {nan, 1, 1}), "");
  EXPECT_NE(refusal_of_body(1, {1, 1, 1, 2}), "");  // moments -1, 1, 3
  Matrix3d skew = Matrix3d::Identity();
  skew(0, 1) = 0.25;
  EXPECT_EQ(refusal_of_body(1, Inertia(skew)),
            "body \"b\": inertia with (2, 1) = 0 and its mirror image 0.25 is refused; allowed: a symmetric "
            "matrix");
}

// A thin plate has a largest moment that is just the sum of the others, on whatever axes.
TEST(MultibodyRefusals, AllowForRounding) {
  const Vector3d plate(0.1, 0.2, 0.1 + 0.2);
  for (int i = 0; i < 20; ++i) {
    const Matrix3d R = Eigen::AngleAxisd(0.3 * i, Vector3d(1, i, -2).normalized()).toRotationMatrix();
    const Matrix3d turned = R * plate.asDiagonal() * R.transpose();
    EXPECT_EQ(refusal_of_body(1, Inertia(turned)), "") << i;
  }
  EXPECT_NE(refusal_of_body(1, {0.1, 0.2, 0.3 * (1 + 1e-12)}), "");
}

TEST(MultibodyRefusals, NameBodies) {
  MultibodySystem system = two_bodies();
  const auto add = [&](const std::string& name) {
    return refusal([&] { system.body(name, 1, {1, 1, 1}, Vector3d(0, 0, 0)); });
  };
  EXPECT_NE(add(""), "");
  EXPECT_EQ(add("world"), "body \"world\": its name is refused; allowed: any but none and \"world\"");
  EXPECT_EQ(add("one"), "body \"one\": a second one of this name is refused; allowed: a name of its own");
  EXPECT_EQ(refusal([&] {
              system.ball("joint", "one", "three", {0, 0, 0});
            }),
            "constraint \"joint\": body = \"three\" is refused; allowed: world, one, two");
  EXPECT_EQ(refusal([&] {
              system.ball("joint", "one", "one", {0, 0, 0});
            }),
            "constraint \"joint\": \"one\" twice is refused; allowed: two bodies, or one and the world");
  EXPECT_NE(refusal([&] { system.ball("joint", "world", "world", {0, 0, 0}); }), "");
  EXPECT_EQ(refusal([&] { system.rolling("tyre", "world", ContactShape::sphere(1)); }),
            "constraint \"tyre\": body = \"world\" is refused; allowed: a body");
  const Vector q = system.initial().q;
  EXPECT_NE(refusal([&] { system.pose(q, "three"); }), "");
  EXPECT_NE(refusal([&] { system.pose(q, "world"); }), "");
  EXPECT_EQ(refusal([&] { system.poses(Vector::Zero(3)); }),
            "q of 3 numbers is refused; allowed: 14 numbers");
  EXPECT_NE(refusal([&] { system.twist(q, Vector::Zero(3), "one"); }), "");
  Eigen::Isometry3d stretched = Eigen::Isometry3d::Identity();
  stretched.linear()(0, 0) = 1.001;
  EXPECT_NE(refusal([&] { system.body("b", 1, {1, 1, 1}, stretched); }), "");
  stretched.linear() = -Matrix3d::Identity();
  EXPECT_NE(refusal([&] { system.body("b", 1, {1, 1, 1}, stretched); }), "");
  EXPECT_NE(refusal([&] { system.body("b", 1, {1, 1, 1}, Vector3d(0, nan, 0)); }), "");
  EXPECT_NE(refusal([&] { MultibodySystem(Vector3d(0, 0, infinity)); }), "");
  EXPECT_EQ(system.velocities.size(), 12u);  // nothing of all that has been added
  EXPECT_EQ(system.constraints.size(), 0u);
}

TEST(MultibodyRefusals, NameDirectionsAndLengths) {
  MultibodySystem system = two_bodies();
  const Vector3d none(0, 0, 0), bad(0, nan, 0), x(1, 0, 0), z(0, 0, 1);
  EXPECT_EQ(refusal([&] { system.hinge("h", "one", "two", none, none); }),
            "constraint \"h\": axis = (0, 0, 0) is refused; allowed: a vector of a length > 0");
  EXPECT_NE(refusal([&] { system.hinge("h", "one", "two", bad, x); }), "");
  EXPECT_NE(refusal([&] { system.slider("h", "one", "two", none, none); }), "");
  EXPECT_NE(refusal([&] { system.planar("h", "one", "two", none, none); }), "");
  EXPECT_NE(refusal([&] { system.weld("h", "one", "two", bad); }), "");
  EXPECT_EQ(refusal([&] { system.rod("r", "one", "two", x, x); }),
            "constraint \"r\": length = 0 is refused; allowed: a number > 0");
  EXPECT_EQ(refusal([&] { system.rolling("tyre", "one", ContactShape::sphere(-1)); }),
            "constraint \"tyre\": radius = -1 is refused; allowed: a number > 0");
  EXPECT_NE(refusal([&] { system.rolling("tyre", "one", ContactShape::disk(1, none)); }), "");
  EXPECT_NE(refusal([&] { system.rolling("tyre", "one", ContactShape::sphere(1, bad)); }), "");
  EXPECT_NE(refusal([&] { system.rolling("tyre", "one", ContactShape::sphere(1), always(), {bad, z}); }), "");
  EXPECT_NE(refusal([&] {
              system.rolling("tyre", "one", ContactShape::sphere(1), always(), {x, none});
            }),
            "");
  EXPECT_EQ(refusal([&] { system.blade("b", "one", none, z); }),
            "constraint \"b\": a direction along the normal of the plane is refused; allowed: one at an "
            "angle to it");
  EXPECT_EQ(refusal([&] { system.contact("c", "one", ContactShape::sphere(1), 1.5); }),
            "constraint \"c\": restitution = 1.5 is refused; allowed: 0 to 1");
  EXPECT_EQ(refusal([&] { system.friction("f", "c", Slip::along, 0.5); }),
            "friction \"f\": contact = \"c\" is refused; allowed: none, as there is no contact");
  system.contact("c", "one", ContactShape::sphere(1));
  EXPECT_EQ(refusal([&] { system.friction("f", "c", Slip::along, -1); }),
            "friction \"f\": coefficient = -1 is refused; allowed: a number >= 0");
  EXPECT_EQ(refusal([&] { system.friction("f", "d", Slip::along, 1); }),
            "friction \"f\": contact = \"d\" is refused; allowed: c");
  EXPECT_NE(refusal([&] { system.apply("one", Wrench{bad, none}); }), "");
  EXPECT_NE(refusal([&] { system.apply("one", WrenchFunction()); }), "");
  EXPECT_NE(refusal([&] { system.apply("world", Wrench{}); }), "");
  EXPECT_EQ(system.constraints.size(), 1u);
}

TEST(MultibodyRefusals, NameVelocitiesThatConstraintsDoNotAllow) {
  MultibodySystem system = two_bodies();
  system.ball("joint", "one", "two", {0.5, 0, 1}).ball("pivot", "world", "one", {0, 0, 1});
  const Twist away{{0.25, 0, 0}, {0, 0, 0}};
  EXPECT_EQ(refusal([&] {
              system.initial({{"one", away}});
            }),
            "the velocities given violate constraint pivot by 0.25, whatever those of the other bodies are; "
            "allowed: velocities that satisfy it");
  EXPECT_NE(refusal([&] { system.initial({{"two", {}}, {"two", {}}}); }), "");
  EXPECT_NE(refusal([&] { system.initial({{"three", {}}}); }), "");
  EXPECT_NE(refusal([&] { system.initial({{"world", {}}}); }), "");
  EXPECT_NE(refusal([&] { system.initial({{"one", {{nan, 0, 0}, {0, 0, 0}}}}); }), "");
  // What comes later, or is not there yet, has no say.
  MultibodySystem later = two_bodies();
  later.ball("joint", "one", "two", {0.5, 0, 1}, from(0));
  EXPECT_EQ(refusal([&] { later.initial({{"one", away}, {"two", {}}}); }), "");
}

TEST(MultibodyRefusals, AreThoseOfAnyModelForNames) {
  MultibodySystem system = two_bodies();
  system.ball("joint", "one", "two", {0.5, 0, 1}).ball("joint", "one", "two", {0.5, 0, 1});
  EXPECT_NE(refusal([&] { solve(system, system.initial(), 1); }).find("appears twice"), std::string::npos);
  EXPECT_NE(refusal([&] { solve(MultibodySystem(), MultibodySystem().initial(), 1); }), "");
}

TEST(MultibodyRefusals, NameEquationsThatAreNotItsOwn) {
  MultibodySystem system = two_bodies();
  system.equations = nullptr;
  EXPECT_EQ(refusal([&] {
              system.body("three", 1, {1, 1, 1}, Vector3d(0, 0, 0));
            }),
            "multibody system: its equations are not its own");
}

// A wheel that is not on the ground is not put there.
TEST(MultibodyRefusals, NameTheContactThatIsNotOne) {
  MultibodySystem system;
  system.body("wheel", 1, {1, 1, 1}, Vector3d(0, 0, 0.5)).rolling("tyre", "wheel", ContactShape::sphere(0.4));
  EXPECT_NE(refusal([&] { solve(system, system.initial(), 1); }).find("tyre"), std::string::npos);
}

TEST(MultibodyRefusals, NameTheSecondBodyOfAContact) {
  MultibodySystem system = two_bodies();
  const ContactShape sphere = ContactShape::sphere(0.1), disk = ContactShape::disk(0.1, {0, 1, 0});
  const Vector3d none(0, 0, 0), x(1, 0, 0), z(0, 0, 1);
  EXPECT_EQ(refusal([&] {
              system.contact("c", "one", sphere, 0, {none, z, "three"});
            }),
            "constraint \"c\": body = \"three\" is refused; allowed: world, one, two");
  const std::string twice =
      "constraint \"c\": \"one\" twice is refused; allowed: two bodies, or one and the world";
  EXPECT_EQ(refusal([&] { system.contact("c", "one", sphere, 0, {none, z, "one"}); }), twice);
  EXPECT_EQ(refusal([&] { system.rolling("c", "one", sphere, always(), {none, z, "one"}); }), twice);
  EXPECT_EQ(refusal([&] { system.blade("c", "one", none, x, always(), {none, z, "one"}); }), twice);
  EXPECT_EQ(refusal([&] { system.contact("c", "one", sphere, "one", sphere); }), twice);
  EXPECT_EQ(refusal([&] { system.contact("c", "one", sphere, "two", disk); }),
            "constraint \"c\": a disk on a body is refused; allowed: two spheres");
  EXPECT_EQ(refusal([&] { system.contact("c", "one", sphere, "two", ContactShape::sphere(-1)); }),
            "constraint \"c\": radius = -1 is refused; allowed: a number > 0");
  EXPECT_EQ(refusal([&] { system.contact("c", "one", sphere, "two", sphere, 2); }),
            "constraint \"c\": restitution = 2 is refused; allowed: 0 to 1");
  EXPECT_EQ(refusal([&] {
              system.contact("c", "one", sphere, "two", ContactShape::sphere(0.1, {0, 0, 1}));
            }),
            "constraint \"c\": distance of the centres = (0, 0, 0) is refused; allowed: a vector of a "
            "length > 0");
  system.point_mass("mass", 1, {0, 0, 3});
  EXPECT_EQ(refusal([&] {
              system.contact("c", "one", sphere, 0, {{0, 0, 3}, z, "mass"});
            }),
            "constraint \"c\": a part that acts on the rotation of point mass \"mass\" is refused; allowed: "
            "parts that act at its position, or a body() with moments of inertia");
  EXPECT_EQ(system.constraints.size(), 0u);
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::multibody_refusals_test
