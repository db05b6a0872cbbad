// Bounds on the second derivatives of the edges' equations, with which no root is missed, are never below
// the true ones.

#include "ground/edge_functions.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/motion/random_onsets.hpp"
#include "core/motion/random_steps.hpp"
#include "motion/dry_friction_motion.hpp"
#include "motion/edge_slide.hpp"
#include "motion/linear_motion.hpp"
#include "motion/straight_slide.hpp"

namespace hybrid_sphere::testing::edge_functions_test {
namespace {

struct Interval {
  double from;
  double until;
};

/// g' changes between two places within an interval by no more than its bound allows.
/// @param fastest  so far, which velocities are known relative to [m/s]
template <class Edge>
void expect_bound(const Edge& edge, Motion& motion, const Interval& interval, double fastest,
                  Sharpness& sharpness) {
  const double length = interval.until - interval.from;
  const double bound =
      edge.curvature(motion, motion.center(interval.from + 0.5 * length), interval.from, interval.until);
  double before = 0;
  for (int k = 0; k <= samples; ++k) {
    const PointState now = motion.center(interval.from + length * k / samples);
    const double slope = edge.jet(now).slope;
    const Vector2d gradient{edge.rate(now.position, {1, 0}), edge.rate(now.position, {0, 1})};
    const double noise = error * gradient.norm() * std::max(fastest, now.velocity.norm());
    if (k > 0) sharpness.hold(std::abs(slope - before), bound * length / samples, noise);
    before = slope;
  }
}

/// How close each kind of edge comes to its bound.
struct OfEdges {
  Sharpness circle, line;

  /// With random edges and a random interval before the end.
  void hold(RandomSegments& random, Motion& motion, double horizon) {
    const double fastest = motion.center(0).velocity.norm();
    const double from = horizon * random.part();
    const double until = from + (horizon - from) * random.part() * random.part();
    if (!(until > from)) return;
    const scene::Circle around{random.vector(random.size()), random.size()};
    expect_bound(CircleFunction(around), motion, {from, until}, fastest, circle);
    expect_bound(LineFunction(random.vector(random.size()), random.vector(random.size())), motion,
                 {from, until}, fastest, line);
  }
  void expect_above(double least) const {
    EXPECT_GT(circle.largest(), least);
    EXPECT_GT(line.largest(), least);
  }
};

constexpr int motions = 400;

TEST(EdgeFunctions, TheCurvatureOfAnEdgesEquationIsNeverBelowTheTrueOne) {
  RandomSegments random(11);
  OfEdges sharpness;
  for (int i = 0; i < motions; ++i) {
    SCOPED_TRACE(i);
    RandomSegment segment = random.next(numeric::EquationForm::rolling);
    segment.dynamics.quadratic_drag = 0;
    LinearMotion motion = LinearMotion::rolling(segment.dynamics, segment.ground, segment.position,
                                                segment.velocity, NormalSpin(0));
    sharpness.hold(random, motion, std::min(2 * random.size(), motion.last_time()));
    if (HasFatalFailure()) return;
  }
  sharpness.expect_above(0.9);
}

/// Without drag or spring, on ground that does not turn.
RandomSegment constant_forces(RandomSegments& random, numeric::EquationForm form) {
  RandomSegment segment = random.next(form);
  Dynamics& d = segment.dynamics;
  d.translational_drag = d.rotational_drag = d.quadratic_drag = d.spring_rate = 0;
  const Vector2d belt = segment.velocity - segment.slip - segment.nu;
  segment.ground.turntable_rate = 0;
  segment.ground.belt = form == numeric::EquationForm::resisted_rolling ? random.vector(random.some()) : belt;
  return segment;
}

DryFrictionMotion dry_motion(const RandomSegment& segment) {
  const Dynamics& d = segment.dynamics;
  const scene::Material& ground = segment.ground;
  const Vector2d& r = segment.position;
  const NormalSpin spin(0);
  if (segment.form == numeric::EquationForm::skidding) {
    return DryFrictionMotion::skidding(d, ground, r, segment.slip, spin);
  }
  if (segment.form == numeric::EquationForm::resisted_rolling) {
    return DryFrictionMotion::rolling(d, ground, r, segment.velocity - ground.belt, spin);
  }
  const Vector2d p_c = segment.velocity - d.kappa * (segment.slip + ground.belt);
  return DryFrictionMotion::sliding(d, ground, r, p_c, segment.slip, spin);
}

TEST(EdgeFunctions, TheCurvatureOfAnEdgesEquationIsNeverBelowTheTrueOneUnderDryFriction) {
  using numeric::EquationForm;
  for (const EquationForm form :
       {EquationForm::sliding, EquationForm::skidding, EquationForm::resisted_rolling}) {
    RandomSegments random(12);
    OfEdges sharpness;
    for (int i = 0; i < motions; ++i) {
      SCOPED_TRACE(i);
      const RandomSegment segment = constant_forces(random, form);
      DryFrictionMotion motion = dry_motion(segment);
      sharpness.hold(random, motion, std::min(2 * random.size(), motion.end()));
      if (HasFatalFailure()) return;
    }
    sharpness.expect_above(0.95);
  }
}

TEST(EdgeFunctions, TheCurvatureOfAnEdgesEquationIsNeverBelowTheTrueOneOfStraightSlides) {
  RandomSegments random(13);
  OfEdges sharpness;
  int slides = 0;
  for (int i = 0; i < motions; ++i) {
    SCOPED_TRACE(i);
    RandomSegment segment = constant_forces(random, numeric::EquationForm::resisted_sliding);
    lay_on_a_line(segment);
    std::optional<StraightSlide> motion = StraightSlide::from(
        segment.dynamics, segment.ground, segment.position, segment.slip, segment.nu, NormalSpin(0));
    if (!motion) continue;
    ++slides;
    sharpness.hold(random, *motion, std::min(2 * random.size(), motion->end()));
    if (HasFatalFailure()) return;
  }
  EXPECT_EQ(slides, motions);
  sharpness.expect_above(0.95);
}

TEST(EdgeFunctions, TheCurvatureOfAnEdgesEquationIsNeverBelowTheTrueOneAlongAnEdge) {
  RandomSegments random(14);
  OfEdges sharpness;
  for (int i = 0; i < motions; ++i) {
    SCOPED_TRACE(i);
    const RandomSegment segment = constant_forces(random, numeric::EquationForm::rolling);
    const Vector2d normal = random.vector(1);
    const Vector2d along = turned(normal);
    const Vector2d first = random.size() * along - random.size() * normal;
    const Vector2d second = random.size() * along + random.size() * normal;
    EdgeSlide motion(segment.dynamics, first, second, normal, segment.position, random.size() * along,
                     NormalSpin(0));
    sharpness.hold(random, motion, std::min(2 * random.size(), motion.end()));
    if (HasFatalFailure()) return;
  }
  sharpness.expect_above(0.95);
}

TEST(EdgeFunctions, TheCurvatureOfAnEdgesEquationIsNeverBelowTheTrueOneOfIntegratedMotions) {
  for (const numeric::EquationForm form : forms) {
    RandomSegments random(15);
    OfEdges sharpness;
    for (int i = 0; i < motions / 2; ++i) {  // the draws depend on the compiler
      SCOPED_TRACE(i);
      const RandomSegment segment = random.next(form);
      NumericMotion motion(segment.dynamics, fine);
      begin(motion, segment);
      sharpness.hold(random, motion, std::min(motion.end_before(1), 1.0));
      if (HasFatalFailure()) return;
    }
    sharpness.expect_above(0.95);
  }
}

// t^2/2 + b t + c, c within 1e-16 of 0: a root of what this may stand for is within sqrt(2e-16) of 0.
TEST(EdgeFunctions, TheRootsOfAQuadraticAreKnownFromItsBendWhereItHasNoSlope) {
  for (double slope = 1; slope > 1e-60; slope *= 1e-3) {
    const LineFunction::Quadratic g{{0, 1e-16}, {slope, slope * 1e-16}, {1, 1e-16}};
    geometry::Root roots[2];
    const int count = g.solve(roots);
    ASSERT_EQ(count, 2);
    for (const geometry::Root& root : roots) {
      EXPECT_LE(root.error, 1e-7 + 1e-15 * slope) << slope;
      const double off = root.time + std::copysign(root.error, root.time);
      EXPECT_GE(std::abs(off * (slope + 0.5 * off)), 0.99e-16) << slope;  // to first order
    }
  }
}

}  // namespace
}  // namespace hybrid_sphere::testing::edge_functions_test
