#pragma once

#include <chrono>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "hybrid_sphere/scene/scene.hpp"
#include "hybrid_sphere/sphere/twist.hpp"

/// hybrid_sphere beside the simulators that Debian has: the same scenes, in one run of one program.
namespace hybrid_sphere::peers {

/// What every simulator is asked for: the states of a scene at the times interval, 2 interval, ...
struct Task {
  std::string name;
  scene::Scene scene;
  double interval = 0;  ///< between two outputs [s]; a whole number of steps of every size
  int outputs = 0;

  double duration() const { return interval * outputs; }
};

/// What is compared. The orientation is left out.
struct Sample {
  Vector2d position = Vector2d::Zero();  ///< of the centre [m]
  Twist twist;
};

struct Course {
  std::vector<Sample> samples;  ///< one an output
  double wall = 0;   ///< [s], of the motion alone: neither of the setting up nor of the taking down
  std::string note;  ///< what a reader of the figures has to know
};

inline const std::vector<double> step_sizes{1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 1e-5};  // [s]

/// A simulator.
class Peer {
 public:
  Peer() = default;
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;
  virtual ~Peer() = default;

  virtual std::string name() const = 0;

  /// What trades its speed for accuracy, coarse to fine: the time step [s] unless chooses_steps().
  virtual std::vector<double> dials() const { return step_sizes; }

  /// Whether the dial is an accuracy, to which the simulator fits its steps.
  virtual bool chooses_steps() const { return false; }

  /// @throws std::exception  where it cannot go on
  virtual Course run(const Task& task, double dial) = 0;
};

/// A simulator that has to step: steps of one size, and a look at the state at every output. The clock runs
/// over all of it.
/// @param advance  one step
/// @param look     the Sample now
template <class Advance, class Look>
Course march(const Task& task, double step, const Advance& advance, const Look& look) {
  const long steps_per_output = std::lround(task.interval / step);
  Course course;
  course.samples.resize(static_cast<std::size_t>(task.outputs));
  const auto start = std::chrono::steady_clock::now();
  for (Sample& sample : course.samples) {
    for (long i = 0; i < steps_per_output; ++i) advance();
    sample = look();
  }
  course.wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return course;
}

/// The one that the others are compared with: its dial is the time between two states.
std::unique_ptr<Peer> make_hybrid_sphere();

/// Those by others that were found when this program was built.
std::vector<std::unique_ptr<Peer>> found_peers();

std::unique_ptr<Peer> make_bullet();
std::unique_ptr<Peer> make_dart();
std::unique_ptr<Peer> make_mujoco_euler();
std::unique_ptr<Peer> make_mujoco_rk4();
std::unique_ptr<Peer> make_ode();
std::unique_ptr<Peer> make_siconos();
std::unique_ptr<Peer> make_simbody();

}  // namespace hybrid_sphere::peers
