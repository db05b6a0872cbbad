#include "python/batch.hpp"

#include <algorithm>
#include <chrono>
#include <new>
#include <thread>

namespace hybrid_sphere::python {
namespace {

/// Runs that a thread takes at a time, and between two looks at signals: of cheap ones many, but some
/// thousand states at most, and no thread waits for the last block of another for long.
std::size_t block_size(const BatchRequest& request) {
  constexpr std::size_t most_runs = 64;
  constexpr std::size_t most_states = 8192;
  const std::size_t states = std::max<std::size_t>(request.times.size(), 1);
  const std::size_t most = std::clamp<std::size_t>(most_states / states, 1, most_runs);
  return std::clamp<std::size_t>(request.runs / (8 * request.threads), 1, most);
}

}  // namespace

/// What one thread needs for its runs.
class Batch::Worker {
 public:
  Worker(Batch& batch, std::function<bool()> should_stop)
      : batch_(batch),
        request_(batch.request_),
        layout_(batch.layout_),
        should_stop_(std::move(should_stop)) {
    if (request_.paths.empty()) return;
    variation_.emplace(request_.scene.tree, request_.scene.directory, request_.paths, "samples.");
  }

  void run(std::size_t run, Block& block) {
    run_ = run;
    block_ = &block;
    begin();
    char* item = batch_.items_ + run * request_.times.size() * layout_.item_size();
    std::size_t done = 0;
    try {
      for (const double time : request_.times) {
        simulation_->advance_to(time, keep_);
        layout_.put(simulation_->state(), item + done * layout_.item_size());
        ++done;
      }
    } catch (const HaltedError& error) {
      if (error.stop() == Stop::out_of_memory) throw std::bad_alloc();
      block.halts.push_back({run, error});
      for (; done < request_.times.size(); ++done) {  // where it stays
        layout_.put(simulation_->state(), item + done * layout_.item_size());
      }
    }
  }

 private:
  void begin() {
    if (simulation_ && variation_ && variation_->varies_initial_state_alone()) {
      set_sample();
      simulation_->set_initial_state(variation_->scene().initial_state);
      return;
    }
    if (should_stop_()) throw Interrupted();  // to read a map may take long
    if (variation_) set_sample();
    simulation_ = std::make_unique<Simulation>(variation_ ? variation_->scene() : request_.scenes[run_]);
    layout_.forget_names();
    if (!layout_.has_orientation()) simulation_->follow_orientation(false);
    simulation_->set_interrupt(should_stop_);
  }

  void set_sample() {
    try {
      variation_->set(request_.samples.data() + run_ * request_.paths.size());
    } catch (const scene::SceneError& error) {
      throw scene::SceneError("samples[" + std::to_string(run_) + "]." + error.path(), error.value(),
                              error.allowed());
    }
  }

  Batch& batch_;
  const BatchRequest& request_;
  StateLayout layout_;
  std::function<bool()> should_stop_;
  std::optional<SceneVariation> variation_;
  std::unique_ptr<Simulation> simulation_;
  std::size_t run_ = 0;
  Block* block_ = nullptr;
  Simulation::SwitchSink keep_ =
      request_.keep_switches
          ? Simulation::SwitchSink([this](const Switch& event) { block_->switches.add(event, run_); })
          : Simulation::SwitchSink();
};

Batch::Batch(const BatchRequest& request, const StateLayout& layout, char* items)
    : request_(request),
      layout_(layout),
      items_(items),
      block_size_(block_size(request)),
      blocks_((request.runs + block_size_ - 1) / block_size_) {}

void Batch::work(const std::function<bool()>& should_stop) {
  std::size_t run = 0;
  try {
    Worker worker(*this, should_stop);
    for (std::size_t block = next_block_++; block < blocks_.size(); block = next_block_++) {
      const std::size_t end = std::min(request_.runs, (block + 1) * block_size_);
      if (should_stop()) throw Interrupted();
      for (run = block * block_size_; run < end; ++run) worker.run(run, blocks_[block]);
    }
  } catch (const Interrupted&) {
  } catch (...) {
    fail(run);
  }
}

/// Blocks before that of the run go on, as one of them may fail, too.
void Batch::fail(std::size_t run) {
  const std::lock_guard<std::mutex> lock(failed_);
  if (run < failed_run_) {
    failed_run_ = run;
    failure_ = std::current_exception();
  }
  next_block_ = blocks_.size();
}

void Batch::compute(const std::function<bool()>& should_stop) {
  const std::size_t others = std::min(request_.threads, std::max<std::size_t>(blocks_.size(), 1)) - 1;
  const std::function<bool()> is_stopped = [this] { return stopped_.load(std::memory_order_relaxed); };
  const std::function<bool()> ask = [&] {
    if (!stopped_ && should_stop()) stopped_ = true;
    return stopped_.load();
  };
  std::vector<std::thread> threads;
  std::atomic<std::size_t> working{others};
  try {
    for (std::size_t i = 0; i < others; ++i) {
      threads.emplace_back([&] {
        work(is_stopped);
        --working;
      });
    }
    work(ask);
    while (working > 0 && !ask()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  } catch (...) {  // a thread cannot be started
    stopped_ = true;
    for (std::thread& thread : threads) thread.join();
    throw;
  }
  for (std::thread& thread : threads) thread.join();
  if (stopped_) throw Interrupted();
  if (failure_) std::rethrow_exception(failure_);
}

KeptSwitches Batch::take_switches() {
  KeptSwitches all;
  for (Block& block : blocks_) all.append(std::move(block.switches));
  return all;
}

std::vector<BatchHalt> Batch::halts() const {
  std::vector<BatchHalt> all;
  for (const Block& block : blocks_) all.insert(all.end(), block.halts.begin(), block.halts.end());
  return all;
}

}  // namespace hybrid_sphere::python
