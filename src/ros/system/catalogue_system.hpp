#pragma once

#include <string>

#include "catalogue/catalogue.hpp"
#include "hybrid_sphere/ros/system_plugin.hpp"

namespace hybrid_sphere::ros_interface {

/// A system of the catalogue with derivatives as `three_stage run` has them. Its input are generalised forces
/// on its velocities, none at first.
class CatalogueSystem final : public SystemPlugin {
 public:
  explicit CatalogueSystem(const mechanics::catalogue::Entry& entry);

  void set(const std::string& name, double value) override;
  mechanics::Model model(const mechanics::Vector& input) const override;
  mechanics::Initial initial() const override { return example_.initial; }
  mechanics::Vector initial_input() const override;
  double duration() const override { return entry_.duration; }
  std::vector<Body> bodies() const override;
  std::vector<Eigen::Isometry3d> poses(const mechanics::State& state) const override;

 private:
  const mechanics::catalogue::Entry& entry_;
  mechanics::catalogue::Values values_;
  mechanics::catalogue::Example example_;
};

}  // namespace hybrid_sphere::ros_interface
