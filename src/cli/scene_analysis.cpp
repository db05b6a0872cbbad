#include "cli/scene_analysis.hpp"

namespace hybrid_sphere::cli {
namespace {

using scene::Law;
using scene::Material;

/// Path of a closed form, from the motion itself: begun with velocities that nothing is special about.
PathForm path_of(Segment& segment, ContactMode mode, const Material& material) {
  const Dynamics& dynamics = segment.dynamics();
  PathForm form = PathForm::straight;
  // A slip along the force keeps its direction, one of the two does not.
  for (const Vector2d& w : {Vector2d(1, 0), Vector2d(0, 1)}) {
    const Vector2d position = material.turntable_center + Vector2d(1, 2);
    const Vector2d u = mode == ContactMode::free ? Vector2d(0, 0) : ground_velocity(material, position);
    const bool slips =
        mode == ContactMode::free || mode == ContactMode::sliding || mode == ContactMode::skidding;
    const Vector2d velocity = mode == ContactMode::sticking ? u : Vector2d(u + w);
    const Vector2d sigma = slips ? Vector2d(u + w) : u;
    const Vector2d nu = velocity - sigma;
    const Vector3d omega(-nu.y() / dynamics.radius, nu.x() / dynamics.radius, material.turntable_rate + 1);
    segment.begin(mode, material, {position, Quaterniond::Identity(), {velocity, omega}, sigma});
    if (segment.uniform()) continue;
    const Curve curve = segment.motion().curve();
    if (curve.form == CurveForm::general) return PathForm::general;
    if (curve.form == CurveForm::arc) return PathForm::arc;
    if (!curve.acceleration.isZero(0)) form = PathForm::parabola;
  }
  return form;
}

}  // namespace

SceneAnalysis::SceneAnalysis(const scene::Scene& scene)
    : dynamics(Sphere(scene.sphere), scene.forces), segment_(dynamics, scene.solver) {
  add(scene.surface.base, scene::base_name);
  for (const scene::Region& region : scene.surface.regions) add(region.material, region.name);
  for (GroundKind& ground : grounds) find_motions(ground);
}

bool SceneAnalysis::may_livelock() const {
  const auto holds = [](const Material& m) { return m.law == Law::rough || m.law == Law::rubber; };
  const auto count = std::count_if(grounds.begin(), grounds.end(),
                                   [&](const GroundKind& ground) { return holds(ground.material); });
  return (count > 1 && moves()) || (count > 0 && !dynamics.spin.isZero(0));
}

void SceneAnalysis::add(const Material& material, const std::string& name) {
  const auto known = std::find_if(grounds.begin(), grounds.end(), [&](const GroundKind& ground) {
    return same_ground(ground.material, material);
  });
  if (known != grounds.end()) {
    known->names.push_back(name);
  } else {
    grounds.push_back({material, {name}, {}});
  }
}

void SceneAnalysis::find_motions(GroundKind& ground) {
  for (const ContactMode mode : contact_modes_on(dynamics, ground.material)) {
    const double omega_3 = ground.material.turntable_rate + 1;  // nothing special
    const MotionKind kind = motion_kind(dynamics, mode, ground.material, omega_3);
    const bool has_curve = kind != MotionKind::integrated && kind != MotionKind::sticking;
    const PathForm path = has_curve ? path_of(segment_, mode, ground.material) : PathForm::general;
    const bool ends = mode == ContactMode::sliding || mode == ContactMode::skidding ||
                      (mode == ContactMode::rolling && resists_rolling(dynamics, ground.material));
    ground.motions.push_back({mode, kind, path, ends});
    kinds_.insert(kind);
    paths_.insert(path);
  }
}

}  // namespace hybrid_sphere::cli
