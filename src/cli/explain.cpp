#include "cli/explain.hpp"

#include <algorithm>
#include <sstream>

#include "cli/scene_analysis.hpp"
#include "ground/ground.hpp"
#include "integration/integrator.hpp"
#include "simulation/check_method.hpp"
#include "simulation/segment.hpp"

namespace hybrid_sphere::cli {
namespace {

using scene::Law;
using scene::Material;

std::string plural(std::size_t n, const char* one, const char* many) {
  return std::to_string(n) + " " + (n == 1 ? one : many);
}

std::string bracketed(double x, double y) {
  std::ostringstream text;
  text << "[" << x << ", " << y << "]";
  return text.str();
}

std::string described(const Material& material) {
  std::ostringstream text;
  text << to_string(material.law);
  if (material.law == Law::coulomb) text << ", friction " << material.friction;
  if (material.rolling_resistance != 0) text << ", rolling resistance " << material.rolling_resistance;
  if (material.spin_friction != 0) text << ", spin friction " << material.spin_friction;
  if (!material.belt.isZero(0)) {
    text << ", belt " << bracketed(material.belt.x(), material.belt.y()) << " m/s";
  }
  if (material.turntable_rate != 0) {
    text << ", turntable " << material.turntable_rate << " rad/s about "
         << bracketed(material.turntable_center.x(), material.turntable_center.y()) << " m";
  }
  return text.str();
}

std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t shown = 6;
  std::string text;
  for (std::size_t i = 0; i < std::min(shown, names.size()); ++i) text += (i == 0 ? "" : ", ") + names[i];
  if (names.size() > shown) text += " and " + std::to_string(names.size() - shown) + " more";
  return text;
}

const char* words_of(ContactMode mode) {
  switch (mode) {
    case ContactMode::free: return "stage 1, free: ";
    case ContactMode::sliding: return "stage 1, sliding: ";
    case ContactMode::skidding: return "stage 1, sliding without turning: ";
    case ContactMode::rolling: return "stage 3, rolling: ";
    case ContactMode::sticking: return "stage 3, held by rolling resistance: ";
    case ContactMode::edge_sliding: break;
  }
  return "";
}

std::string words_of(const MotionOn& motion, const Dynamics& dynamics, const Material& material) {
  switch (motion.kind) {
    case MotionKind::uniform: return "both velocities are constant (a straight line)";
    case MotionKind::sticking: return "carried along by the ground, in closed form";
    case MotionKind::integrated:
      return std::string("integrated: no closed form for ") +
             to_string(obstacle_to_closed_form(dynamics, motion.mode, material));
    case MotionKind::linear:
    case MotionKind::straight:
    case MotionKind::dry_friction: break;
  }
  switch (motion.path) {
    case PathForm::straight: return "a straight line at constant velocity; the spin changes, in closed form";
    case PathForm::parabola: return "polynomials in time (a parabola)";
    case PathForm::arc: return "a circle at constant rate";
    case PathForm::general: break;
  }
  return motion.kind == MotionKind::linear ? "exponentials in time (phi functions)"
                                           : "dry friction in closed form (hodograph)";
}

/// Whether friction suffices for rolling, if that is the same everywhere.
std::string words_of_grip(const Dynamics& dynamics, const Material& material) {
  if (obstacle_to_dry_friction(dynamics, material) != Obstacle::none || resists_rolling(dynamics, material)) {
    return "; while |lambda| <= mu N";
  }
  const Vector2d still = Vector2d::Zero();
  const bool holds =
      contact_mode_on(dynamics, material, still, material.belt, still, still) == ContactMode::rolling;
  return holds ? "; |lambda| never exceeds mu N" : "; never: |lambda| would exceed mu N";
}

/// When a sphere stops sliding without turning, and whether it slides so at all.
std::string words_of_skid(const Dynamics& dynamics, const Material& material) {
  const std::string slip = material.friction > 0 ? "until the slip ends" : "forever";
  if (dynamics.spin.isZero(0)) {
    const bool holds = material.friction <= material.rolling_resistance;
    return holds ? "; " + slip : "; never: friction exceeds the resistance";
  }
  return "; " + slip + ", while the resistance holds";
}

void write_ground(const GroundKind& ground, const Dynamics& dynamics, std::ostream& text) {
  constexpr std::size_t width = 110;
  text << "    " << described(ground.material) << ": " << listed(ground.names) << '\n';
  for (const MotionOn& motion : ground.motions) {
    const std::string line = "      " + (words_of(motion.mode) + words_of(motion, dynamics, ground.material));
    std::string limits;
    if (motion.mode == ContactMode::sliding) limits = "; until the slip ends";
    if (motion.mode == ContactMode::skidding) limits = words_of_skid(dynamics, ground.material);
    if (motion.mode == ContactMode::rolling) {
      if (motion.ends_of_itself) limits = "; until it comes to rest";
      if (ground.material.law == Law::coulomb) limits += words_of_grip(dynamics, ground.material);
    }
    if (line.size() + limits.size() >= width) limits.replace(0, 1, ";\n       ");
    text << line << limits << ".\n";
  }
}

std::string shapes(const scene::Surface& surface) {
  std::size_t pieces[3] = {0, 0, 0};
  for (const scene::Region& region : surface.regions) ++pieces[region.shape.index()];
  return plural(surface.regions.size(), "region", "regions") + " (" +
         plural(pieces[0], "half-plane", "half-planes") + ", " + plural(pieces[1], "circle", "circles") +
         ", " + plural(pieces[2], "polygon", "polygons") + ") over the base";
}

/// Features in words: those that are present and those that are not.
class Features {
 public:
  void add(bool present, const std::string& words, const char* absent) {
    if (present) here_.push_back(words);
    if (!present) absent_.emplace_back(absent);
  }
  /// The words in lines that begin with two spaces.
  static std::string joined(const std::vector<std::string>& words, std::size_t column = 2) {
    constexpr std::size_t width = 108;
    std::string text;
    for (const std::string& word : words) {
      const bool breaks = column + word.size() > width;
      if (!text.empty()) text += breaks ? ",\n  " : ", ";
      column = (breaks ? 2 : column + 2) + word.size();
      text += word;
    }
    return text;
  }
  const std::vector<std::string>& here() const { return here_; }
  const std::vector<std::string>& absent() const { return absent_; }

 private:
  std::vector<std::string> here_;
  std::vector<std::string> absent_;
};

Features forces_of(const scene::Forces& forces) {
  Features features;
  const scene::Drag& drag = forces.drag;
  const Vector2d slope = forces.gravity.head<2>();
  features.add(!slope.isZero(0), "gravity along the ground " + bracketed(slope.x(), slope.y()) + " m/s^2",
               "a slope");
  features.add(!forces.wrench.force.isZero(0), "a constant force", "a constant force");
  features.add(!forces.wrench.torque.isZero(0), "a constant torque", "a torque");
  features.add(drag.translational != 0 || drag.rotational != 0, "linear drag", "linear drag");
  features.add(drag.quadratic != 0, "quadratic drag", "quadratic drag");
  features.add(forces.spring.stiffness != 0, "a spring", "a spring");
  return features;
}

std::string absent_features(const SceneAnalysis& analysis, const Features& forces) {
  Features features;
  for (const std::string& word : forces.absent()) features.add(false, "", word.c_str());
  features.add(analysis.any_law(Law::coulomb), "", "Coulomb friction");
  features.add(analysis.any_ground([](const Material& m) { return m.rolling_resistance != 0; }), "",
               "rolling resistance");
  features.add(analysis.any_ground([](const Material& m) { return m.spin_friction != 0; }), "",
               "spin friction");
  features.add(analysis.moves(), "", "moving ground");
  features.add(analysis.has_kind(MotionKind::integrated), "", "numerical integration");
  return Features::joined(features.absent());
}

void write_impulses(const scene::Scene& scene, const SceneAnalysis& analysis, std::ostream& text) {
  const bool rubber = analysis.any_law(Law::rubber);
  if (rubber || analysis.any_law(Law::rough)) {
    text << "  stage 2, the impulse where the no-slip constraint (21) is suddenly applied: P = -m kappa s "
            "(20), (22)"
         << (rubber ? ";\n    on rubber also the couple that stops the spin.\n" : ".\n");
  }
  if (!analysis.may_livelock()) return;
  text << "  livelocks, where grounds throw the sphere at each other endlessly: "
       << (scene.surface.livelock == scene::Livelock::slide
               ? "it slides along a straight edge\n    between two belts; elsewhere the computation halts.\n"
               : "the computation halts (surface.livelock: stop).\n");
}

void write_edges(const SceneAnalysis& analysis, bool indexed, std::ostream& text) {
  text << "Edges: found on the path itself; none is missed.\n";
  if (analysis.has_path(PathForm::straight)) {
    text << "  Straight paths: exact signs decide which edge comes first, and whether one is grazed or "
            "crossed.\n";
  }
  if (analysis.has_path(PathForm::parabola)) {
    text << "  Parabolas: a quadratic for each straight edge, a certified search for circles.\n";
  }
  if (analysis.has_path(PathForm::arc)) text << "  Circles: half-angle formulas for lines and circles.\n";
  if (analysis.has_path(PathForm::general)) {
    text << "  Other curves: a certified search, which bounds the acceleration and so misses no root.\n";
  }
  text << (indexed ? "  Only regions near the path are examined, using a spatial index.\n"
                   : "  Too few regions for a spatial index: a list of them.\n");
}

const char* describe(scene::Solver::Method method) {
  using Method = scene::Solver::Method;
  switch (method) {
    case Method::automatic:
    case Method::exact: break;
    case Method::euler: return "Euler's method";
    case Method::rk4: return "the classical Runge-Kutta method of order 4";
    case Method::lie_midpoint: return "the midpoint rule, on the rotation group by the exponential map";
    case Method::rkmk4: return "the Runge-Kutta-Munthe-Kaas method of order 4";
    case Method::cvode_adams: return "SUNDIALS' CVODE, Adams-Moulton of orders 1 to 12";
    case Method::cvode_bdf: return "SUNDIALS' CVODE, backward differentiation of orders 1 to 5";
    case Method::arkode_erk3: return "SUNDIALS' ARKODE, the Bogacki-Shampine method of order 3(2)";
    case Method::arkode_erk5: return "SUNDIALS' ARKODE, the Dormand-Prince method of order 5(4)";
    case Method::arkode_erk: return "SUNDIALS' ARKODE, the Prince-Dormand method of order 8(7)";
    case Method::dopri5: return "the Dormand-Prince method of order 5(4)";
    case Method::dopri87: return "the Prince-Dormand method of order 8(7)";
  }
  return "";
}

void write_numerical_method(const scene::Solver& solver, std::ostream& text) {
  text << "Method: " << to_string(solver.method) << ", as requested: " << describe(solver.method) << ".\n"
       << "  All motion is integrated, even where it has a closed form; switches are found and handled as "
          "usual.\n";
  if (solver.has_fixed_step()) {
    text << "  Fixed steps of " << solver.step
         << " s from the last switch on, without error control: the accuracy has no effect.\n";
  } else {
    text << "  An error estimate chooses the steps for a relative error of " << solver.accuracy
         << " at every output.\n";
  }
}

/// Error of closed forms, relative to the angle turned.
double orientation_error(const SceneAnalysis& analysis, double accuracy) {
  if (analysis.only(MotionKind::uniform)) return 2e-16;
  return std::max(1e-15, spin_accuracy(accuracy, true));
}

void write_method(const scene::Scene& scene, const SceneAnalysis& analysis, std::ostream& text) {
  if (!scene.solver.uses_closed_forms()) return write_numerical_method(scene.solver, text);
  const bool asked = scene.solver.method == scene::Solver::Method::exact;
  const bool integrates = analysis.has_kind(MotionKind::integrated);
  const scene::Solver::Method integrator = numeric::chosen_method(scene.solver);
  text << "Method: exact" << (integrates ? " where there is a closed form, else " : "")
       << (integrates ? to_string(integrator) : "") << (asked ? ", as requested" : ", chosen by auto")
       << ".\n"
       << "  Between two switches a motion is evaluated from the last switch, never from the previous "
          "output.\n"
          "  Closed forms err by rounding alone: a few 1e-16 of the distances covered, and "
       << orientation_error(analysis, scene.solver.accuracy)
       << " of the angle\n"
          "  turned in the orientation (--timing estimates it); the requested relative error is "
       << scene.solver.accuracy << " at every output.\n";
  if (integrates) {
    text << "  Integrated motions are kept within the requested error by " << describe(integrator)
         << ",\n"
            "  the cheapest of all methods for errors "
         << (integrator == scene::Solver::Method::dopri5 ? "of 1e-6 or more" : "below 1e-6")
         << " (measured in docs/speed_and_accuracy.md);\n"
            "  an error estimate chooses its steps, in a time variable in which dry friction is "
            "smooth.\n";
    if (numeric::turns_implicit(scene.solver)) {
      text << "  cvode_bdf takes over in a stiff segment, where drag alone keeps steps short.\n";
    }
  }
}

}  // namespace

std::string explain(const scene::Scene& scene, bool orientation) {
  const SceneAnalysis analysis(scene);
  const Features forces = forces_of(scene.forces);
  const bool has_friction = analysis.any_ground([](const Material& m) {
    return m.law == Law::coulomb || m.rolling_resistance != 0 || m.spin_friction != 0;
  });
  std::ostringstream text;
  text << "The scene requires\n  ground: " << shapes(scene.surface) << ", of "
       << plural(analysis.grounds.size(), "kind", "kinds") << ":\n";
  for (const GroundKind& ground : analysis.grounds) write_ground(ground, analysis.dynamics, text);
  write_impulses(scene, analysis, text);
  if (!forces.here().empty()) text << "  forces: " << Features::joined(forces.here(), 10) << ".\n";
  if (has_friction) text << "  the normal force: N = " << analysis.dynamics.normal_force << " N.\n";
  text << "It does not require, and simulate therefore omits:\n  " << absent_features(analysis, forces)
       << ".\n";
  if (!has_friction) text << "  The normal force has no effect.\n";
  if (!orientation) text << "  The orientation is not computed: neither --states nor --bag asks for it.\n";
  if (!analysis.any_ground([](const Material& m) { return m.law != Law::smooth; })) {
    text << "  All ground is smooth: no constraint, no impulse, no switch.\n";
  }
  if (!analysis.any_ground([](const Material& m) { return m.law == Law::smooth || m.law == Law::coulomb; })) {
    text << "  No ground lets the sphere slip: no stage 1.\n";
  }
  write_edges(analysis, !Ground(scene.surface).index().is_small(), text);
  write_method(scene, analysis, text);
  return text.str();
}

}  // namespace hybrid_sphere::cli
