#include "ros/bag/bag_writer.hpp"

#include <boost/make_shared.hpp>

#include <limits>

#include "ros/bag/bag_file.hpp"
#include "ros/conversions/conversions.hpp"
#include "ros/conversions/surface_message.hpp"

namespace hybrid_sphere::ros_interface {
namespace {

constexpr const char* node = "/hybrid_sphere";

/// The header of a connection to a latched topic: `rosbag play` latches it again.
template <class Message>
boost::shared_ptr<ros::M_string> latched(const Message& message) {
  auto header = boost::make_shared<ros::M_string>();
  (*header)["callerid"] = node;
  (*header)["latching"] = "1";
  (*header)["type"] = ros::message_traits::datatype(message);
  (*header)["md5sum"] = ros::message_traits::md5sum(message);
  (*header)["message_definition"] = ros::message_traits::definition(message);
  return header;
}

}  // namespace

BagWriter::BagWriter(const std::string& file, const scene::Scene& scene)
    : bag_(std::make_unique<BagFile>(file)),
      clock_(1, 0, ros::Time(first_stamp, 0)),
      radius_(scene.sphere.radius),
      messages_(Frames{}, Sphere(scene.sphere)) {
  switch_.header.frame_id = Frames{}.world;
  SurfaceMap map = message_from_surface(scene.surface);
  map.header.frame_id = Frames{}.world;
  map.header.stamp = clock_.stamp(0);
  bag_->write(std::string(node) + "/surface_map", map.header.stamp, map, latched(map));
}

BagWriter::~BagWriter() = default;

void BagWriter::write(const cli::OutputBlock& block) {
  // A switch goes before the state of the same instant, which is the one after it.
  auto event = block.switches.begin();
  for (std::size_t i = 0; i < block.states.size(); ++i) {
    const ros::Time now = stamp(block.states[i]);
    for (; event != block.switches.end() && stamp(*event) <= now; ++event) write(*event);
    write(block.states[i], block.reactions[i]);
  }
  for (; event != block.switches.end(); ++event) write(*event);
}

void BagWriter::write(const State& state, const Vector3d& reaction) {
  static const std::string topics[] = {"/hybrid_sphere/pose", "/hybrid_sphere/twist", "/hybrid_sphere/odom",
                                       "/hybrid_sphere/state", "/tf"};
  const ros::Time now = stamp(state);
  bag_->write(topics[0], now, messages_.pose(state, now));
  bag_->write(topics[1], now, messages_.twist(state, now));
  bag_->write(topics[2], now, messages_.odom(state, now));
  bag_->write(topics[3], now, messages_.state(state, reaction, now));
  bag_->write(topics[4], now, messages_.transform(state, now));
}

void BagWriter::write(const Switch& event) {
  static const std::string topic = "/hybrid_sphere/constraint_switch";
  static const boost::shared_ptr<ros::M_string> connection = latched(ConstraintSwitch());
  switch_.header.stamp = stamp(event);
  fill(event, radius_, switch_);
  bag_->write(topic, switch_.header.stamp, switch_, connection);
}

void BagWriter::finish() { bag_->close(); }

}  // namespace hybrid_sphere::ros_interface

const hybrid_sphere::cli::BagFormat* hybrid_sphere_bag_format() {
  using hybrid_sphere::ros_interface::BagWriter;
  // A second is left to the rounding of the stamps.
  constexpr double longest = std::numeric_limits<std::uint32_t>::max() - 1.0 - BagWriter::first_stamp;
  static const hybrid_sphere::cli::BagFormat format{
      longest, [](const std::string& file, const hybrid_sphere::scene::Scene& scene) {
        return std::make_unique<BagWriter>(file, scene);
      }};
  return &format;
}
