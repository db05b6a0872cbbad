#pragma once

#include <algorithm>
#include <memory>

#include "integration/integrator.hpp"

namespace hybrid_sphere::integration {

/// An explicit method that gives way to an implicit one for the rest of a segment once drag, or dry friction,
/// has long held it to short steps though all else is far slower, that is, once the motion is stiff. If the
/// implicit method fails, the explicit one resumes.
class StiffAwareIntegrator final : public Integrator {
 public:
  /// @param for_drag  whether the implicit method is accurate enough to be worthwhile for drag; for dry
  ///                  friction there is no alternative
  StiffAwareIntegrator(std::unique_ptr<Integrator> explicit_method,
                       std::unique_ptr<Integrator> implicit_method, bool for_drag);

  double first_step(const Flow& flow, const FlowState& y, double longest) override;
  void begin(const Flow& flow, Node& first, const FlowState& scale, double first_step) override;
  Node step(Node& from, const FlowState& scale) override;
  FlowState interpolate(Node& from, const Node& to, double x) override;
  double last_error() override { return last_error_; }
  double tolerance() const override { return explicit_->tolerance(); }
  std::size_t largest_shape() const override {
    return std::max(explicit_->largest_shape(), implicit_->largest_shape());
  }
  std::uint64_t evaluations() const override { return explicit_->evaluations() + implicit_->evaluations(); }

 private:
  std::unique_ptr<Integrator> explicit_;
  std::unique_ptr<Integrator> implicit_;
  bool for_drag_;
  const Flow* flow_ = nullptr;
  bool stiff_ = false;
  bool allowed_ = true;  // false if the implicit method has failed in this segment
  double last_error_ = 0;
  double last_step_ = 0;  // of the explicit method
  int held_ = 0;          // number of such steps in succession
};

}  // namespace hybrid_sphere::integration
