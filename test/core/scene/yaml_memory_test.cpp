// Whatever stands in a file of the allowed size, reading it takes at most 100 MB: each file is read in a
// child process whose address space may grow by so much.

#include <gtest/gtest.h>

#include <fstream>

#include "scene/yaml.hpp"
#include "support/limited_memory.hpp"
#include "support/temporary_file.hpp"

namespace hybrid_sphere::testing::yaml_memory_test {
namespace {

constexpr std::size_t max_memory = 100'000'000;
constexpr std::size_t file_size = scene::YamlLimits{}.bytes;

std::string outcome_of_file(const std::string& begin, const std::string& line, const std::string& end = "") {
  const TemporaryFile file("memory.yaml");
  const std::size_t lines = (file_size - begin.size() - end.size()) / line.size();
  {
    std::ofstream stream(file.path(), std::ios::binary);
    stream << begin;
    std::string block;
    while (block.size() < (1U << 20U)) block += line;
    std::size_t left = lines;
    const std::size_t per_block = block.size() / line.size();
    for (; left >= per_block; left -= per_block) stream << block;
    for (; left > 0; --left) stream << line;
    stream << end;
  }
  return outcome_within(max_memory, [&] { scene::tree_from_yaml_file(file.path()); });
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// Neither accepted with more nor stopped by the limit.
#define EXPECT_REFUSED(message, why) EXPECT_TRUE(contains(message, why)) << (message).substr(0, 200)

TEST(YamlMemory, IsEnoughForAPolygonOfAMillionAndAThirdCornersInALineOfBraces) {
  // 25 bytes each in 32 MiB.
  EXPECT_EQ(outcome_of_file("regions:\n- {name: a, polygon: [", "[-1.23456789,2.345678901],", "[0,0]]}\n"),
            "accepted");
}

TEST(YamlMemory, IsEnoughForAPolygonOverLines) {
  EXPECT_EQ(outcome_of_file("regions:\n- name: a\n  polygon:\n", "  - [-1.23456789, 2.34567890]\n"),
            "accepted");
}

TEST(YamlMemory, OfAliasesOfALongTextIsRefusedByWhatTheyExpandTo) {
  std::string text = "a: &a \"" + std::string(100'000, 'A') + "\"\nb: [*a";
  for (int i = 0; i < 20'000; ++i) text += ",*a";
  const std::string message = outcome_within(max_memory, [&] { scene::tree_from_yaml(text + "]\n"); });
  EXPECT_REFUSED(message, "more than 33554432 bytes of text (line 2)");
}

TEST(YamlMemory, OfAliasesOfAListIsRefusedByWhatTheyExpandTo) {
  std::string text = "a: &a [";
  for (int i = 0; i < 10'000; ++i) text += "x,";
  text += "x]\nb: [*a";
  for (int i = 0; i < 1'000; ++i) text += ",*a";
  const std::string message = outcome_within(max_memory, [&] { scene::tree_from_yaml(text + "]\n"); });
  EXPECT_REFUSED(message, "more than 4000000 values (line 2)");
}

TEST(YamlMemory, OfNestedAnchorsIsNotTakenAgainForEachOfThem) {
  for (const std::size_t size : {std::size_t{200'000}, std::size_t{1'000'000}}) {
    std::string text = "a: 1\nb: ";
    for (int i = 0; i < 15; ++i) text += "&a" + std::to_string(i) + " [";
    for (int i = 0; i < 15; ++i) text += std::string(size, 'x') + ",";
    text += std::string(15, ']');
    EXPECT_EQ(outcome_within(max_memory, [&] { scene::tree_from_yaml(text); }), "accepted");
  }
}

TEST(YamlMemory, OfBracketsBehindWhatLooksLikeQuotesAndCommentsIsRefused) {
  EXPECT_REFUSED(outcome_of_file("[!\"b # x\", ", "["), "not YAML: ");  // a tag without a blank behind it
  EXPECT_REFUSED(outcome_of_file("[!b # x\n", "["), "nested deeper than 16 levels");
}

TEST(YamlMemory, OfBracketsInUtf16IsRefused) {
  const auto utf16 = [](const std::string& text) {
    std::string wide;
    for (const char c : text) wide += {c, '\0'};
    return wide;
  };
  const std::string begin = "\xff\xfe" + utf16("[\"") + std::string("\x23\x20") + utf16("\", ");  // U+2023
  EXPECT_REFUSED(outcome_of_file(begin, utf16("[")), "nested deeper than 16 levels");
}

struct SmallThings {
  const char* name;
  const char* begin;
  const char* line;
};

class YamlMemoryOfMany : public ::testing::TestWithParam<SmallThings> {};

TEST_P(YamlMemoryOfMany, IsAcceptedOrRefusedInWords) {
  const std::string message = outcome_of_file(GetParam().begin, GetParam().line);
  EXPECT_TRUE(message == "accepted" || contains(message, "more than ") || contains(message, "not YAML: ") ||
              contains(message, "a key that is not text") || contains(message, "nested deeper"))
      << message.substr(0, 200);
}

constexpr SmallThings small_things[] = {
    {"numbers", "[", "1,"},
    {"letters", "[", "x,"},
    {"empty_lists", "[", "[],"},
    {"lists_of_a_number", "[", "[1],"},
    {"lists_of_a_letter", "[", "[x],"},
    {"maps_in_braces", "[", "{a: 1},"},
    {"lines_of_one_key", "", "a: 1\n"},
    {"nulls", "[", "~,"},
    {"anchors", "[", "&a x,"},
    {"anchors_of_lists", "[", "&a [x],"},
    {"aliases_of_no_anchor", "[", "*a,"},
    {"tags", "", "- !!str 1\n"},
    {"pairs", "[", "a: b,"},
    {"words", "[", "abcdefghijklmno,"},
};

INSTANTIATE_TEST_SUITE_P(SmallThings, YamlMemoryOfMany, ::testing::ValuesIn(small_things),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(YamlMemory, OfAnchorsOfManyNamesIsRefused) {
  std::string text = "[";
  for (int i = 0; text.size() < file_size - 20; ++i) text += "&" + std::to_string(i) + " ,";
  const TemporaryFile file("anchors.yaml");
  file.fill(text);
  text = std::string();
  EXPECT_REFUSED(outcome_within(max_memory, [&] { scene::tree_from_yaml_file(file.path()); }),
                 "bytes of memory for the values");
}

TEST(YamlMemory, OfOneValueIsBounded) {
  const char* why = "more than 1048576 bytes from one value to the next";
  EXPECT_REFUSED(outcome_of_file("a: ", "a"), why);
  EXPECT_REFUSED(outcome_of_file("a: x", " "), why);
  EXPECT_REFUSED(outcome_of_file("a: \"", " "), why);
  EXPECT_REFUSED(outcome_of_file("a: \"", "\n"), why);
  EXPECT_REFUSED(outcome_of_file("a: |\n  ", "a"), why);
  EXPECT_REFUSED(outcome_of_file("a: >\n", "  a\n"), why);
  EXPECT_REFUSED(outcome_of_file("a: 1\n#", "a"), why);
  EXPECT_REFUSED(outcome_of_file("a: 1\n", "#\n"), why);
}

TEST(YamlMemory, OfWhatComesBeforeTheFirstValueIsBounded) {
  const char* why = "more than 65536 bytes before the first value";
  EXPECT_REFUSED(outcome_of_file("#", "a"), why);
  EXPECT_REFUSED(outcome_of_file("", "\n"), why);
  std::string text;
  for (int i = 0; text.size() < file_size - 20; ++i) text += "%TAG !" + std::to_string(i) + "! b\n";
  EXPECT_REFUSED(outcome_within(max_memory, [&] { scene::tree_from_yaml(text); }), why);
}

}  // namespace
}  // namespace hybrid_sphere::testing::yaml_memory_test
