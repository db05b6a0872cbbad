#include "own_integrator.hpp"

#include <algorithm>
#include <cmath>

namespace hybrid_sphere::fuzz::own {
namespace {

constexpr int base = -1;
constexpr int most_steps = 40000;
constexpr std::size_t most_switches = 2000;

Vec2 wide(const Vector2d& v) { return v.cast<Real>(); }

/// A straight line or a circle that an edge is a part of; positive on one side.
struct Edge {
  Vec2 point;
  Vec2 normal;      // of length 1; of a line
  Real radius = 0;  // of a circle
  Real at(const Vec2& r) const { return radius > 0 ? (r - point).norm() - radius : normal.dot(r - point); }
};

Edge line(const Vec2& a, const Vec2& normal) { return {a, normal.normalized(), 0}; }

void add_edges(const scene::Shape& shape, std::vector<Edge>& edges) {
  if (const auto* half_plane = std::get_if<scene::HalfPlane>(&shape)) {
    edges.push_back(line(wide(half_plane->point), wide(half_plane->normal)));
  } else if (const auto* circle = std::get_if<scene::Circle>(&shape)) {
    edges.push_back({wide(circle->center), Vec2::Zero(), circle->radius});
  } else {
    const auto& vertices = std::get<scene::Polygon>(shape).vertices;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const Vec2 a = wide(vertices[i]);
      const Vec2 side = wide(vertices[(i + 1) % vertices.size()]) - a;
      edges.push_back(line(a, Vec2(-side.y(), side.x())));
    }
  }
}

enum class Side { inside, edge, outside };

Side flipped(Side side, bool outside) {
  if (!outside || side == Side::edge) return side;
  return side == Side::inside ? Side::outside : Side::inside;
}

Side side_of(const scene::Polygon& polygon, const Vec2& r, Real slack) {
  bool within = false;
  for (std::size_t i = 0; i < polygon.vertices.size(); ++i) {
    const Vec2 a = wide(polygon.vertices[i]);
    const Vec2 b = wide(polygon.vertices[(i + 1) % polygon.vertices.size()]);
    const Vec2 side = b - a;
    const Real along = std::clamp(side.dot(r - a) / side.squaredNorm(), Real(0), Real(1));
    if ((a + along * side - r).norm() <= slack) return Side::edge;
    if ((a.y() > r.y()) == (b.y() > r.y())) continue;
    if (a.x() + (r.y() - a.y()) * side.x() / side.y() > r.x()) within = !within;
  }
  return flipped(within ? Side::inside : Side::outside, polygon.outside);
}

Side side_of(const scene::Shape& shape, const Vec2& r, Real slack) {
  const auto of = [slack](Real g) {
    return g > slack ? Side::inside : g < -slack ? Side::outside : Side::edge;
  };
  if (const auto* half_plane = std::get_if<scene::HalfPlane>(&shape))
    return of(line(wide(half_plane->point), wide(half_plane->normal)).at(r));
  if (const auto* circle = std::get_if<scene::Circle>(&shape))
    return flipped(of(circle->radius - (r - wide(circle->center)).norm()), circle->outside);
  return side_of(std::get<scene::Polygon>(shape), r, slack);
}

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
    for (const scene::Region& region : scene.surface.regions) add_edges(region.shape, edges_);
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

  // Whether a region is visible at a place, and which one is on top there.
  bool is_visible(const Vec2& r, int region, int& top) const {
    const Real slack = 4e-18L * (size_ + r.norm());
    top = base;
    bool found_top = false;
    bool visible = false;
    for (int i = static_cast<int>(scene_.surface.regions.size()) - 1; i >= 0; --i) {
      const Side side = side_of(scene_.surface.regions[static_cast<std::size_t>(i)].shape, r, slack);
      if (side == Side::outside) continue;
      if (!found_top) top = i;
      found_top = true;
      visible = visible || i == region;
      if (side == Side::inside) return visible;
    }
    return visible || region == base;
  }

  void find_start() {
    // The side that a force bends a path to which begins along an edge is another question.
    const auto is_bent = [this](const Edge& edge) {
      if (std::abs(edge.at(body_.r)) > 1e-15L * size_) return false;
      const Vec2 normal = edge.radius > 0 ? Vec2((body_.r - edge.point) / edge.radius) : edge.normal;
      const bool along = std::abs(normal.dot(body_.v)) <= 1e-12L * body_.v.norm();
      return along && (edge.radius > 0 || body_.v.isZero(0) || normal.dot(mechanics_.force(body_)) != 0);
    };
    if (std::any_of(edges_.begin(), edges_.end(), is_bent)) {
      gave_up_ = "begins along an edge, or at rest on it";
      return;
    }
    int top = base;
    is_visible(body_.r + 1e-9L * span_ * body_.v, no_region, top);
    enter(top);
  }

  void report() {
    const Constraint now = constraint_of(mechanics_.ground(), hold_);
    if (now != constraint_) result_.switches.push_back({time_, name(region_)});
    constraint_ = now;
    if (result_.switches.size() > most_switches) gave_up_ = "too many switches";
  }

  void enter(int region) {
    region_ = region;
    mechanics_.stand_on(material(region));
    if (mechanics_.is_ideal()) mechanics_.strike(body_);
    settle();
    report();
    h_ = span_ / 1e6L;
  }

  void settle() {
    const Real none = 1e-13L * (speed_ + body_.v.norm());
    const Hold may{mechanics_.is_ideal() || mechanics_.slip(body_).norm() <= none,
                   mechanics_.nu(body_).norm() <= none,
                   std::abs(body_.w.z() - mechanics_.ground().turntable_rate) * scene_.sphere.radius <= none};
    hold_ = mechanics_.decide(body_, may);
  }

  void advance(Real until) {
    if (++steps_ > most_steps) {
      gave_up_ = "too many steps";
      return;
    }
    const Real delta = 1e-6L * span_ / shorter_;
    if (mechanics_.time_left(body_, hold_) < 10 * delta) {
      creep(std::min(delta, until - time_));
      return;
    }
    const Real room = until - time_;
    const Real h = std::min({h_, room, span_ / 200 / shorter_, mechanics_.time_left(body_, hold_) / 8});
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

  void creep(Real h) {
    Hold hold = hold_;
    const Body next = mechanics_.implicit_step(body_, h, hold);
    Real tau = h;
    if (leaves_region(h, next, tau, [&](Real t) {
          Hold unused = hold_;
          return mechanics_.implicit_step(body_, t, unused);
        }))
      return;
    go(h, next);
    hold_ = hold;
    report();
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
    const Real spin_before = body_.w.z() - mechanics_.ground().turntable_rate;
    const auto changed = [&](const Body& b) {
      const Real spin = b.w.z() - mechanics_.ground().turntable_rate;
      const bool crossed = !hold_.spin && mechanics_.ground().spin_friction > 0 && mechanics_.grips() &&
                           spin_before != 0 && spin * spin_before <= 0;
      return crossed || !mechanics_.can_hold(b, hold_);
    };
    bool changes = changed(next);
    if (changes) tau = bisect(h, [&](Real t) { return changed(at(t)); });
    const Body end = changes ? at(tau) : next;
    if (leaves_region(tau, end, tau, at)) return;
    go(tau, end);
    if (!changes) return;
    if (!hold_.spin && (body_.w.z() - mechanics_.ground().turntable_rate) * spin_before <= 0 &&
        spin_before != 0 && mechanics_.ground().spin_friction > 0)
      body_.w.z() = mechanics_.ground().turntable_rate;
    settle_after_change();
    report();
    h_ = span_ / 1e6L;
  }

  // What was held has velocity 0; it alone may stick on.
  void settle_after_change() {
    const Real none = 1e-13L * speed_;
    const Hold may{
        hold_.slip, hold_.roll,
        hold_.spin ||
            std::abs(body_.w.z() - mechanics_.ground().turntable_rate) * scene_.sphere.radius <= none};
    hold_ = mechanics_.decide(body_, may);
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

  /// Enters the region that the step comes to first, if any.
  template <class At>
  bool leaves_region(Real h, const Body& end, Real& tau, const At& at) {
    std::vector<Real> roots;
    const Real slack = 4e-18L * (size_ + body_.r.norm());
    for (const Edge& edge : edges_) {
      const Real before = edge.at(body_.r);
      const Real after = edge.at(end.r);
      if (std::abs(before) <= slack || std::abs(after) <= slack || (before > 0) == (after > 0)) continue;
      roots.push_back(bisect(h, [&](Real t) { return (edge.at(at(t).r) > 0) != (before > 0); }));
    }
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
      enter(top);
      return true;
    }
    return false;
  }

  static constexpr int no_region = -2;

  const scene::Scene& scene_;
  Mechanics mechanics_;
  Real span_;
  Real shorter_;
  std::vector<Edge> edges_;
  Real size_ = 0;
  Real speed_ = 0;
  Real time_ = 0;
  Real h_ = 0;
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
