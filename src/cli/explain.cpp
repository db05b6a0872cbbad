#include "hybrid_sphere/cli/explain.hpp"

#include <algorithm>
#include <sstream>

namespace hybrid_sphere::cli {
namespace {

using scene::Law;

std::string plural(std::size_t n, const char* one, const char* many) {
  return std::to_string(n) + " " + (n == 1 ? one : many);
}

bool has_law(const scene::Surface& surface, Law law) {
  return surface.base == law || std::any_of(surface.regions.begin(), surface.regions.end(),
                                            [law](const scene::Region& region) { return region.law == law; });
}

std::string regions(const scene::Surface& surface) {
  std::size_t rough = 0;
  std::size_t pieces[3] = {0, 0, 0};
  for (const scene::Region& region : surface.regions) {
    rough += region.law == Law::rough ? 1 : 0;
    ++pieces[region.shape.index()];
  }
  return plural(surface.regions.size(), "region", "regions") + " (" + std::to_string(rough) + " rough; " +
         plural(pieces[0], "half-plane", "half-planes") + ", " + plural(pieces[1], "circle", "circles") +
         ", " + plural(pieces[2], "polygon", "polygons") + ") over a " + to_string(surface.base) + " base";
}

}  // namespace

std::string explain(const scene::Scene& scene) {
  const bool smooth = has_law(scene.surface, Law::smooth);
  const bool rough = has_law(scene.surface, Law::rough);
  std::ostringstream text;
  text << "The scene requires\n";
  text << "  ground: " << regions(scene.surface) << ", all of it at rest.\n";
  if (smooth) {
    text << "  stage 1, holonomic, on smooth ground: no tangential force, so both velocities are constant "
            "(18).\n";
  }
  if (rough) {
    text << "  stage 2, the impulse where the no-slip constraint (21) is suddenly applied: P = -m kappa s "
            "(20), (22).\n"
            "  stage 3, nonholonomic, on rough ground: the multipliers vanish (26), so both velocities are "
            "constant.\n";
  }
  text << "It does not require, and so nothing of this is computed:\n"
          "  forces in the plane, torques, drag, friction with a coefficient, resistance to rolling or "
          "spinning, moving\n"
          "  ground, a right-hand side, an integrator, a step size. Gravity only holds the sphere on the "
          "plane.\n";
  if (!rough) text << "  No ground is rough: no constraint, no impulse, no switch.\n";
  if (!smooth)
    text << "  No ground is smooth: after the impulse at the start, if there is one, nothing switches.\n";
  text << "Method: exact"
       << (scene.solver.method == scene::Solver::Method::automatic ? ", taken by auto" : ", as asked for")
       << ".\n"
          "  Between two switches the closed form is evaluated from the last switch: a straight line, and "
          "the exponential\n"
          "  map for the orientation. Edges are found by solving for the instant at which the path meets "
          "them; which edge\n"
          "  comes first, and whether a path grazes or enters, is decided by exact signs.\n"
          "  The error is that of rounding: a few 1e-16 of the distances covered, and 2e-16 of the angle "
          "turned in the\n"
          "  orientation (--timing estimates it); asked for is a relative error of "
       << scene.solver.accuracy << " at every output.\n";
  return text.str();
}

}  // namespace hybrid_sphere::cli
