#include "hybrid_sphere/integration/arkode.hpp"

#include <arkode/arkode_erkstep.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstdlib>
#include <string>

#include "sundials_problem.hpp"

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

std::string name_of(int flag) {
  const std::unique_ptr<char, decltype(&std::free)> name(ERKStepGetReturnFlagName(flag), &std::free);
  return std::string("SUNDIALS' ") + name.get();
}

}  // namespace

struct Arkode::Memory : SundialsProblem {
  explicit Memory(Eigen::Index size);
  ~Memory() override;

  bool goes_on_from(double root) const;

  void* arkode = nullptr;
  int roots = 0;
};

namespace {

// These are what ARKODE calls; user is the SundialsProblem.

int limit_step(N_Vector y, realtype /*x*/, realtype* limit, void* user) {
  auto& memory = *static_cast<SundialsProblem*>(user);
  return memory.guarded([&] {
    const double longest = memory.problem->longest_step(memory.const_state(y));
    *limit = std::min(longest, 0.1 * std::numeric_limits<double>::max()) / share_of_longest;
  });
}

int finish_step(realtype x, N_Vector y, void* user) {
  auto& memory = *static_cast<SundialsProblem*>(user);
  return memory.guarded([&] {
    State state = memory.state(y);
    memory.problem->finish_step(x, state);
  });
}

int root_functions(realtype x, N_Vector y, realtype* values, void* user) {
  auto& memory = *static_cast<SundialsProblem*>(user);
  return memory.guarded([&] { memory.problem->root_functions(x, memory.const_state(y), values); });
}

}  // namespace

Arkode::Memory::Memory(Eigen::Index n) : SundialsProblem(n) {
  arkode = ERKStepCreate(derivative, 0, y, context);
  require(arkode != nullptr, "ERKStepCreate");
}

Arkode::Memory::~Memory() {
  if (arkode != nullptr) ERKStepFree(&arkode);
}

/// Whether ARKODE returns the end of the step after a root in it: not where it takes the root for that end.
bool Arkode::Memory::goes_on_from(double root) const {
  constexpr double fuzz = 100;  // ARKODE's FUZZ_FACTOR
  realtype end = 0;
  realtype step = 0;
  require(ERKStepGetCurrentTime(arkode, &end) == ARK_SUCCESS, "ERKStepGetCurrentTime");
  require(ERKStepGetLastStep(arkode, &step) == ARK_SUCCESS, "ERKStepGetLastStep");
  return std::abs(end - root) > fuzz * DBL_EPSILON * (std::abs(end) + std::abs(step));
}

Arkode::Arkode(Eigen::Index size, const Tableau& tableau) : memory_(std::make_unique<Memory>(size)) {
  void* const arkode = memory_->arkode;
  void* const user = static_cast<SundialsProblem*>(memory_.get());
  require(ERKStepSetErrHandlerFn(arkode, ignore_message, nullptr) == ARK_SUCCESS, "ERKStepSetErrHandlerFn");
  require(ERKStepSetUserData(arkode, user) == ARK_SUCCESS, "ERKStepSetUserData");
  set_method(arkode, tableau);
  require(ERKStepWFtolerances(arkode, SundialsProblem::error_weights) == ARK_SUCCESS, "ERKStepWFtolerances");
  require(ERKStepSetStabilityFn(arkode, limit_step, user) == ARK_SUCCESS, "ERKStepSetStabilityFn");
  require(ERKStepSetCFLFraction(arkode, share_of_longest) == ARK_SUCCESS, "ERKStepSetCFLFraction");
  require(ERKStepSetPostprocessStepFn(arkode, finish_step) == ARK_SUCCESS, "ERKStepSetPostprocessStepFn");
  // A new right-hand side is no costlier after a change of step: change it also a little.
  require(ERKStepSetFixedStepBounds(arkode, 1.0, 1.1) == ARK_SUCCESS, "ERKStepSetFixedStepBounds");
  // A force that changes abruptly (quadratic drag where the velocity passes zero) needs many reductions.
  require(ERKStepSetMaxErrTestFails(arkode, 50) == ARK_SUCCESS, "ERKStepSetMaxErrTestFails");
}

Arkode::~Arkode() = default;

void Arkode::begin(Problem& problem, const Eigen::Ref<const Eigen::VectorXd>& y, double first_step,
                   double end) {
  Memory& memory = *memory_;
  memory.problem = &problem;
  memory.state(memory.y) = y;
  require(ERKStepReInit(memory.arkode, SundialsProblem::derivative, 0, memory.y) == ARK_SUCCESS,
          "ERKStepReInit");
  require(ERKStepSetInitStep(memory.arkode, first_step) == ARK_SUCCESS, "ERKStepSetInitStep");
  if (end < std::numeric_limits<double>::infinity()) {
    require(ERKStepSetStopTime(memory.arkode, end) == ARK_SUCCESS, "ERKStepSetStopTime");
  }
  const int roots = problem.roots();
  if (roots != 0 || memory.roots != 0) {
    require(ERKStepRootInit(memory.arkode, roots, root_functions) == ARK_SUCCESS, "ERKStepRootInit");
    require(ERKStepSetNoInactiveRootWarn(memory.arkode) == ARK_SUCCESS, "ERKStepSetNoInactiveRootWarn");
  }
  memory.roots = roots;
}

void Arkode::set_tolerances(const Eigen::Ref<const Eigen::VectorXd>& tolerances) {
  memory_->weights = tolerances.cwiseInverse();
}

Step Arkode::advance(Eigen::Ref<Eigen::VectorXd> y) {
  Memory& memory = *memory_;
  memory.thrown = nullptr;
  realtype x = 0;
  // One step at a time the output time only gives the direction.
  const int flag =
      ERKStepEvolve(memory.arkode, std::numeric_limits<double>::max(), memory.y, &x, ARK_ONE_STEP);
  if (memory.thrown) std::rethrow_exception(memory.thrown);
  if (flag < 0) throw NoStep(name_of(flag));
  const ConstState reached = memory.const_state(memory.y);
  if (!reached.allFinite()) throw NoStep("it is not finite");
  y = reached;
  if (flag != ARK_ROOT_RETURN) return {x, false, true};
  if (memory.goes_on_from(x)) return {x, true, false};
  require(ERKStepGetCurrentTime(memory.arkode, &x) == ARK_SUCCESS, "ERKStepGetCurrentTime");
  require(ERKStepGetDky(memory.arkode, x, 0, memory.other) == ARK_SUCCESS, "ERKStepGetDky");
  y = memory.const_state(memory.other);
  return {x, true, true};
}

void Arkode::interpolate(double x, Eigen::VectorXd& y) {
  Memory& memory = *memory_;
  memory.thrown = nullptr;
  const int flag = ERKStepGetDky(memory.arkode, x, 0, memory.other);
  if (memory.thrown) std::rethrow_exception(memory.thrown);
  if (flag < 0) throw NoStep(name_of(flag));
  y = memory.const_state(memory.other);
}

double Arkode::last_step() const {
  realtype step = 0;
  require(ERKStepGetLastStep(memory_->arkode, &step) == ARK_SUCCESS, "ERKStepGetLastStep");
  return step;
}

double Arkode::last_error() {
  Memory& memory = *memory_;
  require(ERKStepGetEstLocalErrors(memory.arkode, memory.other) == ARK_SUCCESS, "ERKStepGetEstLocalErrors");
  return memory.const_state(memory.other).cwiseProduct(memory.weights).lpNorm<Eigen::Infinity>();
}

std::uint64_t Arkode::evaluations() const { return memory_->evaluations; }

}  // namespace hybrid_sphere::integration
