#include "study/results_file.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "scene/tree_place.hpp"
#include "study/fnv1a.hpp"
#include "study/hdf5.hpp"

namespace hybrid_sphere::study {
namespace {

using hdf5::Handle;

constexpr const char* format = "hybrid_sphere study 1";

hid_t type_of(const Column& column) {
  return column.type == Column::Type::real ? H5T_NATIVE_DOUBLE : H5T_NATIVE_INT32;
}

void write_head(hid_t file, const Results& results) {
  const Study& study = results.study();
  hdf5::set_attribute(file, "format", std::string(format));
  hdf5::set_attribute(file, "version", std::string(HYBRID_SPHERE_VERSION));
  hdf5::set_attribute(file, "runs", study.runs);
  hdf5::set_attribute(file, "seed", study.seed);
  hdf5::set_attribute(file, "sample", std::string(to_string(study.sampling)));
  hdf5::set_attribute(file, "duration", study.duration);
  // Datasets, as an attribute holds no more than 64 kB.
  hdf5::write(file, "study", std::vector<std::string>{study.text});
  hdf5::write(file, "scene", std::vector<std::string>{scene::to_yaml(study.scene_tree)});
}

Handle create_column(hid_t file, const Column& column, const Study& study) {
  std::vector<std::uint64_t> shape{study.runs};
  shape.insert(shape.end(), column.shape.begin(), column.shape.end());
  Handle dataset =
      hdf5::create_dataset(file, column.name, type_of(column), shape, std::min(study.chunk, study.runs));
  if (!column.unit.empty()) hdf5::set_attribute(dataset, "unit", column.unit);
  if (!column.comment.empty()) hdf5::set_attribute(dataset, "comment", column.comment);
  if (column.name.rfind("at/", 0) == 0) hdf5::set_attribute(dataset, "times", std::string("/times"));
  return dataset;
}

/// The bytes of a chunk in the file, which is never shorter than the others.
std::pair<bool, std::vector<unsigned char>> whole_chunk(const Results& results, std::uint64_t chunk,
                                                        std::size_t column) {
  const Study& study = results.study();
  const std::uint64_t runs = std::min(study.chunk, study.runs);
  auto encoded = results.encoded(chunk, column);
  if (results.runs_of(chunk) == runs) return encoded;
  const Column& shape = results.columns().all[column];
  std::vector<unsigned char> numbers = results.numbers(chunk, column);
  numbers.resize(shape.bytes() * runs);
  if (!encoded.first) return {false, numbers};
  return {true, packed(numbers.data(), numbers.size(), shape.bytes() / shape.size())};
}

void write_columns(hid_t file, const Results& results) {
  constexpr std::uint32_t unfiltered = 3;  // both filters left out
  const std::vector<Column>& columns = results.columns().all;
  std::vector<Handle> datasets;
  for (const Column& column : columns) datasets.push_back(create_column(file, column, results.study()));
  for (std::uint64_t chunk = 0; chunk < results.chunks(); ++chunk) {
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (columns[i].size() == 0) continue;
      const auto [is_packed, bytes] = whole_chunk(results, chunk, i);
      std::vector<hsize_t> offset(1 + columns[i].shape.size());
      offset.front() = results.first_run(chunk);
      hdf5::require(H5Dwrite_chunk(datasets[i], H5P_DEFAULT, is_packed ? 0 : unfiltered, offset.data(),
                                   bytes.size(), bytes.data()),
                    columns[i].name);
    }
  }
}

/// Of codes: in tables beside the columns, as there may be a hundred thousand regions.
void write_names(hid_t file, const Results& results) {
  for (const Column& column : results.columns().all) {
    if (column.names.empty()) continue;
    const std::string table = "names/" + column.name.substr(column.name.rfind('/') + 1);
    if (H5Lexists(file, "names", H5P_DEFAULT) > 0 && H5Lexists(file, table.c_str(), H5P_DEFAULT) > 0)
      continue;
    hdf5::write(file, table, column.names);
  }
}

void write_refusals(hid_t file, const std::vector<Refusal>& refusals) {
  std::vector<std::uint64_t> runs;
  std::vector<std::string> paths;
  std::vector<std::string> values;
  for (const Refusal& refusal : refusals) {
    runs.push_back(refusal.run);
    paths.push_back(refusal.path);
    values.push_back(refusal.value);
  }
  hdf5::write(file, "refusals/run", runs);
  hdf5::write(file, "refusals/path", paths);
  hdf5::write(file, "refusals/value", values);
}

void write_summary(hid_t file, const NumberAnalysis& number, const Study& study) {
  const std::string group = "summary/" + number.name;
  const Summary& summary = number.summary;
  const bool is_there = summary.count > 0;
  hdf5::write(file, group + "/count", std::vector<std::uint64_t>{summary.count, summary.missing});
  if (!is_there) return;
  hdf5::write(file, group + "/mean", {summary.mean}, {}, number.unit);
  hdf5::write(file, group + "/deviation", {summary.deviation}, {}, number.unit);
  hdf5::write(file, group + "/least", {summary.least}, {}, number.unit);
  hdf5::write(file, group + "/greatest", {summary.greatest}, {}, number.unit);
  if (!summary.quantiles.empty()) {
    hdf5::write(file, group + "/quantiles", summary.quantiles, {summary.quantiles.size()}, number.unit);
  }
  if (study.summarize->histogram == 0 || summary.histogram.counts.empty()) return;
  const std::vector<double>& edges = summary.histogram.edges;
  hdf5::write(file, group + "/histogram_edges", edges, {edges.size()}, number.unit);
  hdf5::write(file, group + "/histogram_counts", summary.histogram.counts);
}

/// A row for each variable: value, low, high.
void write_indices(hid_t file, const std::string& name, const std::vector<SobolIndex>& indices) {
  std::vector<double> rows;
  for (const SobolIndex& index : indices) rows.insert(rows.end(), {index.value, index.low, index.high});
  hdf5::write(file, name, rows, {indices.size(), 3});
}

void write_analysis(hid_t file, const Results& results, const Analysis& analysis) {
  const Study& study = results.study();
  hdf5::write(file, "outcomes", std::vector<std::uint64_t>{analysis.done, analysis.halted, analysis.refused});
  if (!analysis.entered.empty()) {
    hdf5::write(file, "entered_regions", study.keep.entered);
    std::vector<double> rows;
    for (const Entered& entered : analysis.entered) {
      rows.insert(rows.end(), {entered.probability, entered.interval.low, entered.interval.high});
    }
    hdf5::write(file, "summary/entered", rows, {analysis.entered.size(), 3});
  }
  if (study.summarize && !study.summarize->quantiles.empty()) {
    hdf5::write(file, "summary/probabilities", study.summarize->quantiles,
                {study.summarize->quantiles.size()});
  }
  for (const NumberAnalysis& number : analysis.numbers) {
    if (study.summarize) write_summary(file, number, study);
    if (number.sensitivity.first.empty()) continue;
    write_indices(file, "sensitivity/" + number.name + "/first", number.sensitivity.first);
    write_indices(file, "sensitivity/" + number.name + "/total", number.sensitivity.total);
  }
  std::vector<std::string> variables;
  for (const Variable& variable : study.variables) variables.push_back(variable.path);
  hdf5::write(file, "variables", variables);
}

void sync_and_rename(const std::string& from, const std::string& to) {
  std::FILE* const written = std::fopen(from.c_str(), "rb+");
  const bool is_safe = written != nullptr && fsync(fileno(written)) == 0;
  const int why = errno;
  if (written != nullptr) std::fclose(written);
  errno = why;
  if (is_safe && std::rename(from.c_str(), to.c_str()) == 0) return;
  throw FileError("\"" + to + "\" cannot be written: " + std::strerror(errno));
}

}  // namespace

void write_results_file(const std::string& file, const Results& results, const Analysis& analysis) {
  const std::string beside = file + ".new";
  try {
    Handle whole = hdf5::create_file(beside);
    write_head(whole, results);
    if (!results.study().keep.times.empty()) {
      const std::vector<double>& times = results.study().keep.times;
      hdf5::write(whole, "times", times, {times.size()}, "s");
    }
    write_columns(whole, results);
    write_names(whole, results);
    write_refusals(whole, results.refusals());
    write_analysis(whole, results, analysis);
    hdf5::write(whole, "chunks/finished", std::vector<std::uint64_t>(results.chunks(), 1));
    hdf5::close(std::move(whole), file);
    sync_and_rename(beside, file);
  } catch (...) {
    std::remove(beside.c_str());
    throw;
  }
}

std::string identity_of(const Study& study) {
  const scene::Tree image =
      scene::at_place(study.scene_tree, {std::string("surface"), std::string("image"), std::string("file")});
  std::ostringstream picture;
  if (const auto name = image.as_text()) {
    const auto file = std::filesystem::path(study.scene_directory) / std::string(*name);
    picture << std::ifstream(file, std::ios::binary).rdbuf();
  }
  return std::string(format) + "\n" HYBRID_SPHERE_VERSION "\n" + std::to_string(study.text.size()) + "\n" +
         study.text + std::to_string(study.scene_text.size()) + "\n" + study.scene_text + "\n" +
         std::to_string(fnv1a(picture.str()));
}

}  // namespace hybrid_sphere::study
