#include "ros/system/catalogue_bodies.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string>

namespace hybrid_sphere::ros_interface {
namespace {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Quaterniond;
using Eigen::Translation3d;
using Eigen::Vector3d;
using mechanics::Model;
using mechanics::Vector;
using mechanics::catalogue::Values;

constexpr double usual = 0.5;      // size of what has none [m]
constexpr double thickness = 0.1;  // of wheels and boxes, in units of their radius or length

bool has(const Model& model, const std::string& name) {
  return std::find(model.coordinates.begin(), model.coordinates.end(), name) != model.coordinates.end();
}

/// The coordinate of a name; 0 where there is none.
double coordinate(const Model& model, const Vector& q, const std::string& name) {
  const auto at = std::find(model.coordinates.begin(), model.coordinates.end(), name);
  return at == model.coordinates.end() ? 0 : q[at - model.coordinates.begin()];
}

bool is_disk(const Model& model) { return has(model, "phi") && !has(model, "psi"); }
bool is_carriage(const Model& model) { return has(model, "phi_left"); }
bool is_ball(const Model& model) { return has(model, "qw") || has(model, "psi"); }

Quaterniond orientation(const Model& model, const Vector& q) {
  const auto of = [&](const char* name) { return coordinate(model, q, name); };
  if (has(model, "qw")) return Quaterniond(of("qw"), of("qx"), of("qy"), of("qz")).normalized();
  if (!has(model, "psi")) return Quaterniond(AngleAxisd(of("theta"), Vector3d::UnitZ()));
  return AngleAxisd(of("psi"), Vector3d::UnitZ()) * AngleAxisd(of("theta"), Vector3d::UnitX()) *
         AngleAxisd(of("phi"), Vector3d::UnitZ());
}

/// Of a wheel whose axis, its z, is horizontal: to the left of where it rolls.
Isometry3d wheel(const Vector3d& center, const Quaterniond& heading, double turn) {
  return Translation3d(center) * heading * AngleAxisd(-std::acos(0.0), Vector3d::UnitX()) *
         AngleAxisd(turn, Vector3d::UnitZ());
}

Vector3d wheel_size(double radius) { return {2 * radius, 2 * radius, thickness * radius}; }

}  // namespace

std::vector<Body> bodies_of(const std::string& name, const Model& model, const Values& values) {
  using Shape = Body::Shape;
  if (is_carriage(model)) {
    const double b = values["b"];
    const Vector3d wheels = wheel_size(values["r"]);
    return {{name, Shape::box, {2 * b, b, thickness * b}},
            {name + "_left_wheel", Shape::cylinder, wheels},
            {name + "_right_wheel", Shape::cylinder, wheels}};
  }
  if (is_disk(model)) return {{name, Shape::cylinder, wheel_size(values["R"])}};
  if (is_ball(model)) return {{name, Shape::sphere, Vector3d::Constant(2 * values["R"])}};
  if (has(model, "theta")) return {{name, Shape::box, {usual, 0.3 * usual, thickness * usual}}};
  return {{name, Shape::sphere, Vector3d::Constant(0.2 * usual)}};
}

std::vector<Isometry3d> poses_of(const Model& model, const Values& values, const Vector& q) {
  const auto of = [&](const char* name) { return coordinate(model, q, name); };
  const Vector3d place(of("x"), of("y"), of("z"));
  const Quaterniond turned = orientation(model, q);
  if (is_carriage(model)) {
    const Vector3d middle = place + values["r"] * Vector3d::UnitZ();
    const Vector3d left = values["b"] * (turned * Vector3d::UnitY());
    return {Translation3d(middle) * turned, wheel(middle + left, turned, of("phi_left")),
            wheel(middle - left, turned, of("phi_right"))};
  }
  if (is_disk(model)) return {wheel(place + values["R"] * Vector3d::UnitZ(), turned, of("phi"))};
  if (is_ball(model)) return {Translation3d(place + values["R"] * Vector3d::UnitZ()) * turned};
  return {Translation3d(place) * turned};
}

}  // namespace hybrid_sphere::ros_interface
