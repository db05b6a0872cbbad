// A system of one's own for three_stage_node: a sledge that slides over ice, and on whose runner snow imposes
// that it does not slip sideways. Its input are a force along the runner [N] and a torque [N m].

#include <cmath>
#include <hybrid_sphere/mechanics/system.hpp>
#include <hybrid_sphere/ros/system_plugin.hpp>
#include <pluginlib/class_list_macros.hpp>

namespace system_plugin {

using namespace hybrid_sphere::mechanics;

class Sledge : public hybrid_sphere::SystemPlugin {
 public:
  void set(const std::string& name, double value) override {
    if (name != "mass") throw std::invalid_argument("there is no parameter \"" + name + "\"; allowed: mass");
    if (!(value > 0 && value < 1e6)) {
      throw std::invalid_argument("mass = " + std::to_string(value) +
                                  " is refused; allowed: a number > 0 and < 1e6 [kg]");
    }
    mass_ = value;
  }

  Model model(const Vector& input) const override {
    const double m = mass_, I = 0.2 * mass_, along = input[0], turning = input[1];
    const auto lagrangian = [m, I](auto /*t*/, const auto& /*q*/, const auto& v) {
      return m / 2 * (v[0] * v[0] + v[1] * v[1]) + I / 2 * v[2] * v[2];
    };
    const auto forces = [along, turning](double /*t*/, const auto& q, const auto& /*v*/) {
      return Eigen::Vector3d(along * std::cos(q[2]), along * std::sin(q[2]), turning);
    };
    const auto runner = [](auto /*t*/, const auto& q, const auto& v) {
      using std::cos, std::sin;
      return v[1] * cos(q[2]) - v[0] * sin(q[2]);
    };
    const auto snow = [](auto /*t*/, const auto& q) { return (q[0] - 1) * (3 - q[0]); };  // 1 < x < 3
    return System<3>({"x", "y", "theta"}, lagrangian, forces)
        .constrain("runner", runner, while_positive(snow));
  }

  Initial initial() const override { return {0, {0.0, 0.0, 0.2}, {1.0, 0.4, 0.3}}; }
  Vector initial_input() const override { return {0.0, 0.0}; }
  double duration() const override { return 5; }

  std::vector<hybrid_sphere::Body> bodies() const override {
    return {{"sledge", hybrid_sphere::Body::Shape::box, {0.8, 0.3, 0.1}}};
  }
  std::vector<Eigen::Isometry3d> poses(const State& state) const override {
    return {Eigen::Translation3d(state.q[0], state.q[1], 0.05) *
            Eigen::AngleAxisd(state.q[2], Eigen::Vector3d::UnitZ())};
  }

 private:
  double mass_ = 60;
};

}  // namespace system_plugin

PLUGINLIB_EXPORT_CLASS(system_plugin::Sledge, hybrid_sphere::SystemPlugin)
