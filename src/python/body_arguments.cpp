#include "python/body_arguments.hpp"

#include <algorithm>
#include <vector>

#include "hybrid_sphere/scene/scene_error.hpp"
#include "python/numbers_of.hpp"

namespace hybrid_sphere::python {
namespace {

namespace py = pybind11;
using mechanics::ContactShape;
using mechanics::Inertia;
using mechanics::Plane;

/// Numbers of one of two shapes, row by row.
struct BodyNumbers {
  std::vector<py::ssize_t> shape;
  std::vector<double> values;
};

bool has_shape(const BodyNumbers& rows, const std::vector<py::ssize_t>& shape) { return rows.shape == shape; }

BodyNumbers rows_of(const py::handle& object, const std::string& name) {
  const Numbers numbers = numbers_of(object, name);
  BodyNumbers rows;
  rows.shape.assign(numbers.shape(), numbers.shape() + numbers.ndim());
  const py::array_t<double, py::array::c_style | py::array::forcecast> in_rows(numbers);
  rows.values.assign(in_rows.data(), in_rows.data() + in_rows.size());
  return rows;
}

[[noreturn]] void refuse_shape(const BodyNumbers& rows, const std::string& name, const char* allowed) {
  std::string shape;
  for (const py::ssize_t size : rows.shape) shape += (shape.empty() ? "" : ", ") + std::to_string(size);
  if (rows.shape.size() == 1) shape += ",";
  throw scene::SceneError(name, "numbers of shape (" + shape + ")", allowed);
}

/// Two vectors, as a Twist or a Wrench has them.
struct TwoVectors {
  Eigen::Vector3d first{0, 0, 0};
  Eigen::Vector3d second{0, 0, 0};
};

TwoVectors vectors_of(const py::handle& object, const std::string& name, const char* allowed) {
  const BodyNumbers rows = rows_of(object, name);
  if (!has_shape(rows, {2, 3})) refuse_shape(rows, name, allowed);
  return {Eigen::Vector3d(rows.values.data()), Eigen::Vector3d(rows.values.data() + 3)};
}

/// A field of a named tuple. @param what  the kind of tuple that is allowed
py::object tuple_field(const py::handle& object, const char* field, const char* name, const char* what) {
  if (py::hasattr(object, field)) return object.attr(field);
  throw scene::SceneError(
      name, "an object of type " + py::type::of(object).attr("__name__").cast<std::string>(), what);
}

}  // namespace

Eigen::Vector3d vector3_of(const py::handle& object, const std::string& name) {
  const BodyNumbers rows = rows_of(object, name);
  if (!has_shape(rows, {3})) refuse_shape(rows, name, "three numbers");
  return Eigen::Vector3d(rows.values.data());
}

Inertia inertia_of(const py::handle& object) {
  const BodyNumbers rows = rows_of(object, "inertia");
  const double* const I = rows.values.data();
  if (has_shape(rows, {3})) return {I[0], I[1], I[2]};
  if (has_shape(rows, {6})) return {I[0], I[1], I[2], I[3], I[4], I[5]};
  if (!has_shape(rows, {3, 3})) {
    refuse_shape(rows, "inertia", "xx, yy, zz; xx, yy, zz, xy, xz, yz; or a matrix of shape (3, 3)");
  }
  Eigen::Matrix3d matrix;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) matrix(i, j) = I[3 * i + j];
  }
  return Inertia(matrix);
}

Eigen::Isometry3d placement_of(const py::handle& object) {
  const BodyNumbers rows = rows_of(object, "placement");
  const double* const numbers = rows.values.data();
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  if (has_shape(rows, {3})) {
    pose.translation() = Eigen::Vector3d(numbers);
    return pose;
  }
  constexpr const char* allowed =
      "a place of shape (3,), or a pose of shape (4, 4) whose last row is 0, 0, 0, 1";
  if (!has_shape(rows, {4, 4})) refuse_shape(rows, "placement", allowed);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) pose.linear()(i, j) = numbers[4 * i + j];
    pose.translation()[i] = numbers[4 * i + 3];
  }
  const double last[] = {0, 0, 0, 1};
  if (!std::equal(last, last + 4, numbers + 12)) {
    throw scene::SceneError("placement", "a pose with another last row", allowed);
  }
  return pose;
}

mechanics::Twist twist_of(const py::handle& object, const std::string& name) {
  const TwoVectors both = vectors_of(object, name, "a velocity and an angular velocity, three numbers each");
  return {both.first, both.second};
}

mechanics::Wrench wrench_of(const py::handle& object, const std::string& name) {
  const TwoVectors both = vectors_of(object, name, "a force and a torque, three numbers each");
  return {both.first, both.second};
}

ContactShape shape_of(const py::handle& object) {
  constexpr const char* allowed = "a ContactShape";
  ContactShape shape;
  const py::object radius = tuple_field(object, "radius", "shape", allowed);
  const BodyNumbers rows = rows_of(radius, "radius of the shape");
  if (!has_shape(rows, {})) refuse_shape(rows, "radius of the shape", "a number > 0");
  shape.radius = rows.values[0];
  const py::object axle = tuple_field(object, "axle", "shape", allowed);
  if (!axle.is_none()) shape.axle = vector3_of(axle, "axle of the shape");
  const py::object center = tuple_field(object, "center", "shape", allowed);
  if (!center.is_none()) shape.center = vector3_of(center, "centre of the shape");
  return shape;
}

Plane plane_of(const py::handle& object) {
  if (object.is_none()) return {};
  const TwoVectors both = vectors_of(object, "plane", "a point and a normal, three numbers each");
  return {both.first, both.second};
}

py::array array_of(const Eigen::Vector3d& vector) { return py::array_t<double>(3, vector.data()); }

py::array array_of(const Eigen::Isometry3d& pose) {
  py::array_t<double> result({4, 4});
  double* to = result.mutable_data();
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) *to++ = pose(i, j);
  }
  return std::move(result);
}

}  // namespace hybrid_sphere::python
