#include "hybrid_sphere/cli/survey.hpp"

namespace hybrid_sphere::cli {
namespace {

using scene::Law;
using scene::Material;

/// Path of a closed form, from the motion itself: begun with velocities that nothing is special about.
PathForm path_of(Stretch& stretch, Regime regime, const Material& material) {
  const Dynamics& dynamics = stretch.dynamics();
  PathForm form = PathForm::straight;
  // A slip along the force keeps its direction, one of the two does not.
  for (const Vector2d& w : {Vector2d(1, 0), Vector2d(0, 1)}) {
    const Vector2d position = material.turntable_center + Vector2d(1, 2);
    const Vector2d u = regime == Regime::free ? Vector2d(0, 0) : ground_velocity(material, position);
    const bool slips = regime == Regime::free || regime == Regime::sliding || regime == Regime::skidding;
    const Vector2d velocity = regime == Regime::carried ? u : Vector2d(u + w);
    const Vector2d sigma = slips ? Vector2d(u + w) : u;
    const Vector2d nu = velocity - sigma;
    const Vector3d omega(-nu.y() / dynamics.radius, nu.x() / dynamics.radius, material.turntable_rate + 1);
    stretch.begin(regime, material, {position, Quaterniond::Identity(), {velocity, omega}, sigma});
    if (stretch.uniform()) continue;
    const Curve curve = stretch.motion().curve();
    if (curve.form == CurveForm::general) return PathForm::general;
    if (curve.form == CurveForm::arc) return PathForm::arc;
    if (!curve.acceleration.isZero(0)) form = PathForm::parabola;
  }
  return form;
}

}  // namespace

Survey::Survey(const scene::Scene& scene)
    : dynamics(Sphere(scene.sphere), scene.forces), stretch_(dynamics, scene.solver) {
  add(scene.surface.base, scene::base_name);
  for (const scene::Region& region : scene.surface.regions) add(region.material, region.name);
  for (GroundKind& ground : grounds) find_motions(ground);
}

bool Survey::may_livelock() const {
  const auto holds = [](const Material& m) { return m.law == Law::rough || m.law == Law::rubber; };
  const auto count = std::count_if(grounds.begin(), grounds.end(),
                                   [&](const GroundKind& ground) { return holds(ground.material); });
  return (count > 1 && moves()) || (count > 0 && !dynamics.spin.isZero(0));
}

void Survey::add(const Material& material, const std::string& name) {
  const auto known = std::find_if(grounds.begin(), grounds.end(), [&](const GroundKind& ground) {
    return same_ground(ground.material, material);
  });
  if (known != grounds.end()) {
    known->names.push_back(name);
  } else {
    grounds.push_back({material, {name}, {}});
  }
}

void Survey::find_motions(GroundKind& ground) {
  for (const Regime regime : regimes_on(dynamics, ground.material)) {
    const double omega_3 = ground.material.turntable_rate + 1;  // nothing special
    const MotionKind kind = motion_kind(dynamics, regime, ground.material, omega_3);
    const bool has_curve = kind != MotionKind::integrated && kind != MotionKind::carriage;
    const PathForm path = has_curve ? path_of(stretch_, regime, ground.material) : PathForm::general;
    const bool ends = regime == Regime::sliding || regime == Regime::skidding ||
                      (regime == Regime::rolling && resists_rolling(dynamics, ground.material));
    ground.motions.push_back({regime, kind, path, ends});
    kinds_.insert(kind);
    paths_.insert(path);
  }
}

}  // namespace hybrid_sphere::cli
