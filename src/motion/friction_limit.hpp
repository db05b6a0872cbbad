#pragma once

#include "geometry/certified_root.hpp"
#include "motion/slip_onset.hpp"
#include "motion/speed_bound.hpp"

namespace hybrid_sphere::numeric {

/// The friction limit of a sphere that rolls on ground with dry friction: the reaction lambda = m (v' - f) is
/// not larger than mu N, that is, G(x) = A_s^2 - abs(lambda)^2/(m kappa)^2 >= 0 with A_s =
/// Dynamics::slip_decay(mu). With B_s = f - g - W J v and the rolling resistance A e (e = nu/abs(nu)),
/// lambda/(m kappa) = -(B_s + A e/kappa). Of a sphere that skids it is the couple that keeps it from turning
/// and is not larger than rho N: G = a^2 - abs(c)^2 (1 - kappa)^2/(m kappa)^2, c (1 - kappa)/(m kappa) = g +
/// (1 - kappa)/kappa A s/abs(s), with a = Dynamics::spinning_decay(rho). Source: docs/theory.md 4.5, 4.6.
class FrictionLimit {
 public:
  /// @param equations    of the form rolling, resisted_rolling or skidding; not modified
  /// @param coefficient  mu, or rho for a skidding sphere
  FrictionLimit(const Equations& equations, double coefficient);

  /// Raises the limit by a part of 2^-30: where rounding has told two modes of each other twice at one
  /// instant.
  void loosen() { limit_ *= 1 + 0x1p-30; }

  /// G and its derivative by x at a state.
  geometry::Jet along_trajectory(const State& y) const;
  /// Bound on abs(d^2 G/dx^2) from the state y over a length x, in which the time grows by `duration`.
  double curvature(const State& y, double x, double duration) const;

  /// The same on an onset from nu = 0, where x is the time.
  geometry::Jet along_onset(const SlipOnset& onset, double tau) const;
  double curvature(const SlipOnset& onset) const;

 private:
  /// Bounds for an interval of x.
  struct IntervalBounds {
    double length;        // of the interval
    double turning;       // abs(de/dx)
    double turning_bend;  // abs(d^2e/dx^2)
    double pace;          // dtau/dx
    double pace_rate;     // abs(d^2tau/dx^2)
  };

  /// Of e in what is limited [m/s^2].
  double share() const;
  double noise(double size) const;
  Vector2d pull(const Instant& now, const Vector2d& e) const;
  geometry::Jet jet(const State& y, const Vector2d& e, const Vector2d& turning, double pace) const;
  double bend(const State& y, const SpeedBound& bound, const ForcingBound& forcing,
              const IntervalBounds& bounds) const;
  /// The same where w = v, by what is known besides there.
  double held_bend(const State& y, double duration, SpeedBound bound, IntervalBounds bounds) const;

  const Equations* equations_;
  bool of_couple_;
  double limit_;
};

/// Bound on abs(de/dx) over a length x of a direction e that a drive F turns, de/dx = (F.J e) J e, as it
/// turns the velocity of what rolls against a resistance. Source: docs/theory.md 4.5.
/// @param drive  F where x = 0
/// @param e      the unit vector there
/// @param most   bound on abs(F)
/// @param drift  bound on abs(dF/dx)
double turning_bound(const Vector2d& drive, const Vector2d& e, double most, double drift, double x);

/// First x in [0, length] at which a margin that was not negative becomes negative; `never` if there is none.
/// @param margin     x -> Jet
/// @param curvature  (from, until) -> bound on the second derivative between the two
template <class Margin, class Curvature>
double first_loss(const Margin& margin, const Curvature& curvature, double length) {
  constexpr std::size_t max_samples = 4096;
  constexpr double flat = 0x1p-20;  // of the length
  const geometry::Jet start = margin(0.0);
  if (start.value < -start.noise) return 0;
  std::size_t samples = 0;
  const auto sample = [&](double x) {
    ++samples;
    return margin(x);
  };
  // A bound that does not know that a margin stays 0 would halve the interval endlessly: there the curvature
  // is taken from the observed slopes.
  const auto bend = [&](double low, double high) {
    const double bound = curvature(low, high);
    if (samples < max_samples) return bound;
    const double middle = low + 0.5 * (high - low);
    const double slope = margin(middle).slope;
    const double change = std::max(std::abs(margin(high).slope - slope), std::abs(slope - margin(low).slope));
    return std::min(bound, 16 * change / (high - middle));
  };
  double loss = never;
  geometry::certified_roots(sample, bend, 0.0, length, [&](const geometry::Root& root) {
    const auto is_negative = [&](double x) {
      const geometry::Jet there = margin(x);
      return there.value < -there.noise;
    };
    // At a flat root the slope says nothing, but what follows beyond its error does.
    const bool is_lost =
        root.error > flat * length
            ? is_negative(length) || is_negative(std::min(length, root.time + 2 * root.error))
            : margin(root.time).slope < 0;
    if (!is_lost) return true;  // only touches zero, or returns from it
    loss = root.time;
    return false;
  });
  return loss;
}

}  // namespace hybrid_sphere::numeric
