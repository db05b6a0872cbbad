#pragma once

#include <hybrid_sphere/Step.h>
#include <ros/time.h>

#include "ros/node/tick_clock.hpp"

namespace hybrid_sphere::ros_interface {

/// What a node does at the instants of a TimeLoop; all of it in the thread of the loop.
class DrivenNode {
 public:
  using Wall = TickClock::Wall;

  virtual ~DrivenNode() = default;

  /// Sends the present state.
  /// @param stamp  later than that of the last call
  virtual void publish_state(const ros::Time& stamp) = 0;
  /// Draws the present state, where somebody looks and it is time to.
  virtual void publish_markers(Wall::time_point now) = 0;
  /// Whether somebody looks.
  virtual bool is_watched() const = 0;
  /// The input in force acts from the present time on.
  /// @param clock  reading of the clock by which it ages [s]
  virtual void apply_input(double clock) = 0;
  /// Whether an input has come that cannot be taken yet, as its transform is not known; a second at most.
  virtual bool input_waits() const = 0;
  /// The plant is in its initial state again, or in another one.
  virtual void has_started_anew() = 0;
  /// Called again and again. @param stands  whether time stands
  virtual void show_standing(bool stands) = 0;
  /// Fills in the present state, where there is one.
  virtual void describe(Step::Response& response) = 0;
};

}  // namespace hybrid_sphere::ros_interface
