// The results of some runs as bytes, and back.

#include "study/chunk.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <stdexcept>

namespace hybrid_sphere::testing::chunk_test {
namespace {

using namespace study;
using Type = Column::Type;
using Bytes = std::vector<unsigned char>;

const std::vector<Column>& columns() {
  static const std::vector<Column> all = {
      {"real", {}, "", Type::real, {}, ""},       {"code", {}, "", Type::code, {}, ""},
      {"reals", {3}, "", Type::real, {}, ""},     {"codes", {3}, "", Type::code, {}, ""},
      {"matrix", {2, 5}, "", Type::real, {}, ""}, {"code matrix", {7, 1}, "", Type::code, {}, ""}};
  return all;
}

std::size_t number_size(const Column& column) { return column.type == Type::real ? 8 : 4; }

/// The bytes of a column of a chunk.
Bytes raw(Chunk& chunk, std::size_t column) {
  const Column& shape = columns()[column];
  const void* const begin = shape.type == Type::real ? static_cast<void*>(chunk.reals(column, 0))
                                                     : static_cast<void*>(chunk.codes(column, 0));
  Bytes bytes(shape.bytes() * chunk.count());
  std::memcpy(bytes.data(), begin, bytes.size());
  return bytes;
}

void expect_reads_back(Chunk& chunk) {
  Bytes encoded{1, 2, 3};  // of an earlier chunk
  chunk.encode(encoded);
  const std::vector<EncodedColumn> found = columns_in(encoded, columns().size());
  ASSERT_EQ(found.size(), columns().size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    const Bytes expected = raw(chunk, i);
    EXPECT_EQ(unpacked(found[i], number_size(columns()[i]), expected.size()), expected)
        << columns()[i].name << " of " << chunk.count() << " runs";
    EXPECT_LE(found[i].size, expected.size());
  }
  const std::vector<Refusal> refusals = refusals_in(encoded, columns().size());
  ASSERT_EQ(refusals.size(), chunk.refusals.size());
  for (std::size_t i = 0; i < refusals.size(); ++i) {
    EXPECT_EQ(refusals[i].run, chunk.refusals[i].run);
    EXPECT_EQ(refusals[i].path, chunk.refusals[i].path);
    EXPECT_EQ(refusals[i].value, chunk.refusals[i].value);
  }
}

/// Fills it with numbers of one kind: 0: noise, 1: the same number, 2: whole ones, 3: every bit pattern.
void fill(Chunk& chunk, int kind, std::mt19937_64& random) {
  const auto number = [&]() -> double {
    if (kind == 0) return std::uniform_real_distribution<double>()(random);
    if (kind == 1) return 0.1;
    if (kind == 2) return static_cast<double>(random() % 5);
    const double special[] = {-0.0,
                              std::numeric_limits<double>::infinity(),
                              std::numeric_limits<double>::denorm_min(),
                              std::numeric_limits<double>::quiet_NaN(),
                              -std::numeric_limits<double>::quiet_NaN(),
                              std::numeric_limits<double>::max()};
    return special[random() % std::size(special)];
  };
  for (std::size_t i = 0; i < columns().size(); ++i) {
    for (std::uint64_t run = 0; run < chunk.count(); ++run) {
      for (std::size_t k = 0; k < columns()[i].size(); ++k) {
        if (columns()[i].type == Type::real) {
          chunk.reals(i, run)[k] = number();
        } else {
          chunk.codes(i, run)[k] =
              kind == 3 ? static_cast<std::int32_t>(random()) : static_cast<std::int32_t>(number());
        }
      }
    }
  }
}

TEST(Chunk, BeginsWithEverythingMissing) {
  Chunk chunk(columns());
  std::mt19937_64 random;
  for (const std::uint64_t count : {std::uint64_t{1}, std::uint64_t{5}, std::uint64_t{2}}) {
    chunk.refusals.push_back({1, "a", "b"});
    chunk.begin(7, count);
    EXPECT_EQ(chunk.first(), 7U);
    EXPECT_EQ(chunk.count(), count);
    EXPECT_TRUE(chunk.refusals.empty());
    for (std::size_t i = 0; i < columns().size(); ++i) {
      for (std::size_t k = 0; k < columns()[i].size() * count; ++k) {
        if (columns()[i].type == Type::real) {
          EXPECT_TRUE(std::isnan(chunk.reals(i, 0)[k]));
        } else {
          EXPECT_EQ(chunk.codes(i, 0)[k], -1);
        }
      }
    }
    fill(chunk, 0, random);
  }
}

TEST(Chunk, KeepsTheNumbersOfEachRunApart) {
  Chunk chunk(columns());
  chunk.begin(0, 3);
  double next = 0;
  for (std::size_t i = 0; i < columns().size(); ++i) {
    for (std::uint64_t run = 0; run < 3; ++run) {
      for (std::size_t k = 0; k < columns()[i].size(); ++k) {
        if (columns()[i].type == Type::real) chunk.reals(i, run)[k] = next++;
        if (columns()[i].type == Type::code) chunk.codes(i, run)[k] = static_cast<std::int32_t>(next++);
      }
    }
  }
  double expected = 0;
  for (std::size_t i = 0; i < columns().size(); ++i) {
    for (std::size_t k = 0; k < 3 * columns()[i].size(); ++k) {
      EXPECT_EQ(columns()[i].type == Type::real ? chunk.reals(i, 0)[k] : chunk.codes(i, 0)[k], expected++);
    }
  }
}

TEST(Chunk, ReadsBackToTheBit) {
  std::mt19937_64 random(3);
  Chunk chunk(columns());
  for (const std::uint64_t count : {1U, 2U, 3U, 7U, 8U, 16U, 257U, 1000U}) {
    chunk.begin(1000, count);
    expect_reads_back(chunk);
    for (const int kind : {0, 1, 2, 3}) {
      chunk.begin(0, count);
      fill(chunk, kind, random);
      expect_reads_back(chunk);
    }
  }
}

TEST(Chunk, KeepsWhatWasRefused) {
  Chunk chunk(columns());
  chunk.begin(std::uint64_t{1} << 40U, 2);
  chunk.refusals = {{(std::uint64_t{1} << 40U) + 1, "surface.regions[0].friction", "-1"},
                    {0, "", ""},
                    {1, std::string(100000, 'x'), std::string("a\0b", 3)}};
  expect_reads_back(chunk);
}

TEST(Chunk, PacksWhatRepeats) {
  std::mt19937_64 random(3);
  Chunk chunk(columns());
  chunk.begin(0, 1000);
  Bytes missing;
  chunk.encode(missing);
  fill(chunk, 0, random);
  Bytes noise;
  chunk.encode(noise);
  EXPECT_LT(missing.size(), noise.size() / 20);
}

TEST(Chunk, CannotBeReadFromOtherBytes) {
  std::mt19937_64 random(3);
  Chunk chunk(columns());
  chunk.begin(0, 5);
  fill(chunk, 2, random);
  chunk.refusals = {{1, "path", "value"}};
  Bytes encoded;
  chunk.encode(encoded);
  const Bytes whole = encoded;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    encoded.assign(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_THROW(refusals_in(encoded, columns().size()), std::runtime_error) << size;
  }
  encoded.assign(200, 0xff);
  EXPECT_THROW(columns_in(encoded, columns().size()), std::runtime_error);
  EXPECT_THROW(refusals_in(encoded, columns().size()), std::runtime_error);
}

TEST(Chunk, KeepsOneRunOfWhatAllHave) {
  Chunk chunk(columns());
  chunk.begin(0, 64);  // all is missing
  Bytes encoded;
  chunk.encode(encoded);
  const std::vector<EncodedColumn> found = columns_in(encoded, columns().size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_TRUE(found[i].is_constant);
    EXPECT_EQ(found[i].size, columns()[i].bytes());
    const std::size_t size = columns()[i].bytes() * 64;
    EXPECT_THROW(unpacked(found[i], number_size(columns()[i]), size + 1), std::runtime_error);
  }
}

TEST(Chunk, IsRefusedWhereAColumnHasAnotherSize) {
  Chunk chunk(columns());
  chunk.begin(0, 64);
  for (std::size_t i = 0; i < columns().size(); ++i) {
    if (columns()[i].type == Type::real) {
      *chunk.reals(i, 0) = 1;
    } else {
      *chunk.codes(i, 0) = 1;
    }
  }
  Bytes encoded;
  chunk.encode(encoded);
  const std::vector<EncodedColumn> found = columns_in(encoded, columns().size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    const std::size_t size = columns()[i].bytes() * 64;
    EXPECT_TRUE(found[i].is_packed);
    for (const std::size_t other : {size - number_size(columns()[i]), size + number_size(columns()[i])}) {
      EXPECT_THROW(unpacked(found[i], number_size(columns()[i]), other), std::runtime_error);
    }
  }
  const Bytes plain(16);
  EXPECT_THROW(unpacked({false, false, plain.data(), plain.size()}, 8, 24), std::runtime_error);
}

TEST(Packing, ShufflesAsHdf5Does) {
  // Bytes of the same place in each number stand together: HDF5 User's Guide, the shuffle filter.
  const std::uint32_t numbers[] = {0x04030201, 0x14131211, 0x24232221};
  Bytes bytes(sizeof numbers);
  std::memcpy(bytes.data(), numbers, sizeof numbers);
  const Bytes result = packed(bytes.data(), bytes.size(), 4);
  EXPECT_EQ(unpacked({true, false, result.data(), result.size()}, 1, bytes.size()),
            (Bytes{0x01, 0x11, 0x21, 0x02, 0x12, 0x22, 0x03, 0x13, 0x23, 0x04, 0x14, 0x24}));
  EXPECT_EQ(unpacked({true, false, result.data(), result.size()}, 4, bytes.size()), bytes);
}

}  // namespace
}  // namespace hybrid_sphere::testing::chunk_test
