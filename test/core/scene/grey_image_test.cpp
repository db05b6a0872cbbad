// Images as they come, whole and broken.

#include "scene/grey_image.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "support/limited_memory.hpp"

namespace hybrid_sphere::testing::grey_image_test {
namespace {

using scene::GreyImage;
using scene::ImageError;
using Levels = std::vector<std::uint32_t>;

constexpr std::uint32_t transparent = GreyImage::transparent;

std::string path_of(const std::string& name) { return std::string(TEST_DATA_DIR) + "/images/" + name; }

std::string content_of(const std::string& name) {
  std::ifstream file(path_of(name), std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

GreyImage image_in(const std::string& name) { return scene::read_grey_image(path_of(name)); }

GreyImage pnm(const std::string& content) { return scene::grey_image_from_pnm(content); }

void expect(const GreyImage& image, std::size_t width, std::size_t height, std::uint32_t white,
            const Levels& levels) {
  EXPECT_EQ(image.width, width);
  EXPECT_EQ(image.height, height);
  EXPECT_EQ(image.white, white);
  EXPECT_EQ(image.levels, levels);
}

TEST(PngImage, HasTheLevelsOfItsPixelsWhateverTheirDepth) {
  expect(image_in("grey_8.png"), 3, 2, 765, {0, 3 * 51, 3 * 255, 3 * 128, 3 * 254, 3});
  expect(image_in("grey_1.png"), 3, 2, 765, {765, 0, 765, 0, 765, 0});
  expect(image_in("grey_16.png"), 2, 1, 765, {0, 3 * 51});
}

TEST(PngImage, IsTheMeanOfItsColours) {
  expect(image_in("rgb.png"), 2, 1, 765, {30 + 60 + 90, 765});
  expect(image_in("palette.png"), 3, 1, 765, {0, 30 + 60 + 90, 765});
}

TEST(PngImage, IsUnknownWhereItIsFullyTransparent) {
  expect(image_in("rgba.png"), 3, 1, 765, {30 + 60 + 90, 30 + 60 + 90, transparent | 765});
}

TEST(PngImage, CutShortAnywhereIsRefusedOrHasAllItsPixels) {
  for (const char* name : {"grey_8.png", "rgba.png", "palette.png"}) {
    const std::string content = content_of(name);
    const Levels levels = scene::grey_image_from_png(content).levels;
    const std::size_t pixels_end = content.find("IEND") - 8;  // before the length of IEND and a checksum
    for (std::size_t size = 0; size < content.size(); ++size) {
      try {
        EXPECT_EQ(scene::grey_image_from_png(content.substr(0, size)).levels, levels) << name << ", " << size;
        EXPECT_GE(size, pixels_end - 4) << name;  // but for the checksum of the packed pixels themselves
      } catch (const ImageError&) {
      }
    }
  }
}

TEST(PngImage, WithAnyByteChangedIsRefusedOrReadWithoutACrash) {
  for (const char* name : {"grey_8.png", "rgba.png", "palette.png"}) {
    const std::string content = content_of(name);
    std::size_t refused = 0;
    for (std::size_t i = 0; i < content.size(); ++i) {
      std::string changed = content;
      changed[i] = static_cast<char>(changed[i] ^ 0x11);
      try {
        const GreyImage image = scene::grey_image_from_png(changed);
        EXPECT_EQ(image.levels.size(), image.width * image.height);
      } catch (const ImageError&) {
        ++refused;
      }
    }
    EXPECT_GT(refused, content.size() / 2) << name;  // the header and the pixels have checksums
  }
}

TEST(PngImage, AveragesOpacityWhereItIsAskedForAndThereIsSome) {
  const scene::GreyRules averages{true, false};
  expect(scene::read_grey_image(path_of("rgba.png"), averages), 3, 1, 1020,
         {30 + 60 + 90 + 255, 30 + 60 + 90 + 1, 765});
  expect(scene::read_grey_image(path_of("rgb.png"), averages), 2, 1, 765, {30 + 60 + 90, 765});
}

TEST(PngImage, HasItsLevelsAsTheyAreStoredOrAsTheyAreShown) {
  expect(scene::read_grey_image(path_of("gamma.png"), {false, true}), 4, 1, 765, {0, 3 * 80, 3 * 100, 765});
  const GreyImage shown = image_in("gamma.png");
  EXPECT_EQ(shown.levels[2], 3 * 167U);  // 255 (100/255)^(1/2.2) is 166.6
}

std::string bytes(std::uint64_t value, std::size_t count) {
  std::string text;
  for (std::size_t i = 0; i < count; ++i, value >>= 8U) text += static_cast<char>(value & 0xff);
  return text;
}

/// @param more  of the header, the palette; the pixels follow
std::string bmp(std::int32_t width, std::int32_t height, unsigned bits, const std::string& pixels,
                const std::string& more = "", unsigned compression = 0, unsigned header = 40,
                unsigned used = 0) {
  return "BM" + bytes(0, 8) + bytes(54 + more.size(), 4) + bytes(header, 4) +
         bytes(static_cast<std::uint32_t>(width), 4) + bytes(static_cast<std::uint32_t>(height), 4) +
         bytes(1, 2) + bytes(bits, 2) + bytes(compression, 4) + bytes(0, 12) + bytes(used, 4) + bytes(0, 4) +
         more + pixels;
}

GreyImage read_bmp(const std::string& content, bool averages_opacity = false) {
  return scene::grey_image_from_bmp(content, {averages_opacity, false});
}

TEST(BmpImage, HasTheLevelsOfEachOfItsFormats) {
  const std::string padded = std::string("\x01\x02\x03\xff\xff\xff\0\0", 8) + std::string("abcdef\0\0", 8);
  expect(read_bmp(bmp(2, 2, 24, padded)), 2, 2, 765, {'a' + 'b' + 'c', 'd' + 'e' + 'f', 6, 765});
  expect(read_bmp(bmp(2, -2, 24, padded)), 2, 2, 765, {6, 765, 'a' + 'b' + 'c', 'd' + 'e' + 'f'});
  const std::string two = bytes(0x000000, 4) + bytes(0x030201, 4);
  expect(read_bmp(bmp(10, 1, 1, "\x80\x40" + bytes(0, 2), two)), 10, 1, 765, {6, 0, 0, 0, 0, 0, 0, 0, 0, 6});
  expect(read_bmp(bmp(3, 1, 4, "\x10\x10" + bytes(0, 2), two, 0, 40, 2)), 3, 1, 765, {6, 0, 6});
  expect(read_bmp(bmp(2, 1, 8, bytes(0x0001, 4), two, 0, 40, 2)), 2, 1, 765, {6, 0});
  const std::string os2 = "BM" + bytes(0, 8) + bytes(32, 4) + bytes(12, 4) + bytes(1, 2) + bytes(1, 2) +
                          bytes(1, 2) + bytes(1, 2) + bytes(0x030201, 3) + bytes(0xffffff, 3) + bytes(0, 4);
  expect(read_bmp(os2), 1, 1, 765, {6});
}

TEST(BmpImage, HasOpacityUnlessItIsNowhere) {
  const std::string pixels = bytes(0xff010203, 4) + bytes(0x00010203, 4);
  expect(read_bmp(bmp(2, 1, 32, pixels)), 2, 1, 765, {6, transparent | 6});
  expect(read_bmp(bmp(2, 1, 32, pixels), true), 2, 1, 1020, {6 + 255, 6});
  expect(read_bmp(bmp(1, 1, 32, bytes(0x00010203, 4)), true), 1, 1, 765, {6});
  const auto masked = [](std::uint32_t opacity) {
    const std::string masks =
        bytes(0xff000000, 4) + bytes(0xff0000, 4) + bytes(0xff00, 4) + bytes(opacity, 4);
    return bmp(1, 1, 32, bytes(0x01020305, 4), masks, 3, 56);
  };
  expect(read_bmp(masked(0xff), true), 1, 1, 1020, {6 + 5});
  expect(read_bmp(masked(0), true), 1, 1, 765, {6});
}

TEST(BmpImage, IsRefusedWhenItsHeaderOrItsPixelsAreWrong) {
  const std::string whole = bmp(2, 2, 24, std::string(16, 'a'));
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_THROW(read_bmp(whole.substr(0, size)), ImageError) << size;
  const std::string black = bytes(0, 4);
  for (const std::string& content :
       {bmp(0, 2, 24, ""), bmp(-2, 2, 24, std::string(16, 'a')), bmp(2, 0, 24, ""),
        bmp(100000, 100000, 24, "a"), bmp(2, INT32_MIN, 24, "a"), bmp(1, 1, 16, black),
        bmp(1, 1, 24, black, "", 1), bmp(1, 1, 32, black, std::string(12, 'm'), 3),
        bmp(1, 1, 8, bytes(1, 4), black, 0, 40, 1), bmp(1, 1, 1, black, black, 0, 40, 3),
        bmp(1, 1, 24, black, "", 0, 39)})
    EXPECT_THROW(read_bmp(content), ImageError);
}

TEST(PnmImage, HasTheLevelsOfEachOfItsFormats) {
  expect(pnm("P1 # bitmap\n3 2\n1 0 1\n010"), 3, 2, 1, {0, 1, 0, 1, 0, 1});
  expect(pnm("P2\n2 1\n# a comment\n15\n0 15\n"), 2, 1, 15, {0, 15});
  expect(pnm("P3 1 2 255 1 2 3 255 255 255"), 1, 2, 765, {6, 765});
  expect(pnm(std::string("P4\n10 2\n") + "\x80\x40\x7f\x80"), 10, 2, 1,
         {0, 1, 1, 1, 1, 1, 1, 1, 1, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 1});
  expect(pnm(std::string("P5\n2 1\n255\n") + "\x80\xff"), 2, 1, 255, {128, 255});
  expect(pnm(std::string("P5\n2 1\n1000\n") + "\x03\xe8\x01\x02"), 2, 1, 1000, {1000, 258});
  expect(pnm(std::string("P6\n1 1\n255\n") + "\x01\x02\xff"), 1, 1, 765, {258});
}

TEST(PnmImage, IsRefusedWhenItsHeaderOrItsPixelsAreWrong) {
  for (const char* content : {"",
                              "P",
                              "P7\n1 1\n255\na",
                              "Q5\n1 1\n255\na",
                              "P5",
                              "P5\n",
                              "P5\n2",
                              "P5\n2 2",
                              "P5\n2 2\n",
                              "P5\n2 2\n255",
                              "P5\n2 2\n255\nabc",
                              "P5\n-2 2\n255\nabcd",
                              "P5\nx 2\n255\nabcd",
                              "P5\n2 2\n0\nabcd",
                              "P5\n2 2\n65536\nabcdabcd",
                              "P5\n99999999999999999999 1\n255\na",
                              "P2\n2 1\n15\n0 16",
                              "P2\n2 1\n15\n0 x",
                              "P2\n2 1\n15\n0 ",
                              "P1\n2 1\n0 2",
                              "P4\n9 1\na",
                              "P5 1 1 99 d",
                              "P6\n1 1\n255\nab",
                              "P5\n0 0\n255\n"}) {
    EXPECT_THROW(pnm(content), ImageError) << content;
  }
}

TEST(GreyImage, OfAHugeHeaderIsRefusedBeforeItTakesTheMemory) {
  const long before = peak_memory_kb();
  EXPECT_THROW(image_in("huge.png"), ImageError);          // 10^10 pixels
  EXPECT_THROW(image_in("fewer_pixels.pgm"), ImageError);  // 16 10^6 pixels, 64 MB as levels
  EXPECT_LT(peak_memory_kb() - before, 32000) << "kB";
}

}  // namespace
}  // namespace hybrid_sphere::testing::grey_image_test
