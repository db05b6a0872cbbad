#include "reference.hpp"

#include <algorithm>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <optional>
#include <stdexcept>

#include "hybrid_sphere/scene/read_scene.hpp"
#include "scene/tree.hpp"
#include "scene/yaml.hpp"

namespace hybrid_sphere::peers {
namespace {

using Quad = boost::multiprecision::cpp_bin_float_quad;

struct Plane {
  Quad x, y;
};
Plane operator+(const Plane& a, const Plane& b) { return {a.x + b.x, a.y + b.y}; }
Plane operator-(const Plane& a, const Plane& b) { return {a.x - b.x, a.y - b.y}; }
Plane operator*(const Quad& s, const Plane& a) { return {s * a.x, s * a.y}; }
Quad dot(const Plane& a, const Plane& b) { return a.x * b.x + a.y * b.y; }
Plane quad(const Vector2d& a) { return {Quad(a.x()), Quad(a.y())}; }

struct Line {
  Plane point, normal;
};

std::vector<Line> edges(const scene::Shape& shape) {
  if (const auto* half = std::get_if<scene::HalfPlane>(&shape))
    return {{quad(half->point), quad(half->normal)}};
  const auto* polygon = std::get_if<scene::Polygon>(&shape);
  if (polygon == nullptr) throw std::invalid_argument("the reference knows half-planes and polygons");
  std::vector<Line> lines;
  for (std::size_t i = 0; i < polygon->vertices.size(); ++i) {
    const Plane a = quad(polygon->vertices[i]);
    const Plane side = quad(polygon->vertices[(i + 1) % polygon->vertices.size()]) - a;
    lines.push_back({a, {-side.y, side.x}});  // corners are counter-clockwise
  }
  return lines;
}

/// Of convex shapes.
bool inside(const std::vector<Line>& lines, const Plane& r) {
  return std::all_of(lines.begin(), lines.end(),
                     [&](const Line& line) { return dot(line.normal, r - line.point) >= 0; });
}

class Motion {
 public:
  explicit Motion(const scene::Scene& scene)
      : radius_(scene.sphere.radius), gravity_(quad(scene.forces.gravity.head<2>())) {
    const Quad k = scene.sphere.gyration_radius;
    kappa_ = k * k / (radius_ * radius_ + k * k);
    base_ = scene.surface.base.law == scene::Law::rough;
    for (const scene::Region& region : scene.surface.regions) {
      if (region.material.law != scene::Law::rough && region.material.law != scene::Law::smooth)
        throw std::invalid_argument("the reference knows smooth and rough ground");
      shapes_.push_back(edges(region.shape));
      rough_.push_back(region.material.law == scene::Law::rough);
    }
    const scene::InitialState& start = scene.initial_state;
    r_ = quad(start.position);
    v_ = quad(start.velocity);
    for (int i = 0; i < 3; ++i) omega_[i] = Quad(start.angular_velocity[i]);
    begin(rough_after({}));
  }

  Sample at(double time) {
    const Quad t = time;
    while (next_ && *next_ <= t) {
      move(*next_ - now_);
      begin(!rolling_);
    }
    move(t - now_);
    const auto round = [](const Quad& a) { return a.convert_to<double>(); };
    return {{round(r_.x), round(r_.y)},
            {{round(v_.x), round(v_.y)}, {round(omega_[0]), round(omega_[1]), round(omega_[2])}}};
  }

 private:
  /// (22) holds from here on, or nothing does.
  void begin(bool rolling) {
    rolling_ = rolling;
    if (rolling_) {
      const Plane nu{radius_ * omega_[1], -radius_ * omega_[0]};
      v_ = (1 - kappa_) * v_ + kappa_ * nu;
      spin_with_velocity();
    }
    a_ = (rolling_ ? 1 - kappa_ : Quad(1)) * gravity_;
    const std::vector<Quad> candidates = meetings();
    next_.reset();
    for (std::size_t i = 0; i < candidates.size() && !next_; ++i) {
      const std::vector<Quad> rest(candidates.begin() + static_cast<std::ptrdiff_t>(i), candidates.end());
      if (rough_after(rest) != rolling_) next_ = now_ + candidates[i];
    }
  }

  void move(const Quad& tau) {
    r_ = r_ + tau * v_ + (tau * tau / 2) * a_;
    v_ = v_ + tau * a_;
    if (rolling_) spin_with_velocity();
    now_ += tau;
  }

  void spin_with_velocity() {
    omega_[0] = -v_.y / radius_;
    omega_[1] = v_.x / radius_;
  }

  /// When the path meets a line that bears an edge, from now on, in order; what is met now is left out.
  std::vector<Quad> meetings() const {
    std::vector<Quad> times;
    const auto add = [&](const Quad& tau) {
      if (tau > Quad(1e-25)) times.push_back(tau);
    };
    for (const std::vector<Line>& shape : shapes_) {
      for (const Line& line : shape) {
        const Quad c0 = dot(line.normal, r_ - line.point);
        const Quad c1 = dot(line.normal, v_);
        const Quad c2 = dot(line.normal, a_) / 2;
        const Quad root = c1 * c1 - 4 * c0 * c2;
        if (root < 0) continue;
        const Quad q = -(c1 + (c1 < 0 ? -sqrt(root) : sqrt(root))) / 2;
        if (q != 0) add(c0 / q);
        if (c2 != 0) add(q / c2);
      }
    }
    std::sort(times.begin(), times.end());
    return times;
  }

  /// Of the ground right after the first of the times at which lines are met; now, if there are none.
  bool rough_after(const std::vector<Quad>& times) const {
    Quad tau = 0;
    if (!times.empty()) tau = times.size() == 1 ? times[0] + 1 : (times[0] + times[1]) / 2;
    const Plane r = r_ + tau * v_ + (tau * tau / 2) * a_;
    bool rough = base_;
    for (std::size_t i = 0; i < shapes_.size(); ++i) {
      if (inside(shapes_[i], r)) rough = rough_[i];
    }
    return rough;
  }

  Quad radius_, kappa_;
  Plane gravity_;
  bool base_ = false;
  std::vector<std::vector<Line>> shapes_;
  std::vector<bool> rough_;

  Quad now_ = 0;
  Plane r_, v_, a_;
  Quad omega_[3];
  bool rolling_ = false;
  std::optional<Quad> next_;  ///< time of the next switch
};

double number(const scene::Tree& list, std::size_t i) { return *(*list.as_list())[i].as_number(); }

double relative_error(const Sample& sample, const scene::Tree::ListView& expected) {
  const scene::Tree& tolerances = expected[5];
  double error = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    error = std::max(error, std::abs(sample.position[axis] - number(expected[1], i)) / number(tolerances, 0));
    error = std::max(error,
                     std::abs(sample.twist.velocity[axis] - number(expected[3], i)) / number(tolerances, 1));
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const double omega = sample.twist.angular_velocity[static_cast<Eigen::Index>(i)];
    error = std::max(error, std::abs(omega - number(expected[4], i)) / number(tolerances, 2));
  }
  return error;
}

}  // namespace

std::vector<Sample> reference(const scene::Scene& scene, const std::vector<double>& times) {
  Motion motion(scene);
  std::vector<Sample> samples;
  for (const double time : times) samples.push_back(motion.at(time));
  return samples;
}

std::vector<double> output_times(const Task& task) {
  std::vector<double> times;
  for (int i = 1; i <= task.outputs; ++i) times.push_back(task.interval * i);
  return times;
}

double check_reference(const std::string& stem) {
  const scene::Tree tree = scene::tree_from_yaml_file(stem + ".expected.yaml");
  double error = -1;
  const auto entries = tree.as_map();
  for (const auto& [key, value] : *entries) {
    if (key != "states") continue;
    const auto states = value.as_list();
    std::vector<double> times;
    for (const scene::Tree& state : *states) times.push_back(number(state, 0));
    const std::vector<Sample> samples = reference(scene::read_scene_file(stem + ".yaml"), times);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      error = std::max(error, relative_error(samples[i], *(*states)[i].as_list()));
    }
  }
  if (error < 0) throw std::runtime_error(stem + ".expected.yaml: no states");
  return error;
}

}  // namespace hybrid_sphere::peers
