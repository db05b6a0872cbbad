#include "study/experiment.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <new>

#include "study/study_scene.hpp"

namespace hybrid_sphere::study {
namespace {

double& of(double (&greatest)[4], Extreme extreme) { return greatest[static_cast<std::size_t>(extreme)]; }

bool keeps_orientation(const Keep& keep) {
  const auto has = [](const std::vector<StateField>& fields) {
    return std::find(fields.begin(), fields.end(), StateField::orientation) != fields.end();
  };
  return has(keep.end) || has(keep.at);
}

}  // namespace

Experiment::Experiment(const Study& study)
    : study_(&study),
      samples_(study),
      variation_(variation_of(study)),
      columns_(columns_of(study, variation_.scene())),
      on_switch_([this](const Switch& event) { note_switch(event); }) {
  const Keep& keep = study.keep;
  follows_switches_ = keep.switches || !keep.extremes.empty();
  region_names_.emplace_back(scene::base_name);
  for (const scene::Region& region : variation_.scene().surface.regions) {
    region_names_.push_back(region.name);
  }
  for (const std::string& name : region_names_)
    regions_.emplace(name, static_cast<std::int32_t>(regions_.size()));
  for (const std::string& name : keep.entered) entered_.emplace(name, entered_.size());
  plan_visits();
}

/// The times that are kept and, between them, those at which extremes look.
void Experiment::plan_visits() {
  const Keep& keep = study_->keep;
  for (std::size_t i = 0; i < keep.times.size(); ++i) visits_.push_back({keep.times[i], i});
  const bool looks = std::any_of(keep.extremes.begin(), keep.extremes.end(),
                                 [](Extreme extreme) { return extreme != Extreme::energy_lost; });
  if (!looks) return;
  for (std::uint64_t i = 0; i <= keep.instants; ++i) {
    const auto part = static_cast<double>(i) / static_cast<double>(std::max<std::uint64_t>(keep.instants, 1));
    visits_.push_back({part * study_->duration, none});
  }
  std::stable_sort(visits_.begin(), visits_.end(),
                   [](const Visit& a, const Visit& b) { return a.time < b.time; });
}

scene::Tree Experiment::scene_of_run(std::uint64_t run) const {
  std::vector<double> sample(samples_.variables());
  samples_.values(run, 1, sample.data());
  scene::Tree tree = variation_.tree_of(sample.data());
  for (const char* key : {"file", "map"}) {  // of an image, which is found from anywhere then
    const scene::TreePlace place{std::string("surface"), std::string("image"), std::string(key)};
    const scene::Tree value = scene::at_place(tree, place);
    const auto name = value.as_text();
    if (!name) continue;
    const std::filesystem::path file = std::filesystem::path(study_->scene_directory) / std::string(*name);
    tree = scene::with_value(tree, place, std::filesystem::absolute(file).lexically_normal().string());
  }
  return tree;
}

void Experiment::run(std::uint64_t first, std::uint64_t count, Chunk& chunk,
                     const std::function<bool()>& should_stop) {
  constexpr std::uint64_t between_questions = 64;  // cheap runs
  chunk.begin(first, count);
  should_stop_ = &should_stop;
  const std::size_t variables = samples_.variables();
  values_.resize(count * variables);
  samples_.values(first, count, values_.data());
  for (std::uint64_t i = 0; i < count; ++i) {
    if (i % between_questions == 0 && should_stop()) throw Interrupted();
    const double* const sample = values_.data() + i * variables;
    for (std::size_t j = 0; j < variables; ++j) *chunk.reals(j, i) = sample[j];
    try {
      variation_.set(sample);
    } catch (const scene::SceneError& error) {
      *chunk.codes(columns_.outcome, i) = static_cast<std::int32_t>(Outcome::refused);
      chunk.refusals.push_back({first + i, error.path(), error.value()});
      continue;
    }
    run_one(i, chunk);
  }
}

/// A simulation of the present scene at its beginning.
void Experiment::begin() {
  if (simulation_ && variation_.varies_initial_state_alone()) {
    simulation_->set_initial_state(variation_.scene().initial_state);
    return;
  }
  simulation_ = std::make_unique<Simulation>(variation_.scene());
  if (!keeps_orientation(study_->keep)) simulation_->follow_orientation(false);
  simulation_->set_interrupt([this] { return (*should_stop_)(); });
  if (study_->keep.entered.empty()) return;
  simulation_->set_region_sink([this](double time, std::string_view region) { note_region(time, region); });
}

void Experiment::run_one(std::uint64_t run, Chunk& chunk) {
  chunk_ = &chunk;
  run_ = run;
  switches_ = 0;
  std::fill(std::begin(greatest_), std::end(greatest_), 0.0);
  begin();
  const Keep& keep = study_->keep;
  try {
    follow(run, chunk);
    *chunk.codes(columns_.outcome, run) = static_cast<std::int32_t>(Outcome::done);
    keep_state(keep.end, columns_.end, run, 0, chunk);
    for (std::size_t i = 0; i < keep.extremes.size(); ++i) {
      *chunk.reals(columns_.extremes + i, run) = of(greatest_, keep.extremes[i]);
    }
  } catch (const HaltedError& error) {
    if (error.stop() == Stop::out_of_memory) throw std::bad_alloc();  // no fault of the run
    *chunk.codes(columns_.outcome, run) = static_cast<std::int32_t>(Outcome::halted);
    *chunk.codes(columns_.stop, run) = static_cast<std::int32_t>(error.stop());
    *chunk.reals(columns_.stopped_at, run) = error.time();
  }
  if (keep.switches) *chunk.codes(columns_.switches, run) = switches_;
}

void Experiment::follow(std::uint64_t run, Chunk& chunk) {
  const Simulation::SwitchSink nobody;
  const Simulation::SwitchSink& on_switch = follows_switches_ ? on_switch_ : nobody;
  for (const Visit& visit : visits_) {
    simulation_->advance_to(visit.time, on_switch);
    if (visit.kept != none) {
      keep_state(study_->keep.at, columns_.at, run, visit.kept, chunk);
    } else {
      const State& state = simulation_->state();
      note_extremes(state.twist, state.slip.norm());
    }
  }
  simulation_->advance_to(study_->duration, on_switch);
  if (study_->keep.extremes.empty()) return;
  const State& state = simulation_->state();
  note_extremes(state.twist, state.slip.norm());
}

/// @param first  column of the fields @param place  in the list of times
void Experiment::keep_state(const std::vector<StateField>& fields, std::size_t first, std::uint64_t run,
                            std::size_t place, Chunk& chunk) {
  if (fields.empty()) return;
  const State& state = simulation_->state();
  std::size_t column = first;
  const auto put = [&](const auto& numbers) {
    double* const out = chunk.reals(column, run) + place * static_cast<std::size_t>(numbers.size());
    for (Eigen::Index i = 0; i < numbers.size(); ++i) out[i] = numbers[i];
  };
  const auto put_code = [&](std::int32_t code) { chunk.codes(column, run)[place] = code; };
  for (const StateField field : fields) {
    switch (field) {
      case StateField::position: put(state.position); break;
      case StateField::velocity: put(state.twist.velocity); break;
      case StateField::angular_velocity: put(state.twist.angular_velocity); break;
      case StateField::orientation: put(state.orientation.coeffs()); break;
      case StateField::slip: put(state.slip); break;
      case StateField::energy:
        chunk.reals(column, run)[place] = simulation_->sphere().kinetic_energy(state.twist);
        break;
      case StateField::stage: put_code(static_cast<std::int32_t>(state.stage)); break;
      case StateField::mode: put_code(static_cast<std::int32_t>(state.mode)); break;
      case StateField::region: {
        const auto region = regions_.find(state.region);
        if (region != regions_.end()) put_code(region->second);
        break;
      }
    }
    ++column;
  }
}

void Experiment::note_switch(const Switch& event) {
  const Keep& keep = study_->keep;
  const auto index = static_cast<std::uint64_t>(switches_++);
  of(greatest_, Extreme::energy_lost) += event.energy_before - event.energy_after;
  if (!keep.extremes.empty()) {
    note_extremes(event.before, event.slip_before.norm());
    note_extremes(event.after, 0);
  }
  if (!keep.switches || index >= *keep.switches) return;
  const std::size_t column = columns_.switches + 1;
  chunk_->reals(column, run_)[index] = event.time;
  chunk_->codes(column + 1, run_)[index] = static_cast<std::int32_t>(event.kind);
  chunk_->codes(column + 2, run_)[index] = static_cast<std::int32_t>(event.cause);
  double* const impulse = chunk_->reals(column + 3, run_) + 2 * index;
  impulse[0] = event.impulse.x();
  impulse[1] = event.impulse.y();
}

void Experiment::note_region(double time, std::string_view region) {
  const auto found = entered_.find(region);
  if (found == entered_.end()) return;
  double& first = chunk_->reals(columns_.entered, run_)[found->second];
  if (std::isnan(first)) first = time;
}

/// @param slip  0: not known
void Experiment::note_extremes(const Twist& twist, double slip) {
  const auto note = [this](Extreme extreme, double value) {
    of(greatest_, extreme) = std::max(of(greatest_, extreme), value);
  };
  note(Extreme::speed, twist.velocity.norm());
  note(Extreme::spin, twist.angular_velocity.norm());
  note(Extreme::slip, slip);
}

}  // namespace hybrid_sphere::study
