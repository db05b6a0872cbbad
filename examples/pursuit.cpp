// A boat drifts freely until, at t = 1, it sees a target that runs past; from then on it has to head at it: a
// constraint on velocities that depends on the time. While r is the vector from the boat to the target, u the
// speed of the boat and w the velocity of the target, u |r| + w.r falls at the rate u^2 - w^2.
//
//   rosrun hybrid_sphere pursuit
#include <cstdio>

#include "hybrid_sphere/mechanics/solve.hpp"
#include "hybrid_sphere/mechanics/system.hpp"

using namespace hybrid_sphere::mechanics;

int main() {
  const double m = 100, w = 1.5;  // mass [kg], speed of the target [m/s]
  const auto away = [](auto /*t*/, const auto& q) { return 20 - q[0]; };  // components of r [m]
  const auto along = [=](auto t, const auto& q) { return w * t - q[1]; };
  System<2> boat({"x", "y"},
                 [=](auto /*t*/, const auto& /*q*/, const auto& v) { return m / 2 * v.squaredNorm(); });
  boat.constrain(
      "heading", [=](auto t, const auto& q, const auto& v) { return along(t, q) * v[0] - away(t, q) * v[1]; },
      from(1));
  const Solution motion = solve(boat, {0, Eigen::Vector2d(0, 0), Eigen::Vector2d(2.5, -1)}, 10);

  for (const Switch& event : motion.switches()) {
    std::printf("t = %g: impulse (%.5f, %.5f) N s, energy %.5f -> %.5f J\n", event.time, event.impulse[0],
                event.impulse[1], event.energy_before, event.energy_after);
  }
  for (int i = 0; i <= 10; ++i) {
    const State s = motion.at(i);
    const double u = s.v.norm(), r = std::hypot(away(s.time, s.q), along(s.time, s.q));
    std::printf("t = %2d  stage %d  x = %8.5f  y = %8.5f  lambda = %8.5f  u r + w.r + (u^2 - w^2) t = %.5f\n",
                i, s.stage, s.q[0], s.q[1], s.multipliers[0],
                u * r + w * along(s.time, s.q) + (u * u - w * w) * s.time);
  }
  std::printf("%s at t = %g\n", to_string(motion.status().stop), motion.status().time);
}
