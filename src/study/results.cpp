#include "study/results.hpp"

#include <algorithm>
#include <cstring>
#include <limits>
#include <utility>

#include "hybrid_sphere/interrupt/interrupted.hpp"

namespace hybrid_sphere::study {
namespace {

/// A number of a column, NaN where it is missing. @param index  among all numbers of the column in a chunk
double number_at(const std::vector<unsigned char>& bytes, Column::Type type, std::size_t index) {
  double number = 0;
  if (type == Column::Type::real) {
    std::memcpy(&number, bytes.data() + index * sizeof number, sizeof number);
    return number;
  }
  std::int32_t code = 0;
  std::memcpy(&code, bytes.data() + index * sizeof code, sizeof code);
  return code < 0 ? std::numeric_limits<double>::quiet_NaN() : code;
}

}  // namespace

Results::Results(const Study& study, const Columns& columns, const Journal& journal,
                 std::function<bool()> should_stop)
    : study_(&study), columns_(&columns), journal_(&journal), should_stop_(std::move(should_stop)) {
  const std::uint64_t chunks = (study.runs + study.chunk - 1) / study.chunk;
  places_.resize(chunks);
  for (std::uint64_t chunk = 0; chunk < chunks; ++chunk) {
    if (should_stop_()) throw Interrupted();
    const std::vector<unsigned char> bytes = journal.read(chunk);
    for (const EncodedColumn& column : columns_in(bytes, columns.all.size())) {
      places_[chunk].push_back({static_cast<std::uint64_t>(column.bytes - bytes.data()), column.size,
                                column.is_packed, column.is_constant});
    }
    for (Refusal& refusal : refusals_in(bytes, columns.all.size())) refusals_.push_back(std::move(refusal));
  }
}

std::vector<unsigned char> Results::read(const Place& place, std::uint64_t chunk) const {
  if (should_stop_()) throw Interrupted();
  return journal_->read(chunk, place.begin, place.size);
}

std::uint64_t Results::runs_of(std::uint64_t chunk) const {
  return std::min(study_->chunk, study_->runs - first_run(chunk));
}

std::pair<bool, std::vector<unsigned char>> Results::encoded(std::uint64_t chunk, std::size_t column) const {
  const Place& place = places_[chunk][column];
  if (!place.is_constant) return {place.is_packed, read(place, chunk)};
  const Column& shape = columns_->all[column];
  const std::vector<unsigned char> bytes = numbers(chunk, column);
  return {true, packed(bytes.data(), bytes.size(), shape.bytes() / shape.size())};
}

std::vector<unsigned char> Results::numbers(std::uint64_t chunk, std::size_t column) const {
  const Place& place = places_[chunk][column];
  const std::vector<unsigned char> bytes = read(place, chunk);
  const Column& shape = columns_->all[column];
  return unpacked({place.is_packed, place.is_constant, bytes.data(), bytes.size()},
                  shape.bytes() / shape.size(), shape.bytes() * runs_of(chunk));
}

std::vector<double> Results::values(std::uint64_t chunk, std::size_t column, std::size_t element) const {
  const Column& shape = columns_->all[column];
  const std::vector<unsigned char> bytes = numbers(chunk, column);
  std::vector<double> values(runs_of(chunk));
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = number_at(bytes, shape.type, i * shape.size() + element);
  }
  return values;
}

/// The numbers of all runs; null if they are too many to be read for several elements at once.
const double* Results::all_of(std::size_t column, std::size_t element) const {
  constexpr std::uint64_t most = 1U << 23U;  // numbers, 64 MB
  const Column& shape = columns_->all[column];
  const std::uint64_t runs = study_->runs;
  const std::size_t several = std::min<std::uint64_t>(most / runs, shape.size());
  if (several < 2) return nullptr;
  const bool is_read =
      read_.column == column && element >= read_.first && element - read_.first < read_.count;
  if (!is_read) read_elements(column, element, std::min(several, shape.size() - element));
  return read_.numbers.data() + (element - read_.first) * runs;
}

void Results::read_elements(std::size_t column, std::size_t first, std::size_t count) const {
  const Column& shape = columns_->all[column];
  read_ = {column, first, 0, std::vector<double>(count * study_->runs)};
  for (std::uint64_t chunk = 0; chunk < chunks(); ++chunk) {
    const std::vector<unsigned char> bytes = numbers(chunk, column);
    double* const to = read_.numbers.data() + first_run(chunk);
    for (std::uint64_t i = 0; i < runs_of(chunk); ++i) {
      for (std::size_t k = 0; k < count; ++k) {
        to[k * study_->runs + i] = number_at(bytes, shape.type, i * shape.size() + first + k);
      }
    }
  }
  read_.count = count;
}

Blocks Results::blocks(std::size_t column, std::size_t element) const {
  return [this, column, element](const std::function<void(const double*, std::size_t)>& take) {
    const double* const all = all_of(column, element);
    for (std::uint64_t chunk = 0; chunk < chunks(); ++chunk) {
      if (all != nullptr) {
        take(all + first_run(chunk), runs_of(chunk));
      } else {
        const std::vector<double> numbers = values(chunk, column, element);
        take(numbers.data(), numbers.size());
      }
    }
  };
}

std::vector<std::uint64_t> Results::counts_of_codes(std::size_t column, std::size_t codes) const {
  std::vector<std::uint64_t> counts(codes + 1);
  blocks(column, 0)([&](const double* values, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      const bool is_code = values[i] >= 0 && values[i] < static_cast<double>(codes);
      ++counts[is_code ? static_cast<std::size_t>(values[i]) : codes];
    }
  });
  return counts;
}

}  // namespace hybrid_sphere::study
