#include "measure.hpp"

#include <algorithm>
#include <exception>

#include "reference.hpp"

namespace hybrid_sphere::peers {
namespace {

constexpr int runs = 3;            // at least, after a first one; the fastest counts
constexpr double enough = 0.1;     // wall time of all of them, up to which there are more [s]
constexpr double shortest = 5e-3;  // of a run; shorter ones are repeated and their mean counts [s]

/// Length of a vector of the velocities whose square is twice the kinetic energy over m [m/s].
double length(const Vector2d& velocity, const Vector3d& omega, double gyration_radius) {
  return std::hypot(velocity.norm(), gyration_radius * omega.norm());
}

void note_errors(const Task& task, const std::vector<Sample>& truth, const std::vector<Sample>& samples,
                 Row& row) {
  const Scale scale = scale_of_motion(task, truth);
  const double k = task.scene.sphere.gyration_radius;
  row.position_error = 0;
  row.velocity_error = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const Twist& twist = samples[i].twist;
    const double off = (samples[i].position - truth[i].position).norm() / scale.way;
    const double twist_off = length(twist.velocity - truth[i].twist.velocity,
                                    twist.angular_velocity - truth[i].twist.angular_velocity, k) /
                             scale.speed;
    if (!std::isfinite(off) || !std::isfinite(twist_off)) {
      row.position_error = row.velocity_error = Row::unknown;
      row.note = "diverges";
      return;
    }
    row.position_error = std::max(row.position_error, off);
    row.velocity_error = std::max(row.velocity_error, twist_off);
  }
}

/// Wall time of the fastest of some runs [s].
/// @param once  wall time of a run [s]
double fastest(const Task& task, Peer& peer, double dial, double once) {
  const auto repeated = static_cast<int>(std::ceil(shortest / std::max(once, 1e-9)));
  double best = std::numeric_limits<double>::infinity();
  double spent = 0;
  for (int i = 0; i < runs || spent < enough; ++i) {
    double sum = 0;
    for (int j = 0; j < repeated; ++j) sum += peer.run(task, dial).wall;
    best = std::min(best, sum / repeated);
    spent += sum;
  }
  return best;
}

void fill(const Task& task, const std::vector<Sample>& truth, Peer& peer, const Limits& limits, Row& row) {
  const Course course = peer.run(task, row.dial);
  row.note = course.note;
  note_errors(task, truth, course.samples, row);
  const bool once = limits.quick || (1 + runs) * course.wall > 0.5 * limits.seconds;
  row.cost = 1e9 * (once ? course.wall : fastest(task, peer, row.dial, course.wall)) / task.duration();
}

/// Every setting of a simulator's dial that the limits allow.
std::vector<Row> rows_of(const Task& task, const std::vector<Sample>& truth, Peer& peer,
                         const std::vector<double>& dials, const Limits& limits) {
  std::vector<Row> rows;
  double expected = 0;
  for (std::size_t i = 0; i < dials.size(); ++i) {
    Row row;
    row.scene = task.name;
    row.simulator = peer.name();
    row.dial = dials[i];
    if (i > 0) expected *= peer.chooses_steps() ? 2 : dials[i - 1] / dials[i];
    if (expected > limits.seconds) {
      row.note = "not run: would take about " + std::to_string(std::lround(expected)) + " s";
    } else {
      try {
        fill(task, truth, peer, limits, row);
        expected = 1e-9 * row.cost * task.duration();
      } catch (const std::exception& error) {
        row.note = std::string("fails: ") + error.what();
      }
    }
    rows.push_back(row);
  }
  return rows;
}

std::vector<double> dials_of(const Peer& peer, const Limits& limits) {
  std::vector<double> dials = peer.dials();
  if (limits.quick) dials = {dials[(dials.size() - 1) / 2]};
  return dials;
}

double cost_at(const std::vector<Row>& own, double interval) {
  for (const Row& row : own) {
    if (row.dial == interval) return row.cost;
  }
  return Row::unknown;
}

}  // namespace

Scale scale_of_motion(const Task& task, const std::vector<Sample>& truth) {
  const scene::InitialState& start = task.scene.initial_state;
  const double k = task.scene.sphere.gyration_radius;
  Scale scale{0, length(start.velocity, start.angular_velocity, k)};
  Vector2d last = start.position;
  for (const Sample& sample : truth) {
    scale.way += (sample.position - last).norm();
    scale.speed = std::max(scale.speed, length(sample.twist.velocity, sample.twist.angular_velocity, k));
    last = sample.position;
  }
  return scale;
}

std::vector<Row> compare(const Task& task, const std::vector<std::unique_ptr<Peer>>& peers,
                         const Limits& limits) {
  const std::vector<Sample> truth = reference(task.scene, output_times(task));
  const auto self = make_hybrid_sphere();
  std::vector<double> intervals{task.interval};
  for (const double step : dials_of(*self, limits)) intervals.push_back(step);
  std::vector<Row> rows = rows_of(task, truth, *self, intervals, limits);
  const std::vector<Row> own = rows;
  for (const auto& peer : peers) {
    for (Row& row : rows_of(task, truth, *peer, dials_of(*peer, limits), limits)) {
      row.ratio = row.cost / own.front().cost;
      row.step_ratio = peer->chooses_steps() ? Row::unknown : row.cost / cost_at(own, row.dial);
      rows.push_back(row);
    }
  }
  return rows;
}

}  // namespace hybrid_sphere::peers
