#include "mechanics/sliding_friction.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "text/refusal.hpp"

namespace hybrid_sphere::mechanics {
namespace {

std::string name_of(const Model& model, const Friction& friction) {
  for (const Constraint& constraint : model.constraints) {
    if (constraint.friction && &*constraint.friction == &friction) return "load of " + constraint.name;
  }
  return "load of a friction";
}

/// @param friction  of the model
double known_load(const Model& model, const Friction& friction, double t, const Vector& q, const Vector& v) {
  const double load = friction.load->value(t, q, v);
  if (!std::isfinite(load)) throw NotFinite(name_of(model, friction));
  if (load < 0) {
    const std::string name = name_of(model, friction);
    const std::string what =
        text::refusal(name + " = " + text::shortest(load), "a number >= 0, as max(0, N)");
    throw Undefined(name, what);
  }
  return load;
}

}  // namespace

double load_of(const Model& model, const Friction& friction, double t, const Vector& q, const Vector& v,
               const Vector& multipliers) {
  if (!friction.contact) return known_load(model, friction, t, q, v);
  return std::max(0.0, multipliers[model.multiplier_of(*friction.contact)]);
}

void check_coefficients(const std::string& subject, const Friction& friction) {
  const auto refuse = [&](const std::string& what, const std::string& allowed) {
    throw std::invalid_argument(subject + ": " + text::refusal(what, allowed));
  };
  const double sliding = friction.coefficient;
  if (!(sliding >= 0 && std::isfinite(sliding))) {
    refuse("coefficient = " + text::shortest(sliding), "a number >= 0");
  }
  const double sticking = friction.of_sticking();
  if (!(sticking >= sliding && std::isfinite(sticking))) {
    refuse("static coefficient = " + text::shortest(sticking),
           "a number >= that of sliding, " + text::shortest(sliding));
  }
}

void SlidingFriction::set(const ActiveSet& active, const Slides& sliding) {
  sliding_ = set_ = sliding;
  directions_.resize(sliding.size());
  begins_.assign(sliding.size(), false);
  speeds_.assign(sliding.size(), 0);
  contacts_.clear();
  loads_.setZero(static_cast<Index>(sliding.size()));
  values_.resize(sliding.size());
  gradients_.resize(sliding.size());
  Index row = 0;
  for (const std::size_t i : active) {
    const bool is_loaded = std::any_of(sliding.begin(), sliding.end(), [&](const Slide& slide) {
      return model_->constraints[slide.constraint].friction->contact == i;
    });
    if (is_loaded) contacts_.push_back({i, row, Vector()});
    row += model_->constraints[i].function->size();
  }
}

void SlidingFriction::aim(double t, const Vector& q, const Vector& v) {
  for (std::size_t i = 0; i < sliding_.size(); ++i) {
    const Constraint& constraint = model_->constraints[sliding_[i].constraint];
    if (constraint.function->size() == 1) continue;
    constraint.function->evaluate(t, q, v, values_[i], gradients_[i]);
    const double speed = speeds_[i] = values_[i].norm();
    begins_[i] = !(speed > sliding_[i].slowest);
    sliding_[i].heading = begins_[i] ? set_[i].heading : Eigen::Vector2d(values_[i] / speed);
  }
}

/// u. A slip about as slow as the slowest that is known from 0 turns into e, so that u has a derivative.
Eigen::Vector2d SlidingFriction::direction_of(std::size_t i) const {
  const Eigen::Vector2d& e = sliding_[i].heading;
  if (values_[i].size() == 1 || begins_[i]) return e;
  if (turned_) return turned_->first == i ? Eigen::Vector2d(Eigen::Rotation2Dd(turned_->second) * e) : e;
  const double forward = e.dot(values_[i]);
  const Eigen::Vector2d across = values_[i] - forward * e;
  const Eigen::Vector2d u = (std::abs(forward) + sliding_[i].slowest) * e + (forward < 0 ? -across : across);
  const double length = u.norm();
  return length > 0 ? Eigen::Vector2d(u / length) : e;
}

void SlidingFriction::evaluate(double t, const Vector& q, const Vector& v, Vector& force) {
  for (Contact& contact : contacts_) contact.direction.setZero(v.size());
  for (std::size_t i = 0; i < sliding_.size(); ++i) {
    const Constraint& constraint = model_->constraints[sliding_[i].constraint];
    const Friction& friction = *constraint.friction;
    constraint.function->evaluate(t, q, v, values_[i], gradients_[i]);
    directions_[i] = direction_of(i);
    const auto against = -friction.coefficient * gradients_[i].transpose();
    const auto direction = directions_[i].head(values_[i].size());
    if (!friction.contact) {
      double& load = loads_[static_cast<Index>(i)];
      load = known_load(*model_, friction, t, q, v);
      force.noalias() += load * against * direction;
      continue;
    }
    for (Contact& contact : contacts_) {
      if (contact.constraint == *friction.contact) contact.direction.noalias() += against * direction;
    }
  }
}

void SlidingFriction::add_multipliers(Vector& all) const {
  for (std::size_t i = 0; i < sliding_.size(); ++i) {
    const Friction& friction = *model_->constraints[sliding_[i].constraint].friction;
    const double load =
        friction.contact ? all[model_->multiplier_of(*friction.contact)] : loads_[static_cast<Index>(i)];
    const Index size = values_[i].size();
    all.segment(model_->multiplier_of(sliding_[i].constraint), size) =
        -friction.coefficient * load * directions_[i].head(size);
  }
}

bool SlidingFriction::begins() const {
  return std::find(begins_.begin(), begins_.end(), true) != begins_.end();
}

std::vector<SlidingFriction::Across> SlidingFriction::across() const {
  std::vector<Across> all;
  for (std::size_t i = 0; i < sliding_.size(); ++i) {
    if (!begins_[i]) continue;
    const Eigen::Vector2d normal(-sliding_[i].heading[1], sliding_[i].heading[0]);
    all.push_back({normal.dot(values_[i]), gradients_[i].transpose() * normal,
                   gradients_[i].transpose() * sliding_[i].heading});
  }
  return all;
}

std::vector<SlidingFriction::Speed> SlidingFriction::speeds() const {
  std::vector<Speed> all;
  for (std::size_t i = 0; i < sliding_.size(); ++i) {
    if (values_[i].size() == 1 || begins_[i]) continue;
    all.push_back({sliding_[i].constraint, speeds_[i], values_[i].norm(),
                   sliding_[i].heading.dot(values_[i].head<2>())});
  }
  return all;
}

double SlidingFriction::Held::turn_of_slip(std::size_t place) const {
  const Slide& slide = friction_->sliding_[place];
  if (friction_->values_[place].size() == 1 || friction_->begins_[place]) return 0;
  const Eigen::Vector2d left(-slide.heading[1], slide.heading[0]);
  return left.dot(friction_->values_[place]) / (friction_->speeds_[place] + slide.slowest);
}

std::size_t SlidingFriction::place_of(std::size_t constraint) const {
  const auto is_it = [&](const Slide& slide) { return slide.constraint == constraint; };
  return static_cast<std::size_t>(std::find_if(sliding_.begin(), sliding_.end(), is_it) - sliding_.begin());
}

double SlidingFriction::slip(std::size_t constraint) const {
  const std::size_t i = place_of(constraint);
  return sliding_[i].heading.head(values_[i].size()).dot(values_[i]);
}

double SlidingFriction::slip_size(std::size_t constraint, const Vector& v) const {
  const std::size_t i = place_of(constraint);
  const Vector sizes = gradients_[i].cwiseAbs() * v.cwiseAbs();
  return sliding_[i].heading.cwiseAbs().head(sizes.size()).dot(sizes);
}

}  // namespace hybrid_sphere::mechanics
