#include <csignal>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include "cli/arguments.hpp"
#include "cli/begin_program.hpp"
#include "cli/exit_code.hpp"
#include "cli/interrupt.hpp"
#include "ros/bag/recorder.hpp"

namespace {

using namespace hybrid_sphere;

constexpr const char* default_node = "hybrid_sphere";

struct Options {
  std::string bag;
  std::optional<std::string> node;  ///< name of the simulator, without the default
  std::vector<std::string> more;
};

/// Reads the command line; without options the program exits with the code at once.
std::optional<Options> parse(int argc, char** argv, int& exit_code) {
  cli::CommandLine app(
      "Records the topics of a simulator into a rosbag until Ctrl-C, every message that comes.", "record");
  Options options;
  app.add_argument("BAG", options.bag, "file, replaced; .bag is put to a name that does not end in it");
  app.add_arguments("TOPIC", options.more, "more topics, recorded besides");
  app.add_option("--node", options.node, "NAME", "name of the simulator, in the namespace of this node",
                 default_node);
  app.set_footer("Exit code: 0 done, 2 usage, 4 the bag cannot be written, or lacks messages that had come.");
  if (const auto code = app.parse(argc, argv, std::cout, std::cerr, [] {})) {
    exit_code = *code;
    return std::nullopt;
  }
  const std::string ending = ".bag";
  const std::size_t size = options.bag.size();
  const bool ends = size >= ending.size() && options.bag.compare(size - ending.size(), size, ending) == 0;
  if (!ends) options.bag += ending;
  return options;
}

std::vector<std::string> topics(const Options& options) {
  std::vector<std::string> names;
  for (const char* name : {"state", "pose", "twist", "odom", "constraint_switch", "surface_map", "status"}) {
    names.push_back(options.node.value_or(default_node) + "/" + name);
  }
  names.emplace_back("/tf");
  names.insert(names.end(), options.more.begin(), options.more.end());
  return names;
}

void report(const ros_interface::Recorder& recorder, const std::string& bag) {
  std::cout << "record: \"" << bag << "\": " << recorder.messages() << " messages\n";
  for (const auto& topic : recorder.topics())
    std::cout << "  " << topic.name << ": " << topic.messages << '\n';
  std::cout.flush();
}

int record(const Options& options) {
  // A shell script has what it starts with `&` ignore SIGINT, but this program ends by it alone.
  std::signal(SIGINT, SIG_DFL);
  const cli::Interrupt interrupt(true);
  const auto goes_on = [&interrupt] { return ros::ok() && !interrupt.seen(); };
  // With /use_sim_time there is no time, and no stamp for a message, before the first /clock.
  while (goes_on() && !ros::Time::isValid()) ros::WallDuration(0.01).sleep();
  // roslaunch sends SIGTERM when it has waited long enough, and then SIGKILL.
  ros_interface::Recorder recorder(options.bag, topics(options),
                                   [&interrupt] { return interrupt.seen_again(); });
  std::cout << "record: writing \"" << recorder.active_file() << "\" until Ctrl-C" << std::endl;
  while (goes_on()) recorder.work(ros::WallDuration(0.1));
  const bool all = recorder.finish();
  report(recorder, options.bag);
  if (all) return cli::done;
  std::cerr << "record: told to stop at once: messages already received are missing from the bag"
            << std::endl;
  return cli::could_not_go_on;
}

}  // namespace

int main(int argc, char** argv) {
  cli::begin_program();
  try {
    ros::init(argc, argv, "record", ros::init_options::NoSigintHandler | ros::init_options::AnonymousName);
    int exit_code = cli::done;
    const std::optional<Options> options = parse(argc, argv, exit_code);
    if (!options) return exit_code;
    const ros::NodeHandle node;  // keeps the node running, also when it has no subscriber
    return record(*options);
  } catch (const ros::Exception& error) {  // of names that nothing can have
    cli::write_error("record", error.what(), std::cerr);
    return cli::usage;
  } catch (const std::exception& error) {
    cli::write_error("record", error.what(), std::cerr);
    return cli::could_not_go_on;
  }
}
