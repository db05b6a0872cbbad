#include "support/line_reference.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <optional>

namespace hybrid_sphere::testing {
namespace {

using scene::Law;
using Real = long double;
using Complex = std::complex<Real>;

constexpr int base = -1;
constexpr int nowhere = -2;
constexpr Real close = 1e-7L;  // what is closer is decided by rounding
constexpr Real infinite = std::numeric_limits<Real>::infinity();

int sign(Real x) { return (x > 0) - (x < 0); }

/// s'' = force - drag s' - spring s.
struct Course {
  Real place, velocity, force, drag, spring;

  void at(Real t, Real& s, Real& v) const {
    if (spring == 0 && drag == 0) {
      s = place + velocity * t + force * t * t / 2;
      v = velocity + force * t;
    } else if (spring == 0) {
      const Real final_velocity = force / drag;
      const Real decayed = std::exp(-drag * t);
      s = place + final_velocity * t - (velocity - final_velocity) * std::expm1(-drag * t) / drag;
      v = final_velocity + (velocity - final_velocity) * decayed;
    } else {
      const Complex root = std::sqrt(Complex(drag * drag / 4 - spring));
      const Complex l1 = -drag / 2 + root;
      const Complex l2 = -drag / 2 - root;
      const Real x = place - force / spring;
      const Complex first = (velocity - l2 * x) / (l1 - l2);
      const Complex second = (l1 * x - velocity) / (l1 - l2);
      s = force / spring + (first * std::exp(l1 * t) + second * std::exp(l2 * t)).real();
      v = (l1 * first * std::exp(l1 * t) + l2 * second * std::exp(l2 * t)).real();
    }
  }
  Real place_at(Real t) const {
    Real s, v;
    at(t, s, v);
    return s;
  }
  Real velocity_at(Real t) const {
    Real s, v;
    at(t, s, v);
    return v;
  }
};

/// First time in (low, high] at which a function that is positive at high, and not at low, is positive.
template <class Function>
Real first_positive(const Function& f, Real low, Real high) {
  for (int i = 0; i < 100; ++i) {
    const Real middle = (low + high) / 2;
    (f(middle) > 0 ? high : low) = middle;
  }
  return high;
}

struct Constraint {
  bool holds = false;
  bool spin = false;
  Real belt = 0;
  bool operator==(const Constraint& o) const {
    return holds == o.holds && (!holds || (spin == o.spin && belt == o.belt));
  }
};

enum class ContactMode { free, rolling, sliding };

class Runner {
 public:
  Runner(const LineScene& scene, Real unit, Real until) : scene_(scene), until_(until) {
    radius_ = scene.sphere.radius / unit;
    const Real k = scene.sphere.gyration_radius / unit;
    kappa_ = k * k / (radius_ * radius_ + k * k);
    inertia_ = radius_ * radius_ / (k * k);
    gravity_ = scene.gravity / unit;
    s_ = scene.place;
    v_ = scene.velocity;
    nu_ = scene.rolling;
  }

  LineCourse run() {
    course_.told_until = static_cast<double>(until_);
    const int start = forward(nowhere, direction(ContactMode::free));
    enter(start);
    while (!stopped_ && t_ < until_) go_on();
    return course_;
  }

 private:
  const Tile& tile(int id) const {
    return id == base ? scene_.base : scene_.tiles[static_cast<std::size_t>(id)];
  }
  static std::string name(int id) { return id == nowhere ? "" : id == base ? "base" : std::to_string(id); }
  Real decay(int id) const { return tile(id).friction * gravity_; }
  Real pull() const { return scene_.pull - scene_.drag * v_ - scene_.spring * (s_ - scene_.spring_center); }
  bool is_smooth(int id) const {
    return tile(id).law == Law::smooth || (tile(id).law == Law::coulomb && tile(id).friction == 0);
  }

  void stop(const char* reason) {
    stopped_ = true;
    course_.told_until = std::min<double>(course_.told_until, static_cast<double>(t_));
    course_.end = reason;
  }

  Real acceleration(ContactMode mode) const {
    if (mode == ContactMode::free) return pull();
    if (mode == ContactMode::rolling) return (1 - kappa_) * pull();
    return pull() - slip_sign_ * decay(region_);
  }
  int direction(ContactMode mode) const { return v_ != 0 ? sign(v_) : sign(acceleration(mode)); }

  /// Just ahead of s_ in a direction.
  int forward(int in_force, int way) const {
    int top = nowhere;
    for (int id = static_cast<int>(scene_.tiles.size()) - 1; id >= 0; --id) {
      const Tile& t = tile(id);
      const bool along = way > 0   ? t.a <= s_ && s_ < t.b
                         : way < 0 ? t.a < s_ && s_ <= t.b
                                   : t.a <= s_ && s_ <= t.b;
      if (!along || t.low > 0 || t.high < 0) continue;
      const bool inside = t.low < 0 && t.high > 0 && (way != 0 || (t.a < s_ && s_ < t.b));
      if (id == in_force) return id;
      if (top == nowhere) top = id;
      if (inside) return top;
    }
    return top == nowhere || in_force == base ? base : top;
  }

  bool grips(int id) const {
    const Real needed = kappa_ * std::abs(pull());
    return needed <= decay(id);
  }

  ContactMode impose(int id) {
    const Tile& t = tile(id);
    if (is_smooth(id)) return ContactMode::free;
    Real slip = v_ - nu_ - t.belt;
    if (std::abs(slip) < 1e-13L || (constraint_.holds && constraint_.belt == t.belt)) slip = 0;
    if (t.law == Law::coulomb) {
      const bool by_rounding = !constraint_.holds || constraint_.belt != t.belt;
      if (by_rounding && std::abs(slip) < scene_.resolution) stop("a slip that is no more than the error");
      if (slip != 0) {
        slip_sign_ = sign(slip);
        return ContactMode::sliding;
      }
      if (std::abs(kappa_ * std::abs(pull()) - decay(id)) < close) stop("grip");
      if (grips(id)) return ContactMode::rolling;
      slip_sign_ = sign(pull());
      return ContactMode::sliding;
    }
    if (slip != 0) {
      const Real conserved = v_ - kappa_ * (v_ - nu_);
      v_ = conserved + kappa_ * t.belt;
      if (v_ != 0 && std::abs(v_) < close) stop("stands after an impulse, as far as rounding tells");
      nu_ = v_ - t.belt;
    }
    return ContactMode::rolling;
  }

  void enter(int id) {
    std::vector<int> visited;
    for (;;) {
      visited.push_back(id);
      if (tile(id).belt_across != 0) return stop("is carried off the line");
      mode_ = impose(id);
      if (stopped_) return;
      take(id);
      const int next = forward(region_, direction(mode_));
      if (next == region_) return;
      if (std::find(visited.begin(), visited.end(), next) != visited.end()) return stop("livelock");
      id = next;
    }
  }

  void take(int id) {
    Constraint now;
    if (mode_ == ContactMode::rolling) now = {true, tile(id).law == Law::rubber, tile(id).belt};
    const Constraint before = constraint_;
    const int from = region_;
    constraint_ = now;
    region_ = id;
    if (before == now) return;
    const SwitchKind kind = !before.holds ? SwitchKind::applied
                            : now.holds   ? SwitchKind::exchanged
                                          : SwitchKind::released;
    course_.switches.push_back(
        {static_cast<double>(t_), static_cast<double>(s_), kind, name(from), name(id)});
  }

  /// Ends of tiles that lie next in both directions.
  void find_next_edges(Real& above, Real& below) const {
    above = infinite;
    below = -infinite;
    const int way = direction(mode_);
    for (const Tile& t : scene_.tiles) {
      for (const Real edge : {Real(t.a), Real(t.b)}) {
        if (edge > s_ || (edge == s_ && way < 0)) above = std::min(above, edge);
        if (edge < s_ || (edge == s_ && way > 0)) below = std::max(below, edge);
      }
    }
  }

  /// To the next edge, or to the end of the slip.
  void go_on() {
    const Real share = mode_ == ContactMode::rolling ? 1 - kappa_ : 1;
    Real force = share * (scene_.pull + scene_.spring * scene_.spring_center);
    const Real friction = mode_ == ContactMode::sliding ? slip_sign_ * decay(region_) : 0;
    force -= friction;
    const Course course{s_, v_, force, share * scene_.drag, share * scene_.spring};
    if (v_ == 0 && acceleration(mode_) == 0 && mode_ != ContactMode::sliding) return stop("stands");
    const Real belt = tile(region_).belt;
    const auto slip_left = [&](Real t) {  // > 0 once it is used up
      return mode_ != ContactMode::sliding
                 ? -1
                 : -slip_sign_ * (course.velocity_at(t) - (nu_ + inertia_ * friction * t) - belt);
    };
    Real above, below;
    find_next_edges(above, below);
    const Real step = 1.0L / 256;
    bool leaves = true;
    for (Real t = 0; t_ + t < until_; t += step) {
      Real turn = t + step;
      const Real now = course.velocity_at(t);
      const Real then = course.velocity_at(t + step);
      const auto against = [&](Real x) { return -sign(now) * course.velocity_at(x); };
      if (now != 0 && sign(now) * sign(then) <= 0) {
        turn = then == 0 ? t + step : first_positive(against, t, t + step);
        const Real place = course.place_at(turn);
        if (std::min(std::abs(place - above), std::abs(place - below)) < close) {
          t_ += turn;
          return stop("turns on an edge");
        }
      }
      for (const auto& [from, to] : {std::pair(t, turn), std::pair(turn, t + step)}) {
        if (to <= from) continue;
        const Real end_place = course.place_at(to);
        Real crossing = infinite;
        Real edge = 0;
        if (end_place > above) {
          crossing = first_positive([&](Real x) { return course.place_at(x) - above; }, from, to);
          edge = above;
        } else if (end_place < below) {
          crossing = first_positive([&](Real x) { return below - course.place_at(x); }, from, to);
          edge = below;
        }
        Real used_up = infinite;
        if (slip_left(to) > 0 && (from > 0 || slip_left(0) <= 0))
          used_up = first_positive(slip_left, from, to);
        if (crossing == infinite && used_up == infinite) continue;
        const Real event = std::min(crossing, used_up);
        if (std::abs(crossing - used_up) < close) {
          t_ += event;
          return stop("slip ends on an edge");
        }
        nu_ = mode_ == ContactMode::free      ? nu_
              : mode_ == ContactMode::sliding ? nu_ + inertia_ * friction * event
                                              : course.velocity_at(event) - belt;
        t_ += event;
        if (t_ > until_) return;
        v_ = course.velocity_at(event);
        s_ = course.place_at(event);
        if (crossing < used_up) {
          s_ = edge;
          if (std::abs(v_) < 1e-4L) return stop("comes to an edge without a speed");
          const int next = forward(region_, sign(v_));
          if (next != region_) enter(next);
        } else {
          if (std::min(std::abs(s_ - above), std::abs(s_ - below)) < close)
            return stop("slip ends on an edge");
          nu_ = v_ - belt;
          if (std::abs(v_) < close) return stop("rolls without a speed");
          enter(region_);
        }
        leaves = false;
        return;
      }
    }
    if (leaves) t_ = until_;
  }

  const LineScene& scene_;
  Real until_;
  Real radius_, kappa_, inertia_, gravity_;
  Real t_ = 0, s_, v_, nu_;
  int slip_sign_ = 0;
  ContactMode mode_ = ContactMode::free;
  int region_ = nowhere;
  Constraint constraint_;
  LineCourse course_;
  bool stopped_ = false;
};

}  // namespace

LineCourse course_of(const LineScene& scene, double unit, double until) {
  return Runner(scene, unit, until).run();
}

scene::Scene LineScene::in_plane(const Vector2d& direction) const {
  const Vector2d across(-direction.y(), direction.x());
  const auto at = [&](double s, double q) { return Vector2d(s * direction + q * across); };
  const auto material = [&](const Tile& tile) {
    scene::Material result(tile.law);
    result.friction = tile.friction;
    result.belt = at(tile.belt, tile.belt_across);
    return result;
  };
  scene::Scene scene{};
  scene.sphere = sphere;
  scene.initial_state.position = at(place, 0);
  scene.initial_state.velocity = at(velocity, 0);
  const Vector2d omega = at(0, rolling) / sphere.radius;  // nu = R (omega_2, -omega_1)
  scene.initial_state.angular_velocity = {omega.x(), omega.y(), spin};
  const Vector2d slope = at(pull, 0);
  scene.forces.gravity = {slope.x(), slope.y(), -gravity};
  scene.forces.drag.translational = drag * sphere.mass;
  scene.forces.spring = {at(spring_center, 0), spring * sphere.mass};
  scene.surface.base = material(base);
  for (const Tile& tile : tiles) {
    scene::Polygon polygon;
    polygon.vertices = {at(tile.a, tile.low), at(tile.b, tile.low), at(tile.b, tile.high),
                        at(tile.a, tile.high)};
    scene.surface.regions.push_back({std::to_string(scene.surface.regions.size()), polygon, material(tile)});
  }
  return scene;
}

}  // namespace hybrid_sphere::testing
