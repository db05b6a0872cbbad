#include <chrono>
#include <functional>

#include "campaign.hpp"

namespace hybrid_sphere::fuzz {
namespace {

using Change = std::function<void(Case&)>;

/// Each makes a scene simpler, if it changes it at all.
std::vector<Change> changes_of(const Case& a_case) {
  std::vector<Change> changes;
  const auto on_scene = [&changes](auto change) {
    changes.emplace_back([change](Case& c) { change(c.scene); });
  };
  for (std::size_t i = a_case.scene.surface.regions.size(); i-- > 0;) {
    on_scene(
        [i](scene::Scene& s) { s.surface.regions.erase(s.surface.regions.begin() + static_cast<long>(i)); });
  }
  on_scene([](scene::Scene& s) { s.forces.drag = {}; });
  on_scene([](scene::Scene& s) { s.forces.drag.translational = 0; });
  on_scene([](scene::Scene& s) { s.forces.drag.rotational = 0; });
  on_scene([](scene::Scene& s) { s.forces.drag.quadratic = 0; });
  on_scene([](scene::Scene& s) { s.forces.spring = {}; });
  on_scene([](scene::Scene& s) { s.forces.wrench = {}; });
  on_scene([](scene::Scene& s) { s.forces.wrench.torque.setZero(); });
  on_scene([](scene::Scene& s) { s.forces.wrench.force.setZero(); });
  on_scene([](scene::Scene& s) { s.forces.gravity.head<2>().setZero(); });
  on_scene([](scene::Scene& s) { s.solver.method = scene::Solver::Method::automatic; });
  on_scene([](scene::Scene& s) { s.solver.accuracy = scene::Solver().accuracy; });
  on_scene([](scene::Scene& s) { s.solver.step = scene::Solver().step; });
  on_scene([](scene::Scene& s) { s.surface.livelock = scene::Livelock::slide; });
  on_scene([](scene::Scene& s) { s.initial_state.orientation.setIdentity(); });
  on_scene([](scene::Scene& s) { s.initial_state.angular_velocity.setZero(); });
  for (int i = 0; i < 3; ++i) on_scene([i](scene::Scene& s) { s.initial_state.angular_velocity[i] = 0; });
  for (int i = 0; i < 2; ++i) on_scene([i](scene::Scene& s) { s.initial_state.velocity[i] = 0; });
  for (int i = -1; i < static_cast<int>(a_case.scene.surface.regions.size()); ++i) {
    const auto on_material = [&on_scene, i](auto change) {
      on_scene([i, change](scene::Scene& s) {
        if (i < static_cast<int>(s.surface.regions.size()))
          change(i < 0 ? s.surface.base : s.surface.regions[static_cast<std::size_t>(i)].material);
      });
    };
    on_material([](scene::Material& m) { m = scene::Law::smooth; });
    on_material([](scene::Material& m) { m = scene::Law::rough; });
    on_material([](scene::Material& m) { m.belt.setZero(); });
    on_material([](scene::Material& m) { m.turntable_rate = 0; });
    on_material([](scene::Material& m) { m.rolling_resistance = 0; });
    on_material([](scene::Material& m) { m.spin_friction = 0; });
  }
  changes.emplace_back([](Case& c) { c.duration /= 2; });
  return changes;
}

}  // namespace

Case shrink(const Campaign& campaign, const Case& a_case, const std::string& claim) {
  Case smallest = a_case;
  // A scene that takes its whole limit of time each time is not made smaller for ever.
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  const auto goes_on = [end] { return std::chrono::steady_clock::now() < end; };
  for (bool progress = true; progress && goes_on();) {
    progress = false;
    for (const Change& change : changes_of(smallest)) {
      Case smaller = smallest;
      change(smaller);
      if (smaller.duration == smallest.duration && text_of(smaller) == text_of(smallest)) continue;
      if (!goes_on()) break;
      const Verdict verdict = judge_apart(campaign, smaller);
      if (verdict.kind != Verdict::Kind::found || verdict.claim != claim) continue;
      const bool renumbered = smaller.scene.surface.regions.size() != smallest.scene.surface.regions.size();
      smallest = smaller;
      progress = true;
      if (renumbered) break;
    }
  }
  return smallest;
}

}  // namespace hybrid_sphere::fuzz
