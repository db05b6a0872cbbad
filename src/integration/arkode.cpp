#include "hybrid_sphere/integration/arkode.hpp"

#include <arkode/arkode_erkstep.h>
#include <nvector/nvector_serial.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <stdexcept>
#include <string>

#include "hybrid_sphere/integration/prince_dormand.hpp"

namespace hybrid_sphere::integration {
namespace {

constexpr double share_of_longest = 0.5;  // ARKODE's factor

/// What ARKODE would print is told by its flags.
void ignore_message(int /*code*/, const char* /*module*/, const char* /*function*/, char* /*text*/,
                    void* /*user*/) {}

void require(bool done, const char* what) {
  if (!done) throw std::runtime_error(std::string("SUNDIALS: ") + what + " failed");
}

void set_method(void* arkode) {
  struct Free {
    void operator()(ARKodeButcherTableMem* table) const { ARKodeButcherTable_Free(table); }
  };
  // ARKODE copies what it is given, and takes it by pointers that are not const.
  PrinceDormand method = prince_dormand;
  const std::unique_ptr<ARKodeButcherTableMem, Free> table(ARKodeButcherTable_Create(
      PrinceDormand::stages, PrinceDormand::order, PrinceDormand::embedded_order, method.nodes.data(),
      method.slopes.front().data(), method.weights.data(), method.embedded.data()));
  require(table != nullptr, "ARKodeButcherTable_Create");
  require(ERKStepSetTable(arkode, table.get()) == ARK_SUCCESS, "ERKStepSetTable");
}

std::string name_of(int flag) {
  const std::unique_ptr<char, decltype(&std::free)> name(ERKStepGetReturnFlagName(flag), &std::free);
  return std::string("SUNDIALS' ") + name.get();
}

}  // namespace

struct Arkode::Memory {
  explicit Memory(Eigen::Index size);
  ~Memory();
  Memory(const Memory&) = delete;
  Memory& operator=(const Memory&) = delete;

  State state(N_Vector vector) const { return State(N_VGetArrayPointer(vector), size); }
  ConstState const_state(N_Vector vector) const { return ConstState(N_VGetArrayPointer(vector), size); }

  /// Exceptions may not pass through SUNDIALS: they wait here.
  template <class Function>
  int guarded(const Function& function) {
    try {
      function();
      return 0;
    } catch (...) {
      thrown = std::current_exception();
      return -1;
    }
  }

  Eigen::Index size;
  SUNContext context = nullptr;
  N_Vector y = nullptr;
  N_Vector interpolated = nullptr;
  void* arkode = nullptr;
  Problem* problem = nullptr;
  Eigen::VectorXd weights;
  int roots = 0;
  std::uint64_t evaluations = 0;
  std::exception_ptr thrown;
};

namespace {

// These are what ARKODE calls; user is the Memory.

template <class Memory>
int derivative(realtype x, N_Vector y, N_Vector rate, void* user) {
  auto& memory = *static_cast<Memory*>(user);
  ++memory.evaluations;
  return memory.guarded([&] {
    State out = memory.state(rate);
    memory.problem->derivative(x, memory.const_state(y), out);
    if (!out.allFinite()) throw std::runtime_error("the derivative is not finite");
  });
}

template <class Memory>
int error_weights(N_Vector /*y*/, N_Vector weights, void* user) {
  auto& memory = *static_cast<Memory*>(user);
  memory.state(weights) = memory.weights;
  return 0;
}

template <class Memory>
int limit_step(N_Vector y, realtype /*x*/, realtype* limit, void* user) {
  auto& memory = *static_cast<Memory*>(user);
  return memory.guarded([&] {
    const double longest = memory.problem->longest_step(memory.const_state(y));
    *limit = std::min(longest, 0.1 * std::numeric_limits<double>::max()) / share_of_longest;
  });
}

template <class Memory>
int finish_step(realtype x, N_Vector y, void* user) {
  auto& memory = *static_cast<Memory*>(user);
  return memory.guarded([&] {
    State state = memory.state(y);
    memory.problem->finish_step(x, state);
  });
}

template <class Memory>
int root_functions(realtype x, N_Vector y, realtype* values, void* user) {
  auto& memory = *static_cast<Memory*>(user);
  return memory.guarded([&] { memory.problem->root_functions(x, memory.const_state(y), values); });
}

}  // namespace

Arkode::Memory::Memory(Eigen::Index n) : size(n), weights(Eigen::VectorXd::Ones(n)) {
  require(SUNContext_Create(nullptr, &context) == 0, "SUNContext_Create");
  y = N_VNew_Serial(size, context);
  require(y != nullptr, "N_VNew_Serial");
  require(N_VEnableFusedOps_Serial(y, SUNTRUE) == 0, "N_VEnableFusedOps_Serial");
  N_VConst(0, y);
  interpolated = N_VClone(y);
  require(interpolated != nullptr, "N_VClone");
  arkode = ERKStepCreate(derivative<Memory>, 0, y, context);
  require(arkode != nullptr, "ERKStepCreate");
}

Arkode::Memory::~Memory() {
  if (arkode != nullptr) ERKStepFree(&arkode);
  if (interpolated != nullptr) N_VDestroy(interpolated);
  if (y != nullptr) N_VDestroy(y);
  if (context != nullptr) SUNContext_Free(&context);
}

Arkode::Arkode(Eigen::Index size) : memory_(std::make_unique<Memory>(size)) {
  void* const arkode = memory_->arkode;
  require(ERKStepSetErrHandlerFn(arkode, ignore_message, nullptr) == ARK_SUCCESS, "ERKStepSetErrHandlerFn");
  require(ERKStepSetUserData(arkode, memory_.get()) == ARK_SUCCESS, "ERKStepSetUserData");
  set_method(arkode);
  require(ERKStepWFtolerances(arkode, error_weights<Memory>) == ARK_SUCCESS, "ERKStepWFtolerances");
  require(ERKStepSetStabilityFn(arkode, limit_step<Memory>, memory_.get()) == ARK_SUCCESS,
          "ERKStepSetStabilityFn");
  require(ERKStepSetCFLFraction(arkode, share_of_longest) == ARK_SUCCESS, "ERKStepSetCFLFraction");
  require(ERKStepSetPostprocessStepFn(arkode, finish_step<Memory>) == ARK_SUCCESS,
          "ERKStepSetPostprocessStepFn");
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
  require(ERKStepReInit(memory.arkode, derivative<Memory>, 0, memory.y) == ARK_SUCCESS, "ERKStepReInit");
  require(ERKStepSetInitStep(memory.arkode, first_step) == ARK_SUCCESS, "ERKStepSetInitStep");
  if (end < std::numeric_limits<double>::infinity()) {
    require(ERKStepSetStopTime(memory.arkode, end) == ARK_SUCCESS, "ERKStepSetStopTime");
  }
  const int roots = problem.roots();
  if (roots != 0 || memory.roots != 0) {
    require(ERKStepRootInit(memory.arkode, roots, root_functions<Memory>) == ARK_SUCCESS, "ERKStepRootInit");
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
  return {x, flag == ARK_ROOT_RETURN};
}

void Arkode::interpolate(double x, Eigen::VectorXd& y) {
  Memory& memory = *memory_;
  memory.thrown = nullptr;
  const int flag = ERKStepGetDky(memory.arkode, x, 0, memory.interpolated);
  if (memory.thrown) std::rethrow_exception(memory.thrown);
  if (flag < 0) throw NoStep(name_of(flag));
  y = memory.const_state(memory.interpolated);
}

double Arkode::last_step() const {
  realtype step = 0;
  require(ERKStepGetLastStep(memory_->arkode, &step) == ARK_SUCCESS, "ERKStepGetLastStep");
  return step;
}

std::uint64_t Arkode::evaluations() const { return memory_->evaluations; }

}  // namespace hybrid_sphere::integration
