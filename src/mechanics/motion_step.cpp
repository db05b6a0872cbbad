#include "mechanics/motion_step.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <utility>

#include "hybrid_sphere/numerical_error.hpp"

namespace hybrid_sphere::mechanics {
namespace {

using integration::runge_kutta;

integration::RungeKutta::Room& room_for(Index size, std::optional<integration::RungeKutta::Room>& room) {
  if (!room || room->end.size() != size) room.emplace(runge_kutta(), size);
  return *room;
}

}  // namespace

void MotionStep::split(const Eigen::VectorXd& y) {
  const EquationsOfMotion& equations = *motion_->model().equations;
  q_.resize(equations.coordinates());
  v_.resize(equations.velocities());
  std::copy_n(y.data(), q_.size(), q_.data());
  std::copy_n(y.data() + q_.size(), v_.size(), v_.data());
}

void MotionStep::evaluate(double t, const Eigen::VectorXd& y) {
  split(y);
  motion_->evaluate_stage(t, q_, v_);
}

void MotionStep::set_slope(double t, const Beside& beside, Eigen::Ref<Eigen::VectorXd> slope) const {
  const Vector& rate = motion_->terms().rate;
  const Vector& acceleration = motion_->acceleration();
  Index i = 0;
  for (Index j = 0; j < rate.size(); ++j) {
    if (!std::isfinite(rate.data()[j])) throw NotFinite("the rate");
    slope[i++] = rate.data()[j];
  }
  for (Index j = 0; j < acceleration.size(); ++j) slope[i++] = acceleration.data()[j];
  for (const Guard* guard : beside.guards) slope[i++] = guard->rate(t, q_, rate);
  for (const Function& function : beside.functions) slope[i++] = function();
}

Node MotionStep::project(double start, double x, const Eigen::VectorXd& y) {
  split(y);
  motion_->project(start + x, q_, v_);
  Node node{x, Vector(q_.size() + v_.size())};
  node.y << q_, v_;
  return node;
}

ImplicitStep::Derivative MotionStep::derivative(double start, const Beside& beside) {
  return [this, start, &beside](double at, const Eigen::VectorXd& y, Eigen::Ref<Eigen::VectorXd> slope) {
    evaluate(start + at, y);
    set_slope(start + at, beside, slope);
  };
}

/// Sets the direction of friction at a node, and the rows of C.
void MotionStep::aim(double start, const Node& from) {
  motion_->keep_rows(from.rows);
  split(from.y);
  motion_->aim(start + from.x, q_, v_);
}

Node MotionStep::reach(double start, const Node& from, double x) {
  if (x == from.x) return from;
  aim(start, from);
  if (from.implicit) {
    static const Beside none;
    other_implicit_.take(derivative(start, none), from.implicit, from.x, from.y, x - from.x);
    return project(start, x, other_implicit_.end());
  }
  Room& room = room_for(from.y.size(), other_);
  const auto derivative = [&](double at, const Eigen::VectorXd& y, Eigen::Ref<Eigen::VectorXd> slope) {
    evaluate(start + at, y);
    set_slope(start + at, {}, slope);
  };
  derivative(from.x, from.y, room.slopes.col(0));
  runge_kutta().step_within(room, derivative, from.x, from.y, x - from.x);
  return project(start, x, room.end);
}

void MotionStep::begin(double start, const Node& from, Beside beside) {
  start_ = start;
  from_ = from;
  beside_ = std::move(beside);
  y_.setZero(from.y.size() + beside_.size());
  y_.head(from.y.size()) = from.y;
  Room& room = room_for(y_.size(), room_);
  split(from.y);
  set_slope(start + from.x, beside_, room.slopes.col(0));
}

// By differences that are as far above the rounding of a coordinate as they are below its scale. A slow slip
// turns within a smaller change than these: the directions of friction are differentiated apart.
Eigen::MatrixXd MotionStep::linearize(const Vector& scale) {
  aim(start_, from_);
  constexpr double roundings = 1024 * DBL_EPSILON;
  const Index size = from_.y.size();
  SlidingFriction::Held friction(motion_->friction());
  Eigen::MatrixXd jacobian(size, size);
  Eigen::MatrixXd turns(static_cast<Index>(motion_->friction().sliding().size()), size);  // [rad] by y
  const Eigen::VectorXd slope = room_->slopes.col(0).head(size);
  Eigen::VectorXd y = from_.y;
  Eigen::VectorXd changed(size);
  for (Index i = 0; i < size; ++i) {
    const double value = std::abs(from_.y[i]);
    const double change =
        std::max(std::sqrt(DBL_EPSILON * scale[i] * std::max(scale[i], value)), roundings * value);
    const auto differ = [&](double by) {
      y[i] = from_.y[i] + by;
      evaluate(start_ + from_.x, y);
      set_slope(start_ + from_.x, {}, changed);
      jacobian.col(i) = (changed - slope) / (y[i] - from_.y[i]);
      for (Index k = 0; k < turns.rows(); ++k) {
        turns(k, i) = friction.turn_of_slip(static_cast<std::size_t>(k)) / (y[i] - from_.y[i]);
      }
    };
    try {
      differ(change);
    } catch (const NumericalError&) {
      differ(-change);
    }
    y[i] = from_.y[i];
  }
  for (Index k = 0; k < turns.rows(); ++k) {
    if (turns.row(k).isZero(0)) continue;
    jacobian += slope_by_turn(friction, static_cast<std::size_t>(k)) * turns.row(k);
  }
  return jacobian;
}

/// The derivative of the slope at the node by the direction of a slip [1/rad].
Eigen::VectorXd MotionStep::slope_by_turn(SlidingFriction::Held& friction, std::size_t place) {
  constexpr double turn = 1e-5;  // rounding and the terms of third order are both about 1e-10
  Eigen::VectorXd forward(from_.y.size());
  Eigen::VectorXd back(from_.y.size());
  friction.turn(place, turn);
  evaluate(start_ + from_.x, from_.y);
  set_slope(start_ + from_.x, {}, forward);
  friction.turn(place, -turn);
  evaluate(start_ + from_.x, from_.y);
  set_slope(start_ + from_.x, {}, back);
  friction.turn_back();
  return (forward - back) / (2 * turn);
}

void MotionStep::see_slips() {
  slips_across_ = motion_->friction().across();
  slip_speeds_ = motion_->friction().speeds();
}

Node MotionStep::take(double h) {
  h_ = h;
  aim(start_, from_);
  if (from_.implicit) {
    implicit_.take(derivative(start_, beside_), from_.implicit, from_.x, y_, h);
    see_slips();
    Node node = project(start_, from_.x + h, implicit_.end());
    end_ = node.y;
    return node;
  }
  const auto derivative = [&](double at, const Eigen::VectorXd& y, Eigen::Ref<Eigen::VectorXd> slope) {
    evaluate(start_ + at, y);
    set_slope(start_ + at, beside_, slope);
  };
  runge_kutta().step_within(*room_, derivative, from_.x, y_, h);
  see_slips();
  Node node = project(start_, from_.x + h, room_->end);
  end_ = node.y;
  return node;
}

void MotionStep::difference(Vector& difference) {
  if (from_.implicit) {
    implicit_.estimate_error(derivative(start_, beside_), room_->slopes.col(0), difference);
  } else {
    runge_kutta().difference(*room_, h_, difference);
  }
}

double MotionStep::difference_of_last_stage(Index i) const {
  return from_.implicit ? 0 : room_->end[i] - room_->stage[i];
}

double MotionStep::projection(Index i) const {
  return end_[i] - (from_.implicit ? implicit_.end()[i] : room_->end[i]);
}

double MotionStep::fast_rate(const Vector& scale) const {
  constexpr double rounding = 4 * DBL_EPSILON;
  const Index velocities = v_.size();
  const auto last = room_->slopes.cols() - 1;
  const auto size = [&](const auto& y) -> double {
    return (y.segment(q_.size(), velocities).array() / scale.tail(velocities).array()).abs().maxCoeff();
  };
  const double apart = size(room_->stage - room_->before_last);
  if (!(apart > rounding)) return 0;
  return size(room_->slopes.col(last) - room_->slopes.col(last - 1)) / apart;
}

// The cubic through both ends with their slopes (that of the end is the last stage's), and what it misses at
// the inner stage in the form of its error, s^2 (1 - s)^2.
void MotionStep::interpolate(double x, Vector& y) const {
  const auto size = from_.y.size();
  if (from_.implicit) {
    y.resize(size);
    return implicit_.interpolate(x, y);
  }
  const auto first = room_->slopes.col(0).head(size);
  const auto last = room_->slopes.rightCols(1).col(0).head(size);
  const auto cubic = [&](double s) -> Vector {
    const double r = 1 - s;
    return r * r * (1 + 2 * s) * from_.y + s * s * (1 + 2 * r) * end_ +
           h_ * (s * r * r * first - s * s * r * last);
  };
  const auto shape = [](double s) { return s * s * (1 - s) * (1 - s); };
  const double s = (x - from_.x) / h_;
  const double inner = runge_kutta().inner_node();
  y = cubic(s) + shape(s) / shape(inner) * (room_->inner.head(size) - cubic(inner));
}

}  // namespace hybrid_sphere::mechanics
