#include "own_integrator.hpp"

#include <algorithm>
#include <cmath>

#include "own_ground.hpp"

namespace hybrid_sphere::fuzz::own {
namespace {

// Throws back that take less of a run are left out: so those that accumulate come to an end.
constexpr Real shortest_throw = 1e-11L;
constexpr int max_steps = 150000;
constexpr std::size_t max_switches = 2000;

Vec2 wide(const Vector2d& v) { return v.cast<Real>(); }

/// The constraint on the velocities, as a switch reports its changes.
struct Constraint {
  int kind = 0;  // none, no slip, no slip and no spin
  Vector2d belt = Vector2d::Zero();
  double rate = 0;
  Vector2d center = Vector2d::Zero();
  bool operator!=(const Constraint& o) const {
    return kind != o.kind || belt != o.belt || rate != o.rate || center != o.center;
  }
};

Constraint constraint_of(const scene::Material& material, const Hold& hold) {
  if (!hold.slip) return {};
  const bool turns = material.turntable_rate != 0;
  return {material.law == scene::Law::rubber ? 2 : 1, material.belt, material.turntable_rate,
          turns ? material.turntable_center : Vector2d(Vector2d::Zero())};
}

class Run {
 public:
  Run(const scene::Scene& scene, Real span, Real shorter)
      : scene_(scene), mechanics_(scene.sphere, scene.forces), span_(span), shorter_(shorter) {
    const scene::InitialState& start = scene.initial_state;
    body_ = {wide(start.position), wide(start.velocity), start.angular_velocity.cast<Real>(),
             start.orientation.coeffs().cast<Real>()};
    edges_ = edges_of(scene.surface);
    size_ = body_.r.norm();
    for (const Edge& edge : edges_) size_ = std::max(size_, edge.point.norm() + edge.radius);
    speed_ = start.velocity.norm() + scene.sphere.radius * start.angular_velocity.norm();
    see_speed(scene.surface.base);
    for (const scene::Region& region : scene.surface.regions) see_speed(region.material);
    h_ = span_ / 1e5L;
  }

  OwnRun to(const std::vector<double>& times) {
    find_start();
    for (const double time : times) {
      while (gave_up_.empty() && time_ < time) advance(time);
      if (!gave_up_.empty()) break;
      result_.states.push_back({body_, name(region_)});
    }
    result_.gave_up = gave_up_;
    result_.speed = speed_;
    return std::move(result_);
  }

 private:
  void see_speed(const scene::Material& material) {
    speed_ = std::max(speed_, Real(material.belt.norm() +
                                   std::abs(material.turntable_rate) *
                                       ((material.turntable_center).norm() + static_cast<double>(size_))));
  }

  std::string name(int region) const {
    return region == base ? scene::base_name : scene_.surface.regions[static_cast<std::size_t>(region)].name;
  }
  const scene::Material& material(int region) const {
    return region == base ? scene_.surface.base
                          : scene_.surface.regions[static_cast<std::size_t>(region)].material;
  }

  bool is_visible(const Vec2& r, int region, int& top) const {
    return own::is_visible(scene_.surface, r, region, 4e-18L * (size_ + r.norm()), top);
  }

  void find_start() {
    // The side that a force bends a path to which begins along an edge is another question.
    const auto is_bent = [this](const Edge& edge) {
      if (std::abs(edge.at(body_.r)) > 1e-15L * size_) return false;
      const Vec2 normal = edge.radius > 0 ? Vec2((body_.r - edge.point) / edge.radius) : edge.normal;
      const Real across = std::abs(normal.dot(body_.v));
      const bool along = across <= 1e-12L * body_.v.norm();
      if (!along && across <= 0.02L * size_ / span_) return true;  // what is looked at ahead is on the edge
      const bool is_rounded = across > 1e-18L * body_.v.norm();  // the direction of the edge but for rounding
      return along &&
             (is_rounded || edge.radius > 0 || body_.v.isZero(0) || normal.dot(mechanics_.force(body_)) != 0);
    };
    if (std::any_of(edges_.begin(), edges_.end(), is_bent)) {
      gave_up_ = "begins along an edge, or at rest on it";
      return;
    }
    const auto is_rounded = [this](const Edge& edge) {
      const Real off = std::abs(edge.at(body_.r));
      return off > 4e-18L * size_ && off <= 1e-15L * size_;
    };
    if (std::any_of(edges_.begin(), edges_.end(), is_rounded)) {
      gave_up_ = "begins so near an edge that only rounding keeps it off";
      return;
    }
    int top = base;
    is_visible(body_.r + 1e-15L * span_ * body_.v, no_region, top);
    change_ground(top);
    h_ = 1e-6L * span_;
  }

  void report() {
    const Constraint now = constraint_of(mechanics_.ground(), hold_);
    if (now != constraint_) result_.switches.push_back({time_, name(region_)});
    constraint_ = now;
    if (result_.switches.size() > max_switches) gave_up_ = "too many switches";
  }

  void change_ground(int region) {
    region_ = region;
    mechanics_.stand_on(material(region));
    if (mechanics_.is_ideal()) mechanics_.strike(body_);
    resolve_contact();
    report();
    if (bends_off_edge()) return;
    // What is thrown to and fro within one instant is looked at after a longer time.
    h_ = 1e-8L * span_ * std::pow(2.0L, crowd_);
    creep_ = 0;
    slow_steps_ = 0;
  }

  /// A path that begins along an edge and is bent away from the region at once never runs in it.
  bool bends_off_edge() {
    const auto runs_along = [this](const Edge& edge) {
      return std::abs(edge.at(body_.r)) <= 1e-15L * size_ &&
             std::abs(edge.rate(body_)) <= 1e-12L * body_.v.norm();
    };
    if (std::none_of(edges_.begin(), edges_.end(), runs_along)) return false;
    int top = base;
    if (is_visible(mechanics_.step(body_, hold_, 1e-6L * span_).r, region_, top)) return false;
    if (++crowd_ > 12) {
      gave_up_ = "livelock";
    } else {
      change_ground(top);
    }
    return true;
  }

  void resolve_contact() {
    const Real none = 1e-13L * (speed_ + body_.v.norm());
    const Hold may{mechanics_.is_ideal() || mechanics_.slip(body_).norm() <= none,
                   mechanics_.nu(body_).norm() <= none,
                   std::abs(body_.w.z() - mechanics_.ground().turntable_rate) * scene_.sphere.radius <= none};
    take(may);
  }

  void take(const Hold& may) {
    hold_ = mechanics_.decide(body_, may);
    if ((may.slip && !hold_.slip) || (may.roll && !hold_.roll)) released_ = time_;
  }

  void advance(Real until) {
    if (++steps_ > max_steps) {
      gave_up_ = "too many steps";
      return;
    }
    const Real room = until - time_;
    const Real left = mechanics_.time_left(body_, hold_);
    const Real delta = 1e-6L * span_ / shorter_;
    // A velocity that dies does so within some hundred steps; one that stays small wants implicit ones.
    slow_steps_ = left < 10 * delta ? slow_steps_ + 1 : 0;
    if (left < 1e-12L * span_ || slow_steps_ > 300) {
      creep(room, delta);
      return;
    }
    // What ceases to be held only for a moment does not within a long step.
    const Real longest = mechanics_.hardly_holds(body_, hold_) ? span_ / 5e4L : span_ / 200;
    const Real h = std::min({h_, room, longest / shorter_, left / 8 / shorter_});
    const Body whole = mechanics_.step(body_, hold_, h);
    Body halves = mechanics_.step(mechanics_.step(body_, hold_, h / 2), hold_, h / 2);
    speed_ = std::max(speed_, halves.v.norm() + Real(scene_.sphere.radius) * halves.w.norm());
    // The orientation follows from the rest, and may be less accurate.
    const Real error = ((whole.v - halves.v).norm() + scene_.sphere.radius * (whole.w - halves.w).norm()) /
                           (speed_ + 1e-300L) +
                       (whole.r - halves.r).norm() / (speed_ * span_ + 1e-300L) +
                       0.01L * (whole.q - halves.q).norm();
    const Real allowed = 1e-13L / (shorter_ * shorter_ * shorter_ * shorter_ * shorter_);
    const Real factor = std::clamp(0.9L * std::pow(allowed / (error + 1e-30L), 0.2L), 0.2L, 2.0L);
    if (error > 4 * allowed && h > 1e-12L * span_) {
      h_ = h * factor;
      return;
    }
    h_ = h * factor;
    // Of order 5, by Richardson.
    halves.r += (halves.r - whole.r) / 15;
    halves.v += (halves.v - whole.v) / 15;
    halves.w += (halves.w - whole.w) / 15;
    halves.q = (halves.q + (halves.q - whole.q) / 15).normalized();
    accept(h, halves);
  }

  /// Two implicit steps, extrapolated to order 2 with one over both as long as the same sticks.
  struct Crept {
    Body body;
    Hold hold;
    bool same = false;
    Real error = 0;
  };
  /// Whether a velocity that friction acts against has passed through 0.
  bool reverses(const Body& next) const {
    return mechanics_.slip(body_).dot(mechanics_.slip(next)) < 0 ||
           mechanics_.nu(body_).dot(mechanics_.nu(next)) < 0;
  }
  Crept crept(Real h) const {
    Crept result;
    Hold over_both = hold_;
    Hold first = hold_;
    // What has just ceased to be held grows by less than rounding at first.
    const Real none = time_ - released_ < 1e-6L * span_ ? 1e-15L * speed_ : -1;
    const Body whole = mechanics_.implicit_step(body_, h, none, over_both);
    const Body half = mechanics_.implicit_step(body_, h / 2, none, first);
    result.hold = first;
    Body& to = result.body;
    to = mechanics_.implicit_step(half, h / 2, none, result.hold);
    result.same = over_both.same_as(hold_) && first.same_as(hold_) && result.hold.same_as(hold_) &&
                  !reverses(half) && !reverses(to);
    result.error = (to.v - whole.v).norm() + scene_.sphere.radius * (to.w - whole.w).norm();
    if (!result.same) return result;
    to.r += to.r - whole.r;
    to.v += to.v - whole.v;
    to.w += to.w - whole.w;
    to.q = (2 * to.q - whole.q).normalized();
    return result;
  }

  /// What comes to stick, or ceases to, does so in a step that is too short to matter.
  void creep(Real room, Real longest) {
    const Real shortest = 1e-13L * span_;
    const Real allowed = 1e-11L * speed_ / (shorter_ * shorter_);
    Real h = std::min({std::max(creep_, shortest), longest, room});
    Crept step = crept(h);
    while (h > shortest && (!step.same || step.error > allowed)) {
      h = std::max(h / 4, shortest);
      step = crept(h);
    }
    creep_ = 2 * h;
    const bool passes = mechanics_.spin_has_passed(step.body, hold_);
    const auto at = [&](Real t) { return crept(t).body; };
    Real tau = h;
    if (passes) tau = bisect(h, [&](Real t) { return mechanics_.spin_has_passed(at(t), hold_); });
    if (passes) step = crept(tau);
    if (leaves_region(tau, step.body, tau, at)) return;
    go(tau, step.body);
    const Hold before = hold_;
    hold_ = step.hold;
    const bool sticks = (hold_.slip && !before.slip) || (hold_.roll && !before.roll);
    if (passes) stop_spin();
    // A velocity that has come to 0 may pass through it.
    if (sticks) resolve_after_change();
    report();
  }

  /// At the instant at which the spin has come to that of the ground.
  void stop_spin() {
    body_.w.z() = mechanics_.ground().turntable_rate;
    const Hold now = mechanics_.decide(body_, {false, false, true});
    hold_.spin = now.spin;
    hold_.spin_sign = now.spin_sign;
  }

  void go(Real h, const Body& next) {
    result_.way += (next.r - body_.r).norm();
    body_ = next;
    time_ += h;
  }

  void accept(Real h, const Body& next) {
    const auto at = [&](Real t) { return mechanics_.step(body_, hold_, t); };
    // What holds may cease to within the step; the spin may come to that of the ground.
    Real tau = h;
    const auto changed = [&](const Body& b) {
      return mechanics_.spin_has_passed(b, hold_) || !mechanics_.can_hold(b, hold_);
    };
    const bool changes = changed(next);
    if (changes) tau = bisect(h, [&](Real t) { return changed(at(t)); });
    const Body end = changes ? at(tau) : next;
    if (leaves_region(tau, end, tau, at)) return;
    go(tau, end);
    if (!changes) return;
    if (mechanics_.spin_has_passed(body_, hold_)) stop_spin();
    resolve_after_change();
    report();
    h_ = span_ / 1e6L;
    creep_ = 0;
  }

  // What was held has velocity 0; it alone may stick on.
  void resolve_after_change() {
    const Real none = 1e-13L * speed_;
    const Hold may{
        hold_.slip, hold_.roll,
        hold_.spin ||
            std::abs(body_.w.z() - mechanics_.ground().turntable_rate) * scene_.sphere.radius <= none};
    take(may);
  }

  template <class Is>
  static Real bisect(Real high, const Is& is) {
    Real low = 0;
    for (int i = 0; i < 70 && low < high; ++i) {
      const Real middle = (low + high) / 2;
      if (middle <= low || middle >= high) break;
      (is(middle) ? high : low) = middle;
    }
    return high;
  }

  /// Instants of a step at which it crosses an edge: one where the ends are on different sides, two where it
  /// comes near and goes away again and is on the other side in between.
  template <class At>
  void add_roots(const Edge& edge, Real h, const Body& end, const At& at, std::vector<Real>& roots) const {
    const Real slack = 4e-18L * (size_ + body_.r.norm());
    const Real before = edge.at(body_.r);
    const Real after = edge.at(end.r);
    if (std::abs(after) <= slack) return;
    // From the edge itself it goes to the side that its velocity points to.
    const bool from_edge = std::abs(before) <= slack;
    const Real sign = (from_edge ? edge.rate(body_) : before) > 0 ? 1 : -1;
    const auto beyond = [&](Real t) { return !(sign * edge.at(at(t).r) > 0); };
    const auto goes_away = [&](Real t) { return sign * edge.rate(at(t)) > 0; };
    if (from_edge) {
      if (sign * after > 0) return;
      const Real farthest = bisect(h, [&](Real t) { return !goes_away(t); });
      const Real least = slack * std::pow(4.0L, crowd_);
      if (farthest <= shortest_throw * span_ || sign * edge.at(at(farthest).r) <= least) return;
      roots.push_back(farthest + bisect(h - farthest, [&](Real t) { return beyond(farthest + t); }));
    } else if (sign * after < 0) {
      roots.push_back(bisect(h, beyond));
    } else if (sign * edge.rate(body_) < 0 && sign * edge.rate(end) > 0) {
      const Real nearest = bisect(h, goes_away);
      if (sign * edge.at(at(nearest).r) >= -slack) return;  // touched
      roots.push_back(bisect(nearest, beyond));
      roots.push_back(nearest + bisect(h - nearest, [&](Real t) { return !beyond(nearest + t); }));
    }
  }

  /// Enters the region that the step comes to first, if any.
  template <class At>
  bool leaves_region(Real h, const Body& end, Real& tau, const At& at) {
    std::vector<Real> roots;
    for (const Edge& edge : edges_) add_roots(edge, h, end, at, roots);
    roots.push_back(0);
    std::sort(roots.begin(), roots.end());
    for (std::size_t i = 0; i < roots.size(); ++i) {
      const Real next = i + 1 < roots.size() ? roots[i + 1] : h;
      if (next - roots[i] <= 1e-17L * span_) continue;
      int top = base;
      if (is_visible(at((roots[i] + next) / 2).r, region_, top)) continue;
      tau = roots[i];
      Body there = tau > 0 ? at(tau) : body_;
      crowd_ = tau > 1e-12L * span_ ? 0 : crowd_ + 1;
      go(tau, there);
      if (crowd_ > 12) gave_up_ = "livelock";
      change_ground(top);
      return true;
    }
    return false;
  }

  const scene::Scene& scene_;
  Mechanics mechanics_;
  Real span_;
  Real shorter_;
  std::vector<Edge> edges_;
  Real size_ = 0;
  Real speed_ = 0;
  Real time_ = 0;
  Real h_ = 0;
  Real creep_ = 0;
  Real released_ = -std::numeric_limits<Real>::infinity();
  int slow_steps_ = 0;
  Body body_;
  Hold hold_;
  Constraint constraint_;
  int region_ = base;
  int crowd_ = 0;
  int steps_ = 0;
  std::string gave_up_;
  OwnRun result_;
};

}  // namespace

OwnRun integrate(const scene::Scene& scene, const std::vector<double>& times, Real shorter) {
  return Run(scene, times.back(), shorter).to(times);
}

}  // namespace hybrid_sphere::fuzz::own
