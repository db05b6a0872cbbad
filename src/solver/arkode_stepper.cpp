#include "hybrid_sphere/solver/arkode_stepper.hpp"

#include <arkode/arkode_erkstep.h>
#include <nvector/nvector_serial.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <stdexcept>
#include <string>

namespace hybrid_sphere::solver {
namespace {

constexpr sunindextype size = State::RowsAtCompileTime;

/// What the functions that ARKODE calls need.
struct Problem {
  const Equations* equations = nullptr;
  State scale = State::Ones();
  double tolerance = 1;
  std::uint64_t evaluations = 0;
};

State read(N_Vector vector) { return Eigen::Map<const State>(N_VGetArrayPointer(vector)); }

void write(const State& state, N_Vector vector) { Eigen::Map<State>{N_VGetArrayPointer(vector)} = state; }

int right_hand_side(realtype /*x*/, N_Vector y, N_Vector rate, void* user) {
  auto& problem = *static_cast<Problem*>(user);
  ++problem.evaluations;
  const State derivative = problem.equations->derivative(read(y));
  write(derivative, rate);
  return derivative.allFinite() ? 0 : -1;
}

int error_weights(N_Vector /*y*/, N_Vector weights, void* user) {
  const auto& problem = *static_cast<const Problem*>(user);
  write((problem.tolerance * problem.scale).inverse(), weights);
  return 0;
}

// abs(v) v has a corner at v = 0, which the method's error estimate, a difference of slopes at the two ends
// of a step, does not see from afar. So v may not halve in a step, unless the step is so short that the
// corner, of the size c a^2 h^3, is below the tolerance.
double longest_step(const Equations& equations, const State& y, double allowed) {
  const double drag = equations.dynamics().quadratic_drag;
  const Instant now = equations.instant(y);
  const double acceleration = drag == 0 ? 0 : equations.acceleration(y, now).norm();
  if (acceleration == 0) return std::numeric_limits<double>::max();
  const double blurred = std::cbrt(allowed / drag / acceleration / acceleration);
  return std::max(0.5 * now.velocity.norm() / acceleration, blurred) / equations.pace(y);
}

constexpr double share_of_longest = 0.5;  // ARKODE's factor

int limit_step(N_Vector y, realtype /*x*/, realtype* limit, void* user) {
  const auto& problem = *static_cast<const Problem*>(user);
  const double longest = longest_step(*problem.equations, read(y), problem.tolerance * problem.scale[4]);
  *limit = std::min(longest, 0.1 * std::numeric_limits<double>::max()) / share_of_longest;
  return 0;
}

/// What ARKODE would print is told by its flags.
void ignore_message(int /*code*/, const char* /*module*/, const char* /*function*/, char* /*text*/,
                    void* /*user*/) {}

void require(bool done, const char* what) {
  if (!done) throw std::runtime_error(std::string("SUNDIALS: ") + what + " failed");
}

}  // namespace

struct ArkodeStepper::Memory {
  Memory();
  ~Memory();
  Memory(const Memory&) = delete;
  Memory& operator=(const Memory&) = delete;

  SUNContext context = nullptr;
  N_Vector y = nullptr;
  void* arkode = nullptr;
  Problem problem;
};

ArkodeStepper::Memory::Memory() {
  require(SUNContext_Create(nullptr, &context) == 0, "SUNContext_Create");
  y = N_VNew_Serial(size, context);
  require(y != nullptr, "N_VNew_Serial");
  require(N_VEnableFusedOps_Serial(y, SUNTRUE) == 0, "N_VEnableFusedOps_Serial");
  N_VConst(0, y);
  arkode = ERKStepCreate(right_hand_side, 0, y, context);
  require(arkode != nullptr, "ERKStepCreate");
}

ArkodeStepper::Memory::~Memory() {
  if (arkode != nullptr) ERKStepFree(&arkode);
  if (y != nullptr) N_VDestroy(y);
  if (context != nullptr) SUNContext_Free(&context);
}

ArkodeStepper::ArkodeStepper() : memory_(std::make_unique<Memory>()) {
  void* const arkode = memory_->arkode;
  Problem& problem = memory_->problem;
  require(ERKStepSetErrHandlerFn(arkode, ignore_message, nullptr) == ARK_SUCCESS, "ERKStepSetErrHandlerFn");
  require(ERKStepSetUserData(arkode, &problem) == ARK_SUCCESS, "ERKStepSetUserData");
  require(ERKStepSetTableNum(arkode, ARKODE_FEHLBERG_13_7_8) == ARK_SUCCESS, "ERKStepSetTableNum");
  require(ERKStepWFtolerances(arkode, error_weights) == ARK_SUCCESS, "ERKStepWFtolerances");
  require(ERKStepSetStabilityFn(arkode, limit_step, &problem) == ARK_SUCCESS, "ERKStepSetStabilityFn");
  require(ERKStepSetCFLFraction(arkode, share_of_longest) == ARK_SUCCESS, "ERKStepSetCFLFraction");
  // A new right-hand side is no costlier after a change of step: change it also a little.
  require(ERKStepSetFixedStepBounds(arkode, 1.0, 1.1) == ARK_SUCCESS, "ERKStepSetFixedStepBounds");
  // A force that changes abruptly (quadratic drag where the velocity passes zero) needs many reductions.
  require(ERKStepSetMaxErrTestFails(arkode, 50) == ARK_SUCCESS, "ERKStepSetMaxErrTestFails");
}

ArkodeStepper::~ArkodeStepper() = default;

void ArkodeStepper::begin(const Equations& equations, const State& y, const State& scale, double first_step,
                          double tolerance) {
  Problem& problem = memory_->problem;
  problem.equations = &equations;
  problem.scale = scale;
  problem.tolerance = tolerance;
  write(y, memory_->y);
  require(ERKStepReInit(memory_->arkode, right_hand_side, 0, memory_->y) == ARK_SUCCESS, "ERKStepReInit");
  require(ERKStepSetInitStep(memory_->arkode, first_step) == ARK_SUCCESS, "ERKStepSetInitStep");
}

namespace {

/// Not SUNDIALS' own message: that gives the time in the variable of the integration.
std::string reason(int flag) {
  if (flag >= 0) return "it is not finite";
  const std::unique_ptr<char, decltype(&std::free)> name(ERKStepGetReturnFlagName(flag), &std::free);
  return std::string("SUNDIALS' ") + name.get();
}

}  // namespace

double ArkodeStepper::advance(const State& scale, State& y) {
  Problem& problem = memory_->problem;
  problem.scale = scale;
  realtype x = 0;
  // One step at a time the output time only gives the direction.
  const int flag =
      ERKStepEvolve(memory_->arkode, std::numeric_limits<double>::max(), memory_->y, &x, ARK_ONE_STEP);
  const State reached = read(memory_->y);
  if (flag < 0 || !reached.allFinite()) {
    throw std::runtime_error("the motion cannot be integrated beyond " + std::to_string(time_of(y)) +
                             " s of the stretch: " + reason(flag));
  }
  y = reached;
  realtype step = 0;
  require(ERKStepGetLastStep(memory_->arkode, &step) == ARK_SUCCESS, "ERKStepGetLastStep");
  return step;
}

std::uint64_t ArkodeStepper::evaluations() const { return memory_->problem.evaluations; }

}  // namespace hybrid_sphere::solver
