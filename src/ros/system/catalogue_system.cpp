#include "ros/system/catalogue_system.hpp"

#include "mechanics/generalised_forces.hpp"
#include "ros/system/catalogue_bodies.hpp"

namespace hybrid_sphere::ros_interface {

CatalogueSystem::CatalogueSystem(const mechanics::catalogue::Entry& entry)
    : entry_(entry), values_(entry.parameters), example_(entry.build(values_)) {}

void CatalogueSystem::set(const std::string& name, double value) {
  values_.set(name, value);
  example_ = entry_.build(values_);
}

mechanics::Model CatalogueSystem::model(const mechanics::Vector& input) const {
  return with_generalised_forces(example_.model, input);
}

mechanics::Vector CatalogueSystem::initial_input() const {
  return mechanics::Vector::Zero(example_.model.equations->velocities());
}

std::vector<Body> CatalogueSystem::bodies() const { return bodies_of(entry_.name, example_.model, values_); }

std::vector<Eigen::Isometry3d> CatalogueSystem::poses(const mechanics::State& state) const {
  return poses_of(example_.model, values_, state.q);
}

}  // namespace hybrid_sphere::ros_interface
