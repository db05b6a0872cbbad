#pragma once

#include <hybrid_sphere/ConstraintSwitch.h>

#include <memory>
#include <string>

#include "cli/output_sink.hpp"
#include "hybrid_sphere/export.hpp"
#include "ros/conversions/state_messages.hpp"
#include "ros/node/tick_clock.hpp"

namespace hybrid_sphere::ros_interface {

class BagFile;

/// A run as the bag that a recording of the node would give: its topics with its frames, every message
/// recorded at its own stamp. The stamp of time 0 is first_stamp, so that equal runs give equal files.
class BagWriter : public cli::OutputSink {
 public:
  /// Of time 0 [s]; ROS takes 0 for no time at all.
  static constexpr std::uint32_t first_stamp = 1;

  /// The ground is the first message.
  /// @param file  is overwritten
  /// @throws cli::WriteError
  BagWriter(const std::string& file, const scene::Scene& scene);
  ~BagWriter() override;

  bool wants_reactions() const override { return true; }
  void write(const cli::OutputBlock& block) override;
  void finish() override;

 private:
  void write(const State& state, const Vector3d& reaction);
  void write(const Switch& event);
  ros::Time stamp(const State& state) const { return clock_.stamp(state.time); }
  ros::Time stamp(const Switch& event) const { return clock_.stamp(event.time, event.time_remainder); }

  std::unique_ptr<BagFile> bag_;
  TickClock clock_;
  double radius_;
  StateMessages messages_;
  ConstraintSwitch switch_;
};

}  // namespace hybrid_sphere::ros_interface

/// Bags as `simulate` takes them, which finds this function by its name when it loads the library.
extern "C" HYBRID_SPHERE_EXPORT const hybrid_sphere::cli::BagFormat* hybrid_sphere_bag_format();
