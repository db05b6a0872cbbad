// Against the known answers of Random123 (its file kat_vectors) and of the draft that describes FNV.

#include "study/stream.hpp"

#include <gtest/gtest.h>

#include <set>

namespace hybrid_sphere::testing::stream_test {
namespace {

using namespace study;
using Words = std::array<std::uint64_t, 4>;

Words philox(const Words& counter, std::uint64_t key_0, std::uint64_t key_1) {
  const auto words = r123::Philox4x64()({{counter[0], counter[1], counter[2], counter[3]}}, {{key_0, key_1}});
  return {words[0], words[1], words[2], words[3]};
}

TEST(Stream, IsMadeByPhiloxAsPublished) {
  constexpr std::uint64_t ones = ~std::uint64_t{0};
  EXPECT_EQ(philox({0, 0, 0, 0}, 0, 0),
            (Words{0x16554d9eca36314c, 0xdb20fe9d672d0fdc, 0xd7e772cee186176b, 0x7e68b68aec7ba23b}));
  EXPECT_EQ(philox({ones, ones, ones, ones}, ones, ones),
            (Words{0x87b092c3013fe90b, 0x438c3c67be8d0224, 0x9cc7d7c69cd777b6, 0xa09caebf594f0ba0}));
  EXPECT_EQ(philox({0x243f6a8885a308d3, 0x13198a2e03707344, 0xa4093822299f31d0, 0x082efa98ec4e6c89},
                   0x452821e638d01377, 0xbe5466cf34e90c6c),
            (Words{0xa528f45403e61d95, 0x38c72dbd566e9788, 0xa5a1610e72fd18b5, 0x57bd43b5e52b7fe6}));
}

TEST(Stream, HasItsPlaceAsCounterAndItsNameAsKey) {
  const Stream stream{5, 6};
  EXPECT_EQ((Stream{0, 0}.words(0, 0, Purpose::place)), philox({0, 0, 0, 0}, 0, 0));
  EXPECT_EQ(stream.words(7, 1, Purpose::permutation), philox({7, 1, 0, 2}, 5, 6));
  EXPECT_EQ(stream.word(7, 1, Purpose::shift), philox({7, 1, 0, 1}, 5, 6)[0]);
}

TEST(Stream, HasNamesThatAreHashedAsPublished) {
  EXPECT_EQ(fnv1a(""), 0xcbf29ce484222325);
  EXPECT_EQ(fnv1a("a"), 0xaf63dc4c8601ec8c);
  EXPECT_EQ(fnv1a("foobar"), 0x85944171f73967e8);
}

TEST(UnitInterval, IsOpenAndHasItsNumbersHalfwayBetweenMultiples) {
  EXPECT_EQ(in_unit_interval(0), 0x1p-53);
  EXPECT_EQ(in_unit_interval(0xfff), 0x1p-53);
  EXPECT_EQ(in_unit_interval(0x1000), 3 * 0x1p-53);
  EXPECT_EQ(in_unit_interval(std::uint64_t{1} << 63), 0.5 + 0x1p-53);
  EXPECT_EQ(in_unit_interval(~std::uint64_t{0}), 1 - 0x1p-53);
}

}  // namespace
}  // namespace hybrid_sphere::testing::stream_test
