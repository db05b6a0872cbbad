#pragma once

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "simulation/segment.hpp"

namespace hybrid_sphere::cli {

/// Curves on which edges are found in one way.
enum class PathForm { straight, parabola, arc, general };

/// Motions of one kind of ground.
struct MotionOn {
  ContactMode mode;
  MotionKind kind;
  PathForm path;
  bool ends_of_itself;
};

/// Grounds that differ in nothing but their place.
struct GroundKind {
  scene::Material material;
  std::vector<std::string> names;
  std::vector<MotionOn> motions;
};

/// What the program does with a scene: every kind of ground in it, and every motion on each.
class SceneAnalysis {
 public:
  explicit SceneAnalysis(const scene::Scene& scene);

  template <class Property>
  bool any_ground(const Property& property) const {
    return std::any_of(grounds.begin(), grounds.end(),
                       [&](const GroundKind& ground) { return property(ground.material); });
  }

  bool any_law(scene::Law law) const {
    return any_ground([law](const scene::Material& material) { return material.law == law; });
  }

  bool moves() const {
    return any_ground([](const scene::Material& m) { return !m.belt.isZero(0) || m.turntable_rate != 0; });
  }

  /// It takes two grounds that stop the slip at once and do not move alike, or a torque.
  bool may_livelock() const;

  bool has_kind(MotionKind kind) const { return kinds_.count(kind) != 0; }
  bool only(MotionKind kind) const { return kinds_.size() == 1 && has_kind(kind); }
  bool has_path(PathForm path) const { return paths_.count(path) != 0; }

  Dynamics dynamics;
  std::vector<GroundKind> grounds;

 private:
  void add(const scene::Material& material, const std::string& name);
  void find_motions(GroundKind& ground);

  Segment segment_;
  std::set<MotionKind> kinds_;
  std::set<PathForm> paths_;
};

}  // namespace hybrid_sphere::cli
