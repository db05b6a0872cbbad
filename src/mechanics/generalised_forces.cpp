#include "mechanics/generalised_forces.hpp"

#include <memory>
#include <utility>

namespace hybrid_sphere::mechanics {
namespace {

class ForcedEquations final : public EquationsOfMotion {
 public:
  ForcedEquations(std::shared_ptr<const EquationsOfMotion> own, Vector forces)
      : own_(std::move(own)), forces_(std::move(forces)) {}

  Index coordinates() const override { return own_->coordinates(); }
  Index velocities() const override { return own_->velocities(); }
  void evaluate(double t, const Vector& q, const Vector& v, MotionTerms& terms) const override {
    own_->evaluate(t, q, v, terms);
    terms.force += forces_;
  }
  void momentum(double t, const Vector& q, const Vector& v, Vector& p, Matrix& mass) const override {
    own_->momentum(t, q, v, p, mass);
  }
  void rate(const Vector& q, const Vector& v, Vector& rate) const override { own_->rate(q, v, rate); }
  void directions(const Vector& q, const Vector& v, Matrix& directions, Vector& drift) const override {
    own_->directions(q, v, directions, drift);
  }
  void steady_axes(const Vector& q, const Vector& v, const Vector& acceleration, Matrix& axes,
                   Matrix& axes_rate) const override {
    own_->steady_axes(q, v, acceleration, axes, axes_rate);
  }

 private:
  std::shared_ptr<const EquationsOfMotion> own_;
  Vector forces_;
};

}  // namespace

Model with_generalised_forces(Model model, const Vector& forces) {
  if (!forces.isZero(0)) model.equations = std::make_shared<ForcedEquations>(model.equations, forces);
  return model;
}

}  // namespace hybrid_sphere::mechanics
