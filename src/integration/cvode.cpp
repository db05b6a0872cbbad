#include "integration/cvode.hpp"

#include <cvode/cvode.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <cstdlib>
#include <limits>
#include <string>

#include "integration/sundials_problem.hpp"

namespace hybrid_sphere::integration {
namespace {

std::string cvode_message(int flag) {
  const std::unique_ptr<char, decltype(&std::free)> name(CVodeGetReturnFlagName(flag), &std::free);
  return std::string("SUNDIALS: ") + name.get();
}

}  // namespace

struct Cvode::Impl : SundialsProblem {
  Impl(Eigen::Index n, Formula formula);
  ~Impl() override;

  void* cvode = nullptr;
  SUNMatrix matrix = nullptr;
  SUNLinearSolver linear = nullptr;
  SUNNonlinearSolver fixed_point = nullptr;
};

Cvode::Impl::Impl(Eigen::Index n, Formula formula) : SundialsProblem(n) {
  cvode = CVodeCreate(formula == Formula::adams ? CV_ADAMS : CV_BDF, context);
  require(cvode != nullptr, "CVodeCreate");
  require(CVodeSetErrHandlerFn(cvode, ignore_message, nullptr) == CV_SUCCESS, "CVodeSetErrHandlerFn");
  require(CVodeInit(cvode, derivative, 0, y) == CV_SUCCESS, "CVodeInit");
  require(CVodeSetUserData(cvode, static_cast<SundialsProblem*>(this)) == CV_SUCCESS, "CVodeSetUserData");
  require(CVodeWFtolerances(cvode, error_weights) == CV_SUCCESS, "CVodeWFtolerances");
  if (formula == Formula::adams) {
    fixed_point = SUNNonlinSol_FixedPoint(y, 0, context);
    require(fixed_point != nullptr, "SUNNonlinSol_FixedPoint");
    require(CVodeSetNonlinearSolver(cvode, fixed_point) == CV_SUCCESS, "CVodeSetNonlinearSolver");
  } else {
    matrix = SUNDenseMatrix(n, n, context);
    require(matrix != nullptr, "SUNDenseMatrix");
    linear = SUNLinSol_Dense(y, matrix, context);
    require(linear != nullptr, "SUNLinSol_Dense");
    require(CVodeSetLinearSolver(cvode, linear, matrix) == CV_SUCCESS, "CVodeSetLinearSolver");
  }
  // The first step is not much shorter than it has to be: no leap after it.
  require(CVodeSetEtaMaxFirstStep(cvode, 10) == CV_SUCCESS, "CVodeSetEtaMaxFirstStep");
  // A force that changes abruptly (quadratic drag where the velocity passes zero) needs many reductions.
  require(CVodeSetMaxErrTestFails(cvode, 50) == CV_SUCCESS, "CVodeSetMaxErrTestFails");
  require(CVodeSetMaxConvFails(cvode, 50) == CV_SUCCESS, "CVodeSetMaxConvFails");
}

Cvode::Impl::~Impl() {
  if (cvode != nullptr) CVodeFree(&cvode);
  if (fixed_point != nullptr) SUNNonlinSolFree(fixed_point);
  if (linear != nullptr) SUNLinSolFree(linear);
  if (matrix != nullptr) SUNMatDestroy(matrix);
}

Cvode::Cvode(Eigen::Index size, Formula formula) : impl_(std::make_unique<Impl>(size, formula)) {}
Cvode::~Cvode() = default;

void Cvode::begin(Problem& problem, const Eigen::Ref<const Eigen::VectorXd>& y, double first_step) {
  Impl& impl = *impl_;
  impl.problem = &problem;
  impl.state(impl.y) = y;
  require(CVodeReInit(impl.cvode, 0, impl.y) == CV_SUCCESS, "CVodeReInit");
  require(CVodeSetInitStep(impl.cvode, first_step) == CV_SUCCESS, "CVodeSetInitStep");
}

void Cvode::set_tolerances(const Eigen::Ref<const Eigen::VectorXd>& tolerances) {
  impl_->weights = tolerances.cwiseInverse();
}

double Cvode::step(Eigen::Ref<Eigen::VectorXd> y) {
  Impl& impl = *impl_;
  impl.thrown = nullptr;
  // 0 stands for no limit.
  const double longest = impl.problem->max_step(impl.const_state(impl.y));
  require(
      CVodeSetMaxStep(impl.cvode, longest < std::numeric_limits<double>::max() ? longest : 0) == CV_SUCCESS,
      "CVodeSetMaxStep");
  realtype x = 0;
  // One step at a time the output time only gives the direction.
  const int flag = CVode(impl.cvode, 1e300, impl.y, &x, CV_ONE_STEP);
  if (flag < 0 && impl.thrown) std::rethrow_exception(impl.thrown);
  if (flag < 0) throw NoStep(cvode_message(flag));
  const ConstState reached = impl.const_state(impl.y);
  if (!reached.allFinite()) throw NoStep("the state is not finite");
  y = reached;
  return x;
}

void Cvode::derivatives(std::vector<Eigen::VectorXd>& of_y) {
  Impl& impl = *impl_;
  int order = 0;
  require(CVodeGetLastOrder(impl.cvode, &order) == CV_SUCCESS, "CVodeGetLastOrder");
  realtype x = 0;
  require(CVodeGetCurrentTime(impl.cvode, &x) == CV_SUCCESS, "CVodeGetCurrentTime");
  of_y.resize(static_cast<std::size_t>(order));
  for (int k = 1; k <= order; ++k) {
    require(CVodeGetDky(impl.cvode, x - last_step(), k, impl.other) == CV_SUCCESS, "CVodeGetDky");
    of_y[static_cast<std::size_t>(k) - 1] = impl.const_state(impl.other);
  }
}

double Cvode::last_step() const {
  realtype step = 0;
  require(CVodeGetLastStep(impl_->cvode, &step) == CV_SUCCESS, "CVodeGetLastStep");
  return step;
}

double Cvode::last_error() {
  Impl& impl = *impl_;
  require(CVodeGetEstLocalErrors(impl.cvode, impl.other) == CV_SUCCESS, "CVodeGetEstLocalErrors");
  return impl.const_state(impl.other).cwiseProduct(impl.weights).lpNorm<Eigen::Infinity>();
}

std::uint64_t Cvode::evaluations() const { return impl_->evaluations; }

}  // namespace hybrid_sphere::integration
