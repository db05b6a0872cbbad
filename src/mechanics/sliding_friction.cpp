#include "mechanics/sliding_friction.hpp"

#include <algorithm>
#include <cmath>
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

void SlidingFriction::set(const ActiveSet& active, const Slides& sliding) {
  sliding_ = sliding;
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

void SlidingFriction::evaluate(double t, const Vector& q, const Vector& v, Vector& force) {
  for (Contact& contact : contacts_) contact.direction.setZero(v.size());
  for (std::size_t i = 0; i < sliding_.size(); ++i) {
    const Constraint& constraint = model_->constraints[sliding_[i].constraint];
    const Friction& friction = *constraint.friction;
    constraint.function->evaluate(t, q, v, values_[i], gradients_[i]);
    const double part = friction.coefficient * sliding_[i].direction;
    if (!friction.contact) {
      double& load = loads_[static_cast<Index>(i)];
      load = known_load(*model_, friction, t, q, v);
      force -= part * load * gradients_[i].row(0).transpose();
      continue;
    }
    for (Contact& contact : contacts_) {
      if (contact.constraint == *friction.contact) {
        contact.direction -= part * gradients_[i].row(0).transpose();
      }
    }
  }
}

void SlidingFriction::add_multipliers(Vector& all) const {
  for (std::size_t i = 0; i < sliding_.size(); ++i) {
    const Friction& friction = *model_->constraints[sliding_[i].constraint].friction;
    const double load =
        friction.contact ? all[model_->multiplier_of(*friction.contact)] : loads_[static_cast<Index>(i)];
    all[model_->multiplier_of(sliding_[i].constraint)] = -friction.coefficient * load * sliding_[i].direction;
  }
}

std::size_t SlidingFriction::place_of(std::size_t constraint) const {
  const auto is_it = [&](const Slide& slide) { return slide.constraint == constraint; };
  return static_cast<std::size_t>(std::find_if(sliding_.begin(), sliding_.end(), is_it) - sliding_.begin());
}

double SlidingFriction::slip(std::size_t constraint) const { return values_[place_of(constraint)][0]; }

double SlidingFriction::slip_size(std::size_t constraint, const Vector& v) const {
  return gradients_[place_of(constraint)].row(0).cwiseAbs().dot(v.cwiseAbs());
}

}  // namespace hybrid_sphere::mechanics
