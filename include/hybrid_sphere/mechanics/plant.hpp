#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "hybrid_sphere/export.hpp"
#include "hybrid_sphere/mechanics/solve.hpp"

namespace hybrid_sphere::mechanics {

/// Called with each switch when its time is reached. The plant is then at the switch, after all switches of
/// that instant: time(), state(), save() and set_input() may be called.
using SwitchSink = std::function<void(const Switch&)>;

/// The model for the values of an input: forces of actuators, parameters, a prescribed speed. L, Q, f and g
/// may contain them. The sizes of the model and the names of its constraints are the same for all inputs.
using ModelOfInput = std::function<Model(const Vector& input)>;

/// A hybrid system that is advanced in time, for controllers and real-time programs. Where solve() computes a
/// whole motion, this keeps only the present: how far it is advanced at a time makes no difference to the
/// motion, to the bit, as long as nobody intervenes.
/// @code
/// const auto brake = [](mechanics::Plant& plant) {
///   for (int i = 0; i < 10; ++i) {
///     plant.set_input({-plant.state().v[0]});  // held until the next one
///     plant.advance(plant.time() + 0.1);
///   }
/// };
/// @endcode
class HYBRID_SPHERE_EXPORT Plant {
 public:
  /// Throws std::invalid_argument where solve() does. Of the options, max_steps and max_switches count within
  /// one call of advance().
  /// @param horizon  time over which errors may add up to Options::accuracy, > 0 [s]; over many times that,
  ///                 to as many times the accuracy
  Plant(const Model& model, const Initial& initial, const Options& options = {}, double horizon = 10);
  Plant(ModelOfInput model, const Vector& input, const Initial& initial, const Options& options = {},
        double horizon = 10);
  ~Plant();
  Plant(Plant&&) noexcept;
  Plant& operator=(Plant&&) noexcept;

  const Model& model() const;
  double time() const;  ///< t [s]

  /// Advances the motion. Switches at `time` itself are included.
  /// @param time       not before time() [s]
  /// @param on_switch  may throw: the plant then stays at the switch, and the next call continues from there
  /// @return           reached_end, or why the motion ends before, at time(): it continues only if it was
  ///                   cancelled, or reached a limit of the options
  /// Throws std::invalid_argument for an earlier time, std::logic_error in on_switch, and what the user's
  /// functions throw.
  Status advance(double time, const SwitchSink& on_switch = {});

  /// The change of the initial state by the options project_positions and project_initial.
  const Projection& projection() const;

  /// The state at time(); after a switch there. Throws as Solution::at().
  State state() const;

  /// Sets the input from time() on. If velocities then violate a constraint that holds, advance() begins with
  /// a switch: its impulse satisfies constraints, and contacts respond as in a collision. A motion that had
  /// ended continues with the new input from the state where it ended.
  /// @param input  of the size of the one before
  /// Throws std::invalid_argument for another size, for numbers that are not finite, for a model of other
  /// sizes or names or whose constraints on positions do not hold here, or overlap, by more than the
  /// accuracy, for a plant without input, and for one whose initial state was not possible; nothing has
  /// changed then.
  void set_input(const Vector& input);
  const Vector& input() const;

  /// A plant at one instant.
  class Snapshot;
  /// The present: time, state, which constraints hold, the input.
  Snapshot save() const;
  /// Puts a plant of the same model back to an earlier present. From there on it moves as the one that was
  /// saved, within the accuracy; two that are put back move alike to the bit.
  void restore(const Snapshot& snapshot);

  std::uint64_t switches() const;     ///< so far
  std::uint64_t steps() const;        ///< of the integration
  std::uint64_t evaluations() const;  ///< of the equations of motion

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

class HYBRID_SPHERE_EXPORT Plant::Snapshot {
 public:
  struct Data;
  explicit Snapshot(std::shared_ptr<const Data> data) : data_(std::move(data)) {}
  const Data& data() const { return *data_; }

 private:
  std::shared_ptr<const Data> data_;
};

}  // namespace hybrid_sphere::mechanics
