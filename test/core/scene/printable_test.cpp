// What is echoed in a message is UTF-8, whatever the name was: Python's decoders refuse anything else.

#include "scene/printable.hpp"

#include <gtest/gtest.h>

#include "scene/read_tree.hpp"

namespace hybrid_sphere::testing::printable_test {
namespace {

using scene::escaped;
using scene::is_utf8;
using scene::printable;
using scene::Tree;

TEST(Printable, TextOfUtf8IsShownAsItIs) {
  for (const char* text : {"ice", "\xc3\xa4", "\xe2\x82\xac", "\xf0\x9f\x98\x80", "\xf4\x8f\xbf\xbf", ""}) {
    EXPECT_TRUE(is_utf8(text)) << text;
    EXPECT_EQ(escaped(text), text);
  }
}

TEST(Printable, BytesThatAreNoUtf8AreEscaped) {
  // A lone byte, a cut character, overlong forms, a surrogate, more than U+10FFFF. RFC 3629.
  const std::pair<std::string, std::string> texts[] = {
      {"\xff\xfe", "\\xff\\xfe"},
      {"a\x80z", "a\\x80z"},
      {"\xe2\x82", "\\xe2\\x82"},
      {"\xe2(", "\\xe2("},
      {"\xc0\xaf", "\\xc0\\xaf"},
      {"\xe0\x80\xaf", "\\xe0\\x80\\xaf"},
      {"\xed\xa0\x80", "\\xed\\xa0\\x80"},
      {"\xf4\x90\x80\x80", "\\xf4\\x90\\x80\\x80"},
      {"\xf8\x88\x80\x80\x80", "\\xf8\\x88\\x80\\x80\\x80"},
  };
  for (const auto& [text, shown] : texts) {
    EXPECT_FALSE(is_utf8(text)) << shown;
    EXPECT_EQ(escaped(text), shown);
  }
}

TEST(Printable, ControlCharactersAreNotSentToATerminal) {
  EXPECT_EQ(escaped(std::string("a\0b\x1b[2J\n\x7f\xc2\x9b", 11)), "a?b?[2J???");
}

TEST(Printable, EndsOfLinesAndTurnsOfTheDirectionOfTextAreControlCharacters) {
  EXPECT_EQ(escaped("\u2027\u2028\u2029\u202e\u202f"), "\u2027???\u202f");
  EXPECT_EQ(escaped("\u2065a\u2066\u2069\u206a"), "\u2065a??\u206a");
}

TEST(Printable, TextIsShortenedBetweenCharacters) {
  std::string text;
  for (int i = 0; i < 100; ++i) text += "\xe2\x82\xac";
  const std::string shown = printable(text);
  EXPECT_LT(shown.size(), 70U);
  EXPECT_TRUE(is_utf8(shown)) << shown;
  EXPECT_EQ(shown.substr(shown.size() - 3), "...");
}

TEST(Printable, NameThatIsRefusedIsEchoedAsUtf8) {
  const Tree region = Tree::Map{{"name", "ice\xff"},
                                {"law", "rough"},
                                {"circle", Tree::Map{{"center", Tree::List{0., 0.}}, {"radius", 1.}}}};
  try {
    scene::read_surface(Tree::Map{{"regions", Tree::List{region}}}, "map");
    FAIL() << "accepted";
  } catch (const scene::SceneError& error) {
    EXPECT_EQ(std::string(error.what()).find("map.regions[0].name: \"ice\\xff\" is refused; allowed: "), 0U)
        << error.what();
  }
  try {
    scene::read_surface(Tree::Map{{"re\xffgions", Tree()}}, "map");
    FAIL() << "accepted";
  } catch (const scene::SceneError& error) {
    EXPECT_EQ(std::string(error.what()).find("map.re\\xffgions: an unknown key is refused "), 0U)
        << error.what();
  }
}

}  // namespace
}  // namespace hybrid_sphere::testing::printable_test
