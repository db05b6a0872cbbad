// hybrid_sphere itself, as `simulate` uses it: at every output the whole state, with the orientation, is
// computed and put into a block of states. The clock does not run while the scene's ground is indexed.
#include <array>

#include "hybrid_sphere/simulation/simulation.hpp"
#include "peer.hpp"

namespace hybrid_sphere::peers {
namespace {

class HybridSphere final : public Peer {
 public:
  std::string name() const override { return "hybrid_sphere"; }

  Course run(const Task& task, double interval) override {
    Simulation simulation(task.scene);
    const Simulation::SwitchSink ignore = [](const Switch&) {};
    std::size_t count = 0;
    const auto advance = [&] {
      simulation.advance_to(interval * static_cast<double>(++count), ignore);
      block_[count % block_.size()] = simulation.state();
    };
    const auto look = [&]() -> Sample {
      const State& state = block_[count % block_.size()];
      return {state.position, state.twist};
    };
    return march(task, interval, advance, look);
  }

 private:
  std::array<State, 1024> block_;
};

}  // namespace

std::unique_ptr<Peer> make_hybrid_sphere() { return std::make_unique<HybridSphere>(); }

}  // namespace hybrid_sphere::peers
