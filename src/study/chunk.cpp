#include "study/chunk.hpp"

#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <stdexcept>

namespace hybrid_sphere::study {
namespace {

constexpr int level = 1;  // of zlib: what takes longer saves little

template <class Value>
void append(std::vector<unsigned char>& out, Value value) {
  const std::size_t end = out.size();
  out.resize(end + sizeof value);
  std::memcpy(out.data() + end, &value, sizeof value);
}

void append_text(std::vector<unsigned char>& out, const std::string& text) {
  append(out, static_cast<std::uint32_t>(text.size()));
  out.insert(out.end(), text.begin(), text.end());
}

/// Reads what append() has written.
class Reader {
 public:
  explicit Reader(const std::vector<unsigned char>& bytes) : bytes_(bytes) {}

  template <class Value>
  Value value() {
    Value value;
    std::memcpy(&value, take(sizeof value), sizeof value);
    return value;
  }
  const unsigned char* take(std::size_t size) {
    if (size > bytes_.size() - at_) throw std::runtime_error("the bytes are not those of a chunk");
    at_ += size;
    return bytes_.data() + at_ - size;
  }
  std::string text() {
    const auto size = value<std::uint32_t>();
    const unsigned char* const begin = take(size);
    return {begin, begin + size};
  }

 private:
  const std::vector<unsigned char>& bytes_;
  std::size_t at_ = 0;
};

enum class Kind : std::uint8_t { plain, packed, constant };

/// Whether all parts of a size are the same.
bool is_constant(const unsigned char* bytes, std::size_t size, std::size_t part) {
  return size > part && std::memcmp(bytes, bytes + part, size - part) == 0;
}

/// Whether most numbers are those of the run before: the digits of others are noise that no packing shortens.
bool is_worth_packing(const unsigned char* bytes, std::size_t runs, std::size_t run_size) {
  constexpr std::size_t most = 256;
  const std::size_t seen = std::min(runs, most);
  std::size_t repeated = 0;
  std::size_t all = 0;
  for (std::size_t i = run_size; i < seen * run_size; i += sizeof(double), ++all) {
    if (std::memcmp(bytes + i, bytes + i - run_size, sizeof(double)) == 0) ++repeated;
  }
  return 4 * repeated > 3 * all;
}

/// Compresses, with memory that is kept from one call to the next.
class Packer {
 public:
  Packer() {
    if (deflateInit(&stream_, level) != Z_OK) throw std::runtime_error("zlib cannot begin");
  }
  ~Packer() { deflateEnd(&stream_); }
  Packer(const Packer&) = delete;
  Packer& operator=(const Packer&) = delete;

  std::vector<unsigned char> pack(std::vector<unsigned char>& bytes) {
    std::vector<unsigned char> result(deflateBound(&stream_, bytes.size()));
    stream_.next_in = bytes.data();
    stream_.avail_in = static_cast<uInt>(bytes.size());
    stream_.next_out = result.data();
    stream_.avail_out = static_cast<uInt>(result.size());
    if (deflate(&stream_, Z_FINISH) != Z_STREAM_END) throw std::runtime_error("zlib cannot compress");
    result.resize(stream_.total_out);
    deflateReset(&stream_);
    return result;
  }

 private:
  z_stream stream_{};
};

std::size_t number_size(const Column& column) { return column.bytes() / column.size(); }

}  // namespace

void Chunk::begin(std::uint64_t first, std::uint64_t count) {
  first_ = first;
  count_ = count;
  refusals.clear();
  offsets_.clear();
  sizes_.clear();
  std::size_t end = 0;
  for (const Column& column : *columns_) {
    offsets_.push_back(end);
    sizes_.push_back(column.size());
    end += (column.bytes() * count + 7) / 8 * 8;
  }
  bytes_.resize(end);
  for (std::size_t i = 0; i < columns_->size(); ++i) {
    const std::size_t numbers = sizes_[i] * count;
    if ((*columns_)[i].type == Column::Type::real) {
      std::fill_n(reals(i, 0), numbers, std::numeric_limits<double>::quiet_NaN());
    } else {
      std::fill_n(codes(i, 0), numbers, -1);
    }
  }
}

void Chunk::encode(std::vector<unsigned char>& out) const {
  out.clear();
  for (std::size_t i = 0; i < columns_->size(); ++i) {
    const Column& column = (*columns_)[i];
    const unsigned char* begin = bytes_.data() + offsets_[i];
    std::size_t size = column.bytes() * count_;
    Kind kind = Kind::plain;
    std::vector<unsigned char> shorter;
    if (is_constant(begin, size, column.bytes())) {
      kind = Kind::constant;
      size = column.bytes();
    } else if (column.type == Column::Type::code || is_worth_packing(begin, count_, column.bytes())) {
      shorter = packed(begin, size, number_size(column));
      if (shorter.size() < size) {
        kind = Kind::packed;
        begin = shorter.data();
        size = shorter.size();
      }
    }
    append(out, kind);
    append(out, static_cast<std::uint64_t>(size));
    out.insert(out.end(), begin, begin + size);
  }
  append(out, static_cast<std::uint64_t>(refusals.size()));
  for (const Refusal& refusal : refusals) {
    append(out, refusal.run);
    append_text(out, refusal.path);
    append_text(out, refusal.value);
  }
}

std::vector<EncodedColumn> columns_in(const std::vector<unsigned char>& encoded, std::size_t columns) {
  Reader reader(encoded);
  std::vector<EncodedColumn> result(columns);
  for (EncodedColumn& column : result) {
    const auto kind = reader.value<Kind>();
    column.is_packed = kind == Kind::packed;
    column.is_constant = kind == Kind::constant;
    column.size = reader.value<std::uint64_t>();
    column.bytes = reader.take(column.size);
  }
  return result;
}

std::vector<Refusal> refusals_in(const std::vector<unsigned char>& encoded, std::size_t columns) {
  Reader reader(encoded);
  for (std::size_t i = 0; i < columns; ++i) {
    reader.value<Kind>();
    reader.take(reader.value<std::uint64_t>());
  }
  std::vector<Refusal> refusals;
  const auto count = reader.value<std::uint64_t>();
  for (std::uint64_t i = 0; i < count; ++i) {
    const auto run = reader.value<std::uint64_t>();
    std::string path = reader.text();
    refusals.push_back({run, std::move(path), reader.text()});
  }
  return refusals;
}

std::vector<unsigned char> packed(const unsigned char* bytes, std::size_t size, std::size_t number_size) {
  static thread_local Packer packer;
  std::vector<unsigned char> shuffled(size);
  const std::size_t count = size / number_size;
  for (std::size_t b = 0; b < number_size; ++b) {
    for (std::size_t i = 0; i < count; ++i) shuffled[b * count + i] = bytes[i * number_size + b];
  }
  return packer.pack(shuffled);
}

std::vector<unsigned char> unpacked(const EncodedColumn& column, std::size_t number_size, std::size_t bytes) {
  if (column.is_constant) {
    std::vector<unsigned char> result;
    while (result.size() < bytes && column.size > 0) {
      result.insert(result.end(), column.bytes, column.bytes + column.size);
    }
    if (result.size() != bytes) throw std::runtime_error("the bytes are not those of a column");
    return result;
  }
  if (!column.is_packed) {
    if (column.size != bytes) throw std::runtime_error("the bytes are not those of a column");
    return {column.bytes, column.bytes + bytes};
  }
  std::vector<unsigned char> shuffled(bytes);
  uLongf length = bytes;
  if (uncompress(shuffled.data(), &length, column.bytes, column.size) != Z_OK || length != bytes) {
    throw std::runtime_error("the bytes are not those of a column");
  }
  std::vector<unsigned char> result(bytes);
  const std::size_t count = bytes / number_size;
  for (std::size_t b = 0; b < number_size; ++b) {
    for (std::size_t i = 0; i < count; ++i) result[i * number_size + b] = shuffled[b * count + i];
  }
  return result;
}

}  // namespace hybrid_sphere::study
