#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "hybrid_sphere/simulation/simulation.hpp"
#include "simulation/scene_variation.hpp"
#include "study/chunk.hpp"
#include "study/columns.hpp"
#include "study/samples.hpp"

namespace hybrid_sphere::study {

/// The runs of a study. What run i leaves is a function of the study and of i alone. Allocates nothing per
/// run where only the initial state varies and every motion has a closed form.
class Experiment {
 public:
  /// @param study  has to live as long as this
  /// @throws SceneError  as SceneVariation
  explicit Experiment(const Study& study);

  const Columns& columns() const { return columns_; }
  const SceneVariation& variation() const { return variation_; }

  /// Computes runs first .. first + count - 1.
  /// @param should_stop  asked between runs and about every millisecond of a long one; not kept
  /// @throws Interrupted  if it says so
  void run(std::uint64_t first, std::uint64_t count, Chunk& chunk, const std::function<bool()>& should_stop);

  /// The scene of one run as a file.
  scene::Tree scene_of_run(std::uint64_t run) const;

 private:
  /// At which time a run stops on its way, and what is kept there.
  struct Visit {
    double time;
    std::size_t kept;  // index of keep.times; none: extremes only
  };
  static constexpr std::size_t none = static_cast<std::size_t>(-1);

  void plan_visits();
  void begin();
  void run_one(std::uint64_t run, Chunk& chunk);
  void follow(std::uint64_t run, Chunk& chunk);
  void keep_state(const std::vector<StateField>& fields, std::size_t first, std::uint64_t run,
                  std::size_t place, Chunk& chunk);
  void note_switch(const Switch& event);
  void note_region(double time, std::string_view region);
  void note_extremes(const Twist& twist, double slip);

  const Study* study_;
  Samples samples_;
  SceneVariation variation_;
  Columns columns_;
  std::vector<Visit> visits_;
  std::vector<std::string> region_names_;
  std::unordered_map<std::string_view, std::int32_t> regions_;  // code of a name
  std::unordered_map<std::string_view, std::size_t> entered_;   // index in keep.entered of a name
  Simulation::SwitchSink on_switch_;
  std::unique_ptr<Simulation> simulation_;
  std::vector<double> values_;  // of the samples of a chunk
  bool follows_switches_ = false;
  // Of the runs that are being computed, and of the present one:
  const std::function<bool()>* should_stop_ = nullptr;
  Chunk* chunk_ = nullptr;
  std::uint64_t run_ = 0;
  std::int32_t switches_ = 0;
  double greatest_[4] = {};  // of Extreme
};

}  // namespace hybrid_sphere::study
