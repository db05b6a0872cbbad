#include "integration/arkode.hpp"

#include <arkode/arkode_erkstep.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <string>

#include "integration/sundials_problem.hpp"

namespace hybrid_sphere::integration {
namespace {

constexpr double share_of_longest = 0.5;  // ARKODE's factor

void set_method(void* arkode, Tableau method) {
  struct Free {
    void operator()(ARKodeButcherTableMem* table) const { ARKodeButcherTable_Free(table); }
  };
  // ARKODE copies what it is given, and takes it by pointers that are not const.
  const std::unique_ptr<ARKodeButcherTableMem, Free> table(ARKodeButcherTable_Create(
      static_cast<int>(method.stages()), method.order, method.embedded_order, method.nodes.data(),
      method.slopes.data(), method.weights.data(), method.embedded.data()));
  require(table != nullptr, "ARKodeButcherTable_Create");
  require(ERKStepSetTable(arkode, table.get()) == ARK_SUCCESS, "ERKStepSetTable");
}

std::string arkode_message(int flag) {
  const std::unique_ptr<char, decltype(&std::free)> name(ERKStepGetReturnFlagName(flag), &std::free);
  return std::string("SUNDIALS: ") + name.get();
}

}  // namespace

struct Arkode::Impl : SundialsProblem {
  explicit Impl(Eigen::Index size);
  ~Impl() override;

  void* arkode = nullptr;
};

namespace {

// These are what ARKODE calls; user is the SundialsProblem.

int limit_step(N_Vector y, realtype /*x*/, realtype* limit, void* user) {
  auto& impl = *static_cast<SundialsProblem*>(user);
  return impl.guarded([&] {
    const double longest = impl.problem->max_step(impl.const_state(y));
    *limit = std::min(longest, 0.1 * std::numeric_limits<double>::max()) / share_of_longest;
  });
}

/// Where a step may be processed, ARKODE evaluates the slope at its end; otherwise it takes for it that of a
/// last stage at the node 1, which in prince_dormand() is another.
int keep_step(realtype /*x*/, N_Vector /*y*/, void* /*user*/) { return 0; }

}  // namespace

Arkode::Impl::Impl(Eigen::Index n) : SundialsProblem(n) {
  arkode = ERKStepCreate(derivative, 0, y, context);
  require(arkode != nullptr, "ERKStepCreate");
}

Arkode::Impl::~Impl() {
  if (arkode != nullptr) ERKStepFree(&arkode);
}

Arkode::Arkode(Eigen::Index size, const Tableau& tableau) : impl_(std::make_unique<Impl>(size)) {
  void* const arkode = impl_->arkode;
  void* const user = static_cast<SundialsProblem*>(impl_.get());
  require(ERKStepSetErrHandlerFn(arkode, ignore_message, nullptr) == ARK_SUCCESS, "ERKStepSetErrHandlerFn");
  require(ERKStepSetUserData(arkode, user) == ARK_SUCCESS, "ERKStepSetUserData");
  set_method(arkode, tableau);
  require(ERKStepWFtolerances(arkode, SundialsProblem::error_weights) == ARK_SUCCESS, "ERKStepWFtolerances");
  require(ERKStepSetStabilityFn(arkode, limit_step, user) == ARK_SUCCESS, "ERKStepSetStabilityFn");
  require(ERKStepSetCFLFraction(arkode, share_of_longest) == ARK_SUCCESS, "ERKStepSetCFLFraction");
  require(ERKStepSetPostprocessStepFn(arkode, keep_step) == ARK_SUCCESS, "ERKStepSetPostprocessStepFn");
  // A new right-hand side is no costlier after a change of step: change it also a little.
  require(ERKStepSetFixedStepBounds(arkode, 1.0, 1.1) == ARK_SUCCESS, "ERKStepSetFixedStepBounds");
  // A force that changes abruptly (quadratic drag where the velocity passes zero) needs many reductions.
  require(ERKStepSetMaxErrTestFails(arkode, 50) == ARK_SUCCESS, "ERKStepSetMaxErrTestFails");
}

Arkode::~Arkode() = default;

void Arkode::begin(Problem& problem, const Eigen::Ref<const Eigen::VectorXd>& y, double first_step) {
  Impl& impl = *impl_;
  impl.problem = &problem;
  impl.state(impl.y) = y;
  require(ERKStepReInit(impl.arkode, SundialsProblem::derivative, 0, impl.y) == ARK_SUCCESS, "ERKStepReInit");
  require(ERKStepSetInitStep(impl.arkode, first_step) == ARK_SUCCESS, "ERKStepSetInitStep");
}

void Arkode::set_tolerances(const Eigen::Ref<const Eigen::VectorXd>& tolerances) {
  impl_->weights = tolerances.cwiseInverse();
}

void Arkode::step(Eigen::Ref<Eigen::VectorXd> y) {
  Impl& impl = *impl_;
  impl.thrown = nullptr;
  realtype x = 0;
  // One step at a time the output time only gives the direction.
  const int flag = ERKStepEvolve(impl.arkode, std::numeric_limits<double>::max(), impl.y, &x, ARK_ONE_STEP);
  if (impl.thrown) std::rethrow_exception(impl.thrown);
  if (flag < 0) throw NoStep(arkode_message(flag));
  const ConstState reached = impl.const_state(impl.y);
  if (!reached.allFinite()) throw NoStep("the state is not finite");
  y = reached;
}

double Arkode::last_step() const {
  realtype step = 0;
  require(ERKStepGetLastStep(impl_->arkode, &step) == ARK_SUCCESS, "ERKStepGetLastStep");
  return step;
}

double Arkode::last_error() {
  Impl& impl = *impl_;
  require(ERKStepGetEstLocalErrors(impl.arkode, impl.other) == ARK_SUCCESS, "ERKStepGetEstLocalErrors");
  return impl.const_state(impl.other).cwiseProduct(impl.weights).lpNorm<Eigen::Infinity>();
}

std::uint64_t Arkode::evaluations() const { return impl_->evaluations; }

}  // namespace hybrid_sphere::integration
