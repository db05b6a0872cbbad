#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "hybrid_sphere/export.hpp"
#include "hybrid_sphere/mechanics/plant.hpp"

namespace hybrid_sphere {

/// A rigid body as it is drawn: it has a frame of its own.
struct Body {
  enum class Shape { none, box, sphere, cylinder };  ///< none: a frame alone; a cylinder has the axis z

  std::string frame;              ///< name of its frame in TF, none twice
  Shape shape = Shape::none;      ///< about the origin of the frame
  Eigen::Vector3d size{0, 0, 0};  ///< extent along the axes of the frame [m]
};

/// A system that `three_stage_node` runs. A package of yours exports a class derived from this one by
/// pluginlib, with the base class hybrid_sphere::SystemPlugin of the package hybrid_sphere. It is made after
/// ros::init and may read parameters of its own. Its functions are called in one thread, those of the model
/// also in another one, and poses() at the same time as these: they share nothing that changes. What they
/// throw before the motion begins is a refusal of the system, later a halt.
/// @code
/// class Brake : public SystemPlugin {  // a mass on a line, and a force as the input
///  public:
///   mechanics::Model model(const mechanics::Vector& input) const override {
///     class Mass final : public mechanics::EquationsOfMotion {
///      public:
///       explicit Mass(double force) : force_(force) {}
///       mechanics::Index coordinates() const override { return 1; }
///       mechanics::Index velocities() const override { return 1; }
///       void evaluate(double t, const mechanics::Vector& q, const mechanics::Vector& v,
///                     mechanics::MotionTerms& terms) const override {
///         momentum(t, q, v, terms.momentum, terms.mass);
///         terms.lagrangian = v[0] * v[0] / 2;
///         terms.rate = v;
///         terms.force = mechanics::Vector::Constant(1, force_);
///       }
///       void momentum(double, const mechanics::Vector&, const mechanics::Vector& v, mechanics::Vector& p,
///                     mechanics::Matrix& mass) const override {
///         p = v;
///         mass = mechanics::Matrix::Ones(1, 1);
///       }
///
///      private:
///       double force_;
///     };
///     mechanics::Model model;
///     model.coordinates = {"x"};
///     model.velocities = {"x_dot"};
///     model.equations = std::make_shared<Mass>(input[0]);
///     return model;
///   }
///   mechanics::Initial initial() const override { return {0, {0.0}, {1.0}}; }
///   mechanics::Vector initial_input() const override { return {0.0}; }
/// };
/// @endcode
class HYBRID_SPHERE_EXPORT SystemPlugin {
 public:
  virtual ~SystemPlugin() = default;

  /// Another value of a number of the system, before all other functions: what ~values says.
  /// @throws std::invalid_argument  for a name that there is not, and for a value that is not allowed
  virtual void set(const std::string& name, double value);

  /// The model for an input that is held, see mechanics::ModelOfInput.
  /// @param input  as many finite numbers as initial_input() has
  virtual mechanics::Model model(const mechanics::Vector& input) const = 0;

  /// Time [s], q, v and, if known, the constraints that hold: at the start, and after a reset.
  virtual mechanics::Initial initial() const = 0;

  /// Before the first message on ~input, and after a reset. Empty: the system has no input.
  virtual mechanics::Vector initial_input() const { return mechanics::Vector(0); }

  /// Time over which errors may add up to the accuracy asked for, see mechanics::Plant [s], > 0.
  virtual double duration() const { return 10; }

  /// The bodies that are drawn; the same ones each time.
  virtual std::vector<Body> bodies() const { return {}; }

  /// Their poses in the frame ~world_frame (SI units), in the order of bodies().
  virtual std::vector<Eigen::Isometry3d> poses(const mechanics::State& /*state*/) const { return {}; }
};

inline void SystemPlugin::set(const std::string& name, double /*value*/) {
  throw std::invalid_argument("there is no parameter \"" + name + "\"; this system has none");
}

}  // namespace hybrid_sphere
