#include "ros/system/system_messages.hpp"

#include <algorithm>
#include <stdexcept>

#include "ros/conversions/conversions.hpp"
#include "ros/markers/marker_tools.hpp"
#include "text/refusal.hpp"

namespace hybrid_sphere::ros_interface {
namespace {

using mechanics::Index;
using mechanics::Model;
using mechanics::Vector;
using Numbers = std::vector<double>;

Numbers numbers(const Vector& values) { return {values.data(), values.data() + values.size()}; }

void append(const Vector& values, Numbers& to) {
  to.insert(to.end(), values.data(), values.data() + values.size());
}

std::vector<std::string> names_of(const Model& model, const mechanics::ActiveSet& set) {
  std::vector<std::string> names;
  for (const std::size_t i : set) names.push_back(model.constraints[i].name);
  return names;
}

/// "one, two"; "free" of none.
std::string listed(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list.empty() ? "free" : list;
}

/// As the columns of three_stage: "rolling_1", "rolling_2".
std::vector<std::string> multiplier_names(const Model& model) {
  std::vector<std::string> names;
  for (const mechanics::Constraint& constraint : model.constraints) {
    const Index size = constraint.function->size();
    for (Index i = 1; i <= size; ++i)
      names.push_back(constraint.name + (size > 1 ? "_" + std::to_string(i) : ""));
  }
  return names;
}

/// Whether q' = v: looked at with velocities that are all different, at the start and elsewhere, as
/// quasi-velocities may be rates at one place.
bool velocities_are_rates(const Model& model, const Vector& q) {
  const Index n = model.equations->velocities();
  if (q.size() != n) return false;
  const Vector v = Vector::LinSpaced(n, 1, static_cast<double>(n));
  Vector rate(n);
  for (const double way : {0.0, 0.37, -1.1}) {
    try {
      model.equations->rate(q + way * v, v, rate);
    } catch (const NumericalError&) {
      return false;
    }
    if (rate != v) return false;
  }
  return true;
}

template <class Pose>
void fill_rotation(const Eigen::Isometry3d& pose, Pose& rotation) {
  const Eigen::Quaterniond q(pose.linear());
  rotation.x = q.x();
  rotation.y = q.y();
  rotation.z = q.z();
  rotation.w = q.w();
}

std::int32_t marker_type(Body::Shape shape) {
  using visualization_msgs::Marker;
  if (shape == Body::Shape::box) return Marker::CUBE;
  return shape == Body::Shape::sphere ? Marker::SPHERE : Marker::CYLINDER;
}

/// The bodies with their whole frames. Refuses what cannot be drawn.
std::vector<Body> checked(std::vector<Body> bodies, const std::string& world_frame,
                          const std::string& frame_prefix) {
  for (Body& body : bodies) {
    if (!body.frame.empty()) body.frame = frame_prefix + body.frame;
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Body& body = bodies[i];
    const std::string key = "bodies[" + std::to_string(i) + "]";
    const auto has_same_frame = [&body](const Body& other) { return other.frame == body.frame; };
    const auto end = bodies.begin() + static_cast<std::ptrdiff_t>(i);
    if (body.frame.empty() || body.frame == world_frame || std::any_of(bodies.begin(), end, has_same_frame)) {
      throw std::invalid_argument(text::refusal(key + ".frame: \"" + body.frame + "\"",
                                                "a name of its own, and not that of the world"));
    }
    if (!(body.size.allFinite() && body.size.minCoeff() >= 0))
      throw std::invalid_argument(text::refusal(key + ".size", "three finite numbers >= 0 [m]"));
  }
  return bodies;
}

/// A marker for each body with a shape. It is locked to the body's frame, so that a fast body does not lag
/// behind the view, which is a frame, too.
visualization_msgs::MarkerArray markers_of(const std::vector<Body>& bodies) {
  visualization_msgs::MarkerArray markers;
  for (const Body& body : bodies) {
    if (body.shape == Body::Shape::none) continue;
    visualization_msgs::Marker marker = make_marker(body.frame, body.frame, 0, marker_type(body.shape));
    marker.frame_locked = true;
    marker.scale.x = body.size.x();
    marker.scale.y = body.size.y();
    marker.scale.z = body.size.z();
    marker.color = color(0.2, 0.5, 0.8);
    markers.markers.push_back(marker);
  }
  return markers;
}

double trail_width(const std::vector<Body>& bodies) {
  constexpr double part = 0.04;  // of the body
  constexpr double usual = 0.01;
  const double size = bodies.empty() ? 0 : bodies.front().size.maxCoeff();
  return size > 0 ? part * size : usual;
}

/// What slides, into a SystemState or a SystemSwitch.
template <class Message>
void set_sliding(const Model& model, const mechanics::Slides& sliding, Message& message) {
  message.sliding.clear();
  message.slide_directions.clear();
  for (const mechanics::Slide& slide : sliding) {
    message.sliding.push_back(model.constraints[slide.constraint].name);
    message.slide_directions.push_back(static_cast<std::int8_t>(slide.direction));
  }
}

}  // namespace

SystemMessages::SystemMessages(const std::string& world_frame, const std::string& frame_prefix,
                               const std::string& view_frame, const SystemPlant& plant,
                               const SystemPlugin& system)
    : plant_(plant),
      system_(system),
      bodies_(checked(system.bodies(), world_frame, frame_prefix)),
      has_rates_(velocities_are_rates(plant.model(), system.initial().q)),
      trail_(world_frame, trail_width(bodies_)),
      constraints_(world_frame, half_width()) {
  const Model& model = plant.model();
  joints_.header.frame_id = state_.header.frame_id = event_.header.frame_id = world_frame;
  joints_.name = state_.coordinates = event_.coordinates = model.coordinates;
  state_.velocities = event_.velocities = model.velocities;
  if (!has_rates_) {
    joints_.name.insert(joints_.name.end(), model.velocities.begin(), model.velocities.end());
  }
  state_.multiplier_names = event_.multiplier_names = multiplier_names(model);
  for (const Body& body : bodies_) {
    geometry_msgs::TransformStamped transform;
    transform.header.frame_id = world_frame;
    transform.child_frame_id = body.frame;
    transforms_.transforms.push_back(transform);
  }
  if (has_bodies()) {
    geometry_msgs::TransformStamped view;
    view.header.frame_id = world_frame;
    view.child_frame_id = view_frame;
    transforms_.transforms.push_back(view);
  }
  markers_ = markers_of(bodies_);
  shapes_ = markers_.markers.size();
}

const sensor_msgs::JointState& SystemMessages::joints(const mechanics::State& state, const ros::Time& stamp) {
  joints_.header.stamp = stamp;
  joints_.position = numbers(state.q);
  if (has_rates_) {
    joints_.velocity = numbers(state.v);
    joints_.effort = numbers(plant_.constraint_forces());
    return joints_;
  }
  append(Vector::Zero(state.v.size()), joints_.position);
  joints_.velocity = numbers(plant_.rate());
  append(state.v, joints_.velocity);
  joints_.effort = numbers(Vector::Zero(state.q.size()));
  append(plant_.constraint_forces(), joints_.effort);
  return joints_;
}

const SystemState& SystemMessages::state(const mechanics::State& state, const ros::Time& stamp) {
  state_.header.stamp = stamp;
  state_.time = state.time;
  state_.stage = static_cast<std::uint8_t>(state.stage);
  state_.active = names_of(plant_.model(), state.active);
  set_sliding(plant_.model(), state.sliding, state_);
  state_.q = numbers(state.q);
  state_.v = numbers(state.v);
  state_.multipliers = numbers(state.multipliers);
  state_.constraint_forces = numbers(plant_.constraint_forces());
  state_.input = numbers(plant_.input());
  state_.energy = state.energy;
  state_.kinetic_energy = state.kinetic_energy;
  state_.residual = state.residual;
  return state_;
}

const SystemSwitch& SystemMessages::event(const mechanics::Switch& event, const ros::Time& stamp) {
  event_.header.stamp = stamp;
  event_.index = event.index;
  event_.time = event.time;
  event_.applied = names_of(plant_.model(), event.applied);
  event_.released = names_of(plant_.model(), event.released);
  event_.active = names_of(plant_.model(), event.active);
  set_sliding(plant_.model(), event.sliding, event_);
  event_.events.clear();
  for (const std::size_t i : event.events) event_.events.push_back(plant_.model().events[i].name);
  event_.q = numbers(event.q);
  event_.v_before = numbers(event.v_before);
  event_.v_after = numbers(event.v_after);
  event_.multipliers = numbers(event.multipliers);
  event_.impulse = numbers(event.impulse);
  event_.rank = static_cast<std::uint32_t>(event.rank);
  event_.energy_before = event.energy_before;
  event_.energy_after = event.energy_after;
  event_.kinetic_energy_before = event.kinetic_energy_before;
  event_.kinetic_energy_after = event.kinetic_energy_after;
  return event_;
}

std::vector<Eigen::Isometry3d> SystemMessages::poses(const mechanics::State& state) const {
  std::vector<Eigen::Isometry3d> poses = system_.poses(state);
  if (poses.size() != bodies_.size()) {
    throw std::runtime_error("the system gives " + std::to_string(poses.size()) + " poses for " +
                             std::to_string(bodies_.size()) + " bodies");
  }
  const bool finite = std::all_of(poses.begin(), poses.end(),
                                  [](const Eigen::Isometry3d& pose) { return pose.matrix().allFinite(); });
  if (!finite) throw std::runtime_error("the system gives a pose that is not finite");
  return poses;
}

/// Half the middle one of the three extents of the first body [m].
double SystemMessages::half_width() const {
  constexpr double usual = 0.1;  // of a body without a shape
  if (!has_bodies()) return usual;
  const Eigen::Vector3d& size = bodies_.front().size;
  const double median = size.sum() - size.minCoeff() - size.maxCoeff();
  return median > 0 ? 0.5 * median : usual;
}

/// Velocity of the first body's origin [m/s], as exactly as pictures need it.
Eigen::Vector3d SystemMessages::velocity_of_first(const mechanics::State& state) const {
  constexpr double step = 1e-4;  // [s]
  Vector rate(state.q.size());
  plant_.model().equations->rate(state.q, state.v, rate);
  mechanics::State next = state;
  next.q += step * rate;
  return (poses(next).front().translation() - poses(state).front().translation()) / step;
}

std::optional<FramedBody> SystemMessages::framed_body(const mechanics::State& state) const {
  if (!has_bodies()) return std::nullopt;
  return FramedBody{poses(state).front().translation(), velocity_of_first(state), half_width()};
}

void SystemMessages::show(const mechanics::Switch& event) {
  if (!has_bodies() || event.impulse.isZero(0)) return;
  const Model& model = plant_.model();
  mechanics::State state;
  state.time = event.time;
  state.q = event.q;
  state.active = event.active;
  state.multipliers.setZero(model.multipliers());
  state.v = event.v_before;
  DrawnImpulse impulse;
  impulse.constraints = listed(names_of(model, event.applied.empty() ? event.active : event.applied));
  impulse.place = poses(state).front().translation();
  impulse.velocity = velocity_of_first(state);
  state.v = event.v_after;
  impulse.next_velocity = velocity_of_first(state);
  constraints_.add(impulse);
}

const tf2_msgs::TFMessage& SystemMessages::transforms(const mechanics::State& state, const ros::Time& stamp,
                                                      ViewPublisher& view) {
  const std::vector<Eigen::Isometry3d> now = poses(state);
  for (std::size_t i = 0; i < now.size(); ++i) {
    geometry_msgs::TransformStamped& message = transforms_.transforms[i];
    message.header.stamp = stamp;
    message.transform.translation.x = now[i].translation().x();
    message.transform.translation.y = now[i].translation().y();
    message.transform.translation.z = now[i].translation().z();
    fill_rotation(now[i], message.transform.rotation);
  }
  transforms_.transforms.back().header.stamp = stamp;
  fill(view.follow(now.front().translation()), transforms_.transforms.back().transform);
  return transforms_;
}

const visualization_msgs::MarkerArray& SystemMessages::markers(const mechanics::State& state, double unit) {
  const std::vector<Eigen::Isometry3d> now = poses(state);
  trail_.add(state.time, now.front().translation(), !state.active.empty());
  markers_.markers.resize(shapes_);
  if (trail_.is_visible()) markers_.markers.push_back(trail_.marker());
  constraints_.append_to(markers_, now.front().translation(), listed(names_of(plant_.model(), state.active)),
                         unit);
  return markers_;
}

}  // namespace hybrid_sphere::ros_interface
