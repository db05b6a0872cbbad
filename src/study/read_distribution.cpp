#include "study/read_distribution.hpp"

#include <algorithm>
#include <numeric>

#include "scene/map_reader.hpp"
#include "text/refusal.hpp"

namespace hybrid_sphere::study {
namespace {

using scene::Keys;
using scene::MapReader;
using scene::Range;
using scene::SceneError;
using scene::Tree;

// Sums and differences of a few numbers, and the sum of all weights, stay finite.
constexpr double most = 1e300;
constexpr double least = 1e-300;
constexpr Range number_range{-most, most, "", least};
constexpr Range positive_range{least, most, "", least};
constexpr Range weight_range{0, most, "", least};
constexpr Range log_deviation_range{least, 100, "", least};
constexpr std::size_t most_values = 100000;
constexpr const char* allowed_values = "a list of 1 to 100000 numbers";

const Keys& kinds() {
  static const Keys keys{"uniform",   "log_uniform", "normal", "truncated_normal",
                         "lognormal", "triangular",  "values"};
  return keys;
}

double read_key(const MapReader& keys, const char* key, const Range& range) {
  return read_number(keys.require(key, range.describe()), keys.path_of(key), range);
}

/// A list of numbers that has a form such as "[low, high]".
std::vector<double> read_list(const Tree& tree, const std::string& path, std::size_t size, const Range& range,
                              const std::string& form) {
  const auto list = tree.as_list();
  if (!list || list->size() != size) throw SceneError(path, tree.describe(), form);
  return read_numbers(tree, path, size, range);
}

template <class Interval>
Interval read_interval(const Tree& tree, const std::string& path, const Range& range) {
  const std::vector<double> ends = read_list(tree, path, 2, range, "[low, high]");
  if (ends[0] >= ends[1]) throw SceneError(path, tree.describe(), "[low, high] with low < high");
  return {ends[0], ends[1]};
}

Normal read_normal(const Tree& tree, const std::string& path) {
  const MapReader keys(tree, path, {"mean", "deviation"});
  return {read_key(keys, "mean", number_range), read_key(keys, "deviation", positive_range)};
}

TruncatedNormal read_truncated_normal(const Tree& tree, const std::string& path) {
  const MapReader keys(tree, path, {"mean", "deviation", "low", "high"});
  const TruncatedNormal read{read_key(keys, "mean", number_range),
                             read_key(keys, "deviation", positive_range), read_key(keys, "low", number_range),
                             read_key(keys, "high", number_range)};
  if (read.low >= read.high) {
    throw SceneError(keys.path_of("high"), text::shortest(read.high),
                     "a number above that of low, " + text::shortest(read.low));
  }
  return read;
}

Lognormal read_lognormal(const Tree& tree, const std::string& path) {
  const MapReader keys(tree, path, {"median", "log_deviation"});
  return {read_key(keys, "median", positive_range), read_key(keys, "log_deviation", log_deviation_range)};
}

Triangular read_triangular(const Tree& tree, const std::string& path) {
  const std::vector<double> read = read_list(tree, path, 3, number_range, "[low, mode, high]");
  const double low = read[0];
  const double mode = read[1];
  const double high = read[2];
  if (low >= high) throw SceneError(path, tree.describe(), "[low, mode, high] with low < high");
  if (mode < low || mode > high) {
    throw SceneError(path + "[1]", text::shortest(mode), Range{low, high, ""}.describe());
  }
  return {low, mode, high};
}

std::vector<double> read_choices(const Tree& tree, const std::string& path) {
  const auto list = tree.as_list();
  if (!list || list->size() == 0 || list->size() > most_values) {
    throw SceneError(path, list ? "a list of " + std::to_string(list->size()) : tree.describe(),
                     allowed_values);
  }
  return read_numbers(tree, path, list->size(), number_range);
}

std::vector<double> read_weights(const Tree& tree, const std::string& path, std::size_t size) {
  const std::string form = "a list of " + std::to_string(size) + " numbers, a weight of each value";
  std::vector<double> weights = read_list(tree, path, size, weight_range, form);
  if (std::all_of(weights.begin(), weights.end(), [](double weight) { return weight == 0; })) {
    throw SceneError(path, tree.describe(), "weights that are not all 0");
  }
  return weights;
}

/// @param weights  as many as values
Values in_order(const std::vector<double>& values, const std::vector<double>& weights) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t i, std::size_t j) { return values[i] < values[j]; });
  Values made;
  double sum = 0;
  for (const std::size_t i : order) {
    made.values.push_back(values[i]);
    made.until.push_back(sum += weights[i]);
  }
  for (double& until : made.until) until /= sum;
  return made;
}

Values read_values(const Tree& tree, const std::string& path) {
  if (!tree.as_map()) {
    const std::vector<double> values = read_choices(tree, path);
    return in_order(values, std::vector<double>(values.size(), 1));
  }
  const MapReader keys(tree, path, {"values", "weights"});
  const std::vector<double> values =
      read_choices(keys.require("values", allowed_values), keys.path_of("values"));
  const Tree& weights = keys.require("weights", "a list of numbers, a weight of each value");
  return in_order(values, read_weights(weights, keys.path_of("weights"), values.size()));
}

}  // namespace

Distribution read_distribution(const Tree& tree, const std::string& path) {
  const MapReader keys(tree, path, kinds());
  const std::size_t given = tree.as_map()->size();
  if (given != 1) {
    std::string allowed = "exactly one of ";
    for (const char* kind : kinds()) allowed += (kind == kinds().front() ? "" : ", ") + std::string(kind);
    throw SceneError(path, given == 0 ? "no distribution" : std::to_string(given) + " distributions",
                     allowed);
  }
  const auto [kind, value] = (*tree.as_map())[0];
  const std::string place = keys.path_of(kind);
  if (kind == "uniform") return read_interval<Uniform>(value, place, number_range);
  if (kind == "log_uniform") return read_interval<LogUniform>(value, place, positive_range);
  if (kind == "normal") return read_normal(value, place);
  if (kind == "truncated_normal") return read_truncated_normal(value, place);
  if (kind == "lognormal") return read_lognormal(value, place);
  if (kind == "triangular") return read_triangular(value, place);
  return read_values(value, place);
}

}  // namespace hybrid_sphere::study
