#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "integration/tableau.hpp"

namespace hybrid_sphere::integration {

/// Steps of an explicit Runge-Kutta method, of a length that the caller chooses.
class RungeKutta {
 public:
  static constexpr std::size_t max_stages = 13;

  /// Throws std::invalid_argument for more stages than that.
  explicit RungeKutta(const Tableau& tableau);

  std::size_t stages() const { return rows_.size(); }

  /// Whether the last stage is at the end of the step, so that its slope is the first one of the next step.
  bool ends_with_slope() const { return ends_with_slope_; }

  /// What a step gives besides its end.
  template <class Y>
  struct Estimate {
    Y difference;  ///< to what the embedded method gives: the error of the latter
    Y last_slope;  ///< of the last stage
  };

  /// Room for the steps of states of one size, and what the last one has left there.
  struct Room {
    explicit Room(const RungeKutta& method, Eigen::Index size)
        : slopes(size, static_cast<Eigen::Index>(method.stages())),
          stage(size),
          before_last(size),
          inner(size),
          end(size) {}
    Eigen::MatrixXd slopes;       ///< of the stages, each a column
    Eigen::VectorXd stage;        ///< state of the last stage
    Eigen::VectorXd before_last;  ///< of the stage before it
    Eigen::VectorXd inner;        ///< that of the stage at inner_node()
    Eigen::VectorXd end;          ///< y(x + h)
  };

  /// y(x + h) from y = y(x), whose slope is the first column of room.slopes; evaluates the other stages.
  /// Allocates nothing.
  /// @param derivative  void(double x, const Eigen::VectorXd& y, Eigen::Ref<Eigen::VectorXd> slope)
  template <class Derivative>
  void step_within(Room& room, const Derivative& derivative, double x, const Eigen::VectorXd& y,
                   double h) const {
    for (std::size_t i = 1; i < stages(); ++i) {
      set_sum(rows_[i], h, room, room.stage);
      room.stage += y;
      if (i == inner_) room.inner = room.stage;
      if (i + 2 == stages()) room.before_last = room.stage;
      derivative(x + nodes_[i] * h, room.stage, room.slopes.col(static_cast<Eigen::Index>(i)));
    }
    set_sum(result_, h, room, room.end);
    room.end += y;
  }
  /// The difference of that step of length h to what the embedded method gives.
  void difference(const Room& room, double h, Eigen::VectorXd& difference) const {
    difference.resize(room.end.size());
    set_sum(difference_, h, room, difference);
  }
  /// Where in a step the stage nearest to its middle is, 0 to 1.
  double inner_node() const { return nodes_[inner_]; }

  /// y(x + h) from y = y(x); the error is that of one step of the method. Evaluates `stages()`
  /// right-hand sides.
  /// @param derivative  Y(double x, const Y& y)
  /// @param y           an Eigen array or vector
  template <class Y, class Derivative>
  Y step(const Derivative& derivative, double x, const Y& y, double h) const {
    return step_from(derivative, x, y, derivative(x, y), h);
  }

  /// The same where the first slope is known.
  /// @param estimate  out, unless null
  template <class Y, class Derivative>
  Y step_from(const Derivative& derivative, double x, const Y& y, const Y& slope, double h,
              Estimate<Y>* estimate = nullptr) const {
    std::array<Y, max_stages> slopes;
    slopes[0] = slope;
    const auto sum = [&](const Row& row) {
      Y total = row.front().weight * slopes[row.front().stage];
      for (auto term = row.begin() + 1; term != row.end(); ++term)
        total += term->weight * slopes[term->stage];
      return total;
    };
    for (std::size_t i = 1; i < stages(); ++i) {
      slopes[i] = derivative(x + nodes_[i] * h, Y(y + h * sum(rows_[i])));
    }
    if (estimate) *estimate = {h * sum(difference_), slopes[stages() - 1]};
    return y + h * sum(result_);
  }

 private:
  struct Term {
    std::size_t stage;
    double weight;
  };
  using Row = std::vector<Term>;  // coefficients that are not 0

  /// h times the sum of the slopes with these weights.
  static void set_sum(const Row& row, double h, const Room& room, Eigen::VectorXd& sum);
  template <int count>
  static void set_part(const Row& row, double h, const Room& room, Eigen::Index first, Eigen::VectorXd& sum);

  std::vector<double> nodes_;
  std::vector<Row> rows_;
  std::size_t inner_ = 0;
  Row result_;
  Row difference_;
  bool ends_with_slope_ = false;
};

/// prince_dormand(), shared by all; it has no state.
const RungeKutta& runge_kutta();

}  // namespace hybrid_sphere::integration
