#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <tuple>
#include <unordered_set>

#include "scene/map_reader.hpp"
#include "scene/printable.hpp"
#include "scene/read_tree.hpp"
#include "scene/yaml.hpp"
#include "study/columns.hpp"
#include "study/read_correlation.hpp"
#include "study/read_distribution.hpp"
#include "study/study.hpp"
#include "text/nearest.hpp"
#include "text/refusal.hpp"

namespace hybrid_sphere::study {
namespace {

using scene::MapReader;
using scene::SceneError;
using scene::Tree;

constexpr double most_runs = 1e12;
constexpr std::size_t most_kept = 10000;
constexpr scene::Range runs_range{1, most_runs, "", 0};
constexpr scene::Range seed_range{0, 9007199254740991, "", 0};  // 2^53 - 1
constexpr scene::Range duration_range{0, 1e12, "[s]"};
constexpr scene::Range probability_range{0, 1, "", 0};
constexpr scene::Range few_range{0, most_kept, "", 0};
constexpr scene::Range levels_range{1, 1e6, "", 0};
constexpr scene::Range chunk_range{1, 1e6, "", 0};

std::uint64_t read_count(const Tree& tree, const std::string& path, const scene::Range& range) {
  const double number = scene::read_number(tree, path, range);
  if (number != std::floor(number)) {
    throw SceneError(path, tree.describe(), "a whole number, " + range.describe());
  }
  return static_cast<std::uint64_t>(number);
}

/// One of some words.
template <class Word, std::size_t count>
Word read_word_of(const Tree& tree, const std::string& path, const Word (&words)[count]) {
  std::vector<const char*> names;
  for (const Word word : words) names.push_back(to_string(word));
  const std::string name = scene::read_word(tree, path, names);
  return *std::find_if(std::begin(words), std::end(words),
                       [&](Word word) { return name == to_string(word); });
}

/// Some of them.
template <class Word, std::size_t count>
std::vector<Word> read_words(const Tree& tree, const std::string& path, const Word (&words)[count]) {
  const auto list = tree.as_list();
  if (!list) {
    std::string allowed = "a list of";
    for (const Word& word : words) allowed += std::string(&word == words ? " " : ", ") + to_string(word);
    throw SceneError(path, tree.describe(), allowed);
  }
  std::vector<Word> result;
  for (std::size_t i = 0; i < list->size(); ++i) {
    const std::string place = path + "[" + std::to_string(i) + "]";
    const Word word = read_word_of((*list)[i], place, words);
    if (std::find(result.begin(), result.end(), word) != result.end()) {
      throw SceneError(place, (*list)[i].describe(), "each word once");
    }
    result.push_back(word);
  }
  return result;
}

constexpr StateField all_fields[] = {
    StateField::position,    StateField::velocity, StateField::angular_velocity,
    StateField::orientation, StateField::slip,     StateField::energy,
    StateField::stage,       StateField::mode,     StateField::region};
constexpr Extreme all_extremes[] = {Extreme::speed, Extreme::spin, Extreme::slip, Extreme::energy_lost};
constexpr Sampling all_samplings[] = {Sampling::random, Sampling::latin_hypercube, Sampling::sobol,
                                      Sampling::grid};

std::vector<double> read_times(const Tree& tree, const std::string& path, double duration) {
  const auto list = tree.as_list();
  const scene::Range range{0, duration, "[s], ascending, up to the duration", 0};
  if (!list || list->size() == 0 || list->size() > most_kept) {
    throw SceneError(path, tree.describe(), "a list of 1 to 10000 times " + range.describe());
  }
  std::vector<double> times;
  for (std::size_t i = 0; i < list->size(); ++i) {
    const std::string place = path + "[" + std::to_string(i) + "]";
    times.push_back(scene::read_number((*list)[i], place, range));
    if (i > 0 && !(times[i] > times[i - 1])) {
      throw SceneError(place, (*list)[i].describe(), "times in ascending order");
    }
  }
  return times;
}

std::vector<std::string> read_regions(const Tree& tree, const std::string& path, const scene::Scene& scene) {
  const auto list = tree.as_list();
  if (!list || list->size() == 0 || list->size() > most_kept) {
    throw SceneError(path, tree.describe(), "a list of names of regions");
  }
  std::vector<std::string> known{scene::base_name};
  for (const scene::Region& region : scene.surface.regions) known.push_back(region.name);
  const std::unordered_set<std::string_view> all(known.begin(), known.end());
  std::vector<std::string> names;
  for (std::size_t i = 0; i < list->size(); ++i) {
    const std::string place = path + "[" + std::to_string(i) + "]";
    const Tree item = (*list)[i];
    const auto text = item.as_text();
    const std::string name(text.value_or(""));
    if (!text || all.count(name) == 0) {
      throw SceneError(place, (*list)[i].describe(),
                       "the name of a region of the scene, or base; the nearest one is \"" +
                           text::nearest(name, known) + "\"");
    }
    if (std::find(names.begin(), names.end(), name) != names.end()) {
      throw SceneError(place, (*list)[i].describe(), "each region once");
    }
    names.push_back(name);
  }
  return names;
}

void read_extremes(const Tree& tree, const std::string& path, Keep& keep) {
  if (!tree.as_map()) {
    keep.extremes = read_words(tree, path, all_extremes);
    return;
  }
  const MapReader keys(tree, path, {"of", "instants"});
  keep.extremes = read_words(keys.require("of", "a list of speed, spin, slip, energy_lost"),
                             keys.path_of("of"), all_extremes);
  if (const Tree* instants = keys.find("instants")) {
    keep.instants = read_count(*instants, keys.path_of("instants"), few_range);
  }
}

Keep read_keep(const Tree& tree, const std::string& path, double duration, const scene::Scene& scene) {
  const MapReader keys(tree, path, {"end", "at", "switches", "entered", "extremes"});
  Keep keep;
  if (const Tree* end = keys.find("end")) keep.end = read_words(*end, keys.path_of("end"), all_fields);
  if (const Tree* at = keys.find("at")) {
    const MapReader inner(*at, keys.path_of("at"), {"times", "fields"});
    keep.times = read_times(inner.require("times", "a list of times [s]"), inner.path_of("times"), duration);
    keep.at = read_words(inner.require("fields", "a list of what is kept at these times"),
                         inner.path_of("fields"), all_fields);
  }
  if (const Tree* switches = keys.find("switches")) {
    const MapReader inner(*switches, keys.path_of("switches"), {"first"});
    const Tree* first = inner.find("first");
    keep.switches = first == nullptr ? 0 : read_count(*first, inner.path_of("first"), few_range);
  }
  if (const Tree* entered = keys.find("entered")) {
    keep.entered = read_regions(*entered, keys.path_of("entered"), scene);
  }
  if (const Tree* extremes = keys.find("extremes")) {
    read_extremes(*extremes, keys.path_of("extremes"), keep);
  }
  return keep;
}

Summarize read_summarize(const Tree& tree, const std::string& path) {
  const MapReader keys(tree, path, {"quantiles", "histogram"});
  Summarize summarize;
  if (const Tree* quantiles = keys.find("quantiles")) {
    const auto list = quantiles->as_list();
    if (!list || list->size() > most_kept) {
      throw SceneError(keys.path_of("quantiles"), quantiles->describe(),
                       "a list of up to 10000 probabilities");
    }
    summarize.quantiles =
        scene::read_numbers(*quantiles, keys.path_of("quantiles"), list->size(), probability_range);
  }
  if (const Tree* histogram = keys.find("histogram")) {
    summarize.histogram = read_count(*histogram, keys.path_of("histogram"), few_range);
  }
  return summarize;
}

/// A distribution, and for a grid how many levels it has.
Variable read_variable(const std::string& name, const Tree& tree, const std::string& path, bool is_grid) {
  Variable variable{name, {}, 1};
  const auto map = tree.as_map();
  const Tree* levels = map ? map->find("levels") : nullptr;
  if (levels == nullptr) {
    variable.distribution = read_distribution(tree, path);
  } else {
    if (!is_grid)
      throw SceneError(path + ".levels", levels->describe(), "not to give this key: sample is no grid");
    variable.levels = read_count(*levels, path + ".levels", levels_range);
    Tree::Map rest;
    for (const auto& [key, value] : *map) {
      if (key != "levels") rest.emplace_back(std::string(key), value);
    }
    if (rest.size() + 1 < map->size()) throw SceneError(path + ".levels", "a second value", "each key once");
    variable.distribution = read_distribution(rest, path);
  }
  if (const auto* values = std::get_if<Values>(&variable.distribution); values && is_grid) {
    if (levels != nullptr) {
      throw SceneError(path + ".levels", levels->describe(), "not to give this key: values are the levels");
    }
    variable.levels = values->values.size();
  } else if (is_grid && levels == nullptr) {
    throw SceneError::missing(path + ".levels", "the number of levels of a grid, " + levels_range.describe());
  }
  return variable;
}

std::vector<Variable> read_variables(const Tree& tree, const std::string& path, bool is_grid) {
  const auto map = tree.as_map();
  if (!map || map->size() == 0) {
    throw SceneError(path, tree.describe(), "a map from paths of the scene's numbers to distributions");
  }
  std::vector<Variable> variables;
  for (const auto& [key, value] : *map) {
    const std::string name(key);
    const std::string place = path + "." + scene::escaped(key);
    for (const Variable& other : variables) {
      if (other.path == name) throw SceneError(place, "the same path twice", "each path once");
    }
    variables.push_back(read_variable(name, value, place, is_grid));
  }
  return variables;
}

/// A file that is read once, as what is read from a pipe is gone.
/// @param what  in refusals: scene file "floor.yaml"
std::pair<std::string, Tree> read_file(const std::string& file, const std::string& what) {
  const std::size_t most = scene::YamlLimits().bytes + 1;
  errno = 0;
  std::ifstream in(file, std::ios::binary);
  std::string text;
  std::array<char, 1U << 16U> block{};
  while (in && text.size() < most) {
    in.read(block.data(), block.size());
    text.append(block.data(), static_cast<std::size_t>(in.gcount()));
  }
  if (!in.is_open() || in.bad()) throw SceneError(what + ": cannot be read: " + std::strerror(errno));
  try {
    return {text, scene::tree_from_yaml(text)};
  } catch (const SceneError& error) {
    throw SceneError(what + ": " + error.what());
  }
}

/// The scene itself, or that of the file that is named. Sets what the study has of it.
scene::Scene read_scene_of(const Tree& tree, const std::string& directory, Study& study) {
  study.scene_tree = tree;
  study.scene_directory = directory;
  std::string where = "scene.";
  if (!tree.as_map()) {
    const auto name = tree.as_text();
    if (!name) throw SceneError("scene", tree.describe(), "a scene, or the name of its file");
    const std::filesystem::path file = std::filesystem::path(directory) / std::string(*name);
    const std::string what = "scene file \"" + scene::escaped(file.string()) + "\"";
    std::tie(study.scene_text, study.scene_tree) = read_file(file.string(), what);
    study.scene_directory = file.parent_path().string();
    where = what + ": ";
  }
  try {
    return scene_of(study, study.scene_tree);
  } catch (const SceneError& error) {
    throw SceneError(where + error.what());
  }
}

std::uint64_t product_of_levels(const std::vector<Variable>& variables) {
  double product = 1;
  for (const Variable& variable : variables) product *= static_cast<double>(variable.levels);
  if (product > most_runs) {
    throw SceneError("vary", "a grid of " + text::shortest(product) + " points", "at most 1e12 points");
  }
  return static_cast<std::uint64_t>(product);
}

void read_runs(const MapReader& keys, Study& study) {
  const Tree* runs = keys.find("runs");
  if (runs != nullptr) study.runs = read_count(*runs, "runs", runs_range);
  if (study.sampling == Sampling::grid) {
    const std::uint64_t points = product_of_levels(study.variables);
    if (runs != nullptr && study.runs != points) {
      throw SceneError("runs", runs->describe(),
                       std::to_string(points) + ", the points of the grid, or not to give this key");
    }
    study.runs = points;
  } else if (runs == nullptr) {
    throw SceneError::missing("runs", runs_range.describe());
  }
}

/// What concerns several keys.
void check(const Study& study) {
  if (study.sensitivity && !study.correlations.empty()) {
    throw SceneError("sensitivity", "sobol together with correlate",
                     "independent variables: Sobol' indices of others are not defined");
  }
  if (study.sampling == Sampling::grid && (study.sensitivity || !study.correlations.empty())) {
    throw SceneError(study.sensitivity ? "sensitivity" : "correlate", "this key together with sample: grid",
                     "samples that are drawn: random, latin_hypercube, sobol");
  }
  const std::uint64_t group = study.variables.size() + 2;
  if (study.sensitivity && study.runs % group != 0) {
    throw SceneError(
        "runs", std::to_string(study.runs),
        "for Sobol' indices a multiple of " + std::to_string(group) + ", the number of variables and 2");
  }
  try {
    require_valid(design_of(study));
  } catch (const std::invalid_argument& error) {
    throw SceneError(error.what());
  }
}

/// A thousandth of the runs, but neither so few that sending takes longer than a cheap run nor more than four
/// thousand, or more than is kept in memory with ease.
void read_chunk(const Tree* chunk, const scene::Scene& scene, Study& study) {
  constexpr std::uint64_t usual_bytes = 1U << 24U;
  constexpr std::uint64_t most_bytes = 1U << 30U;  // a message of MPI has less than 2^31
  std::uint64_t bytes = 0;
  for (const Column& column : columns_of(study, scene).all) bytes += column.bytes();
  study.chunk = std::clamp<std::uint64_t>((study.runs + 1023) / 1024, 16, 4096);
  study.chunk = std::min(study.chunk, std::max<std::uint64_t>(usual_bytes / bytes, 1));
  if (chunk == nullptr) return;
  study.chunk = read_count(*chunk, "chunk", chunk_range);
  if (study.chunk > std::max<std::uint64_t>(most_bytes / bytes, 1)) {
    throw SceneError("chunk", chunk->describe(),
                     "up to " + std::to_string(most_bytes / bytes) + ", as each run leaves " +
                         std::to_string(bytes) + " bytes");
  }
}

Study read_study(const Tree& tree, const std::string& directory) {
  if (!tree.as_map()) throw SceneError("study", tree.describe(), "a map of keys");
  const MapReader keys(tree, "",
                       {"scene", "runs", "seed", "sample", "duration", "vary", "correlate", "keep",
                        "summarize", "sensitivity", "chunk"});
  Study study;
  const scene::Scene scene =
      read_scene_of(keys.require("scene", "a scene, or the name of its file"), directory, study);
  if (const Tree* seed = keys.find("seed")) study.seed = read_count(*seed, "seed", seed_range);
  if (const Tree* sample = keys.find("sample")) {
    study.sampling = read_word_of(*sample, "sample", all_samplings);
  }
  study.duration =
      scene::read_number(keys.require("duration", duration_range.describe()), "duration", duration_range);
  study.variables =
      read_variables(keys.require("vary", "a map from paths of the scene's numbers to distributions"), "vary",
                     study.sampling == Sampling::grid);
  if (const Tree* correlate = keys.find("correlate")) {
    study.correlations = read_correlations(*correlate, "correlate", study.variables);
  }
  study.keep =
      read_keep(keys.require("keep", "a map of what each run leaves: end, at, switches, entered, extremes"),
                "keep", study.duration, scene);
  if (const Tree* summarize = keys.find("summarize"))
    study.summarize = read_summarize(*summarize, "summarize");
  if (const Tree* sensitivity = keys.find("sensitivity")) {
    scene::read_word(*sensitivity, "sensitivity", {"sobol"});
    study.sensitivity = true;
  }
  read_runs(keys, study);
  check(study);
  read_chunk(keys.find("chunk"), scene, study);
  return study;
}

}  // namespace

Study read_study_text(const std::string& yaml, const std::string& directory) {
  Study study = read_study(scene::tree_from_yaml(yaml), directory);
  study.text = yaml;
  return study;
}

Study read_study_file(const std::string& file) {
  const auto [text, tree] = read_file(file, "study file \"" + scene::escaped(file) + "\"");
  Study study = read_study(tree, std::filesystem::path(file).parent_path().string());
  study.text = text;
  return study;
}

scene::Scene scene_of(const Study& study, const scene::Tree& tree) {
  return scene::read_scene(tree, study.scene_directory);
}

}  // namespace hybrid_sphere::study
