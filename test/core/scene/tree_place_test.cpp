// Places in a tree of values, other values there, and the YAML that reads back as the same tree.

#include "scene/tree_place.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <random>
#include <stdexcept>

#include "scene/read_tree.hpp"
#include "scene/yaml.hpp"
#include "support/files.hpp"
#include "support/scene_numbers.hpp"

namespace hybrid_sphere::testing::tree_place_test {
namespace {

using scene::at_place;
using scene::to_yaml;
using scene::Tree;
using scene::tree_from_yaml;
using scene::TreePlace;
using scene::with_value;

std::uint64_t bits_of(double number) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &number, sizeof bits);
  return bits;
}

/// Kinds, numbers to the bit, texts, and the order of keys. NaN is NaN whatever its other bits.
bool are_same(const Tree& a, const Tree& b) {
  if (const auto list = a.as_list()) {
    const auto other = b.as_list();
    if (!other || other->size() != list->size()) return false;
    for (std::size_t i = 0; i < list->size(); ++i) {
      if (!are_same((*list)[i], (*other)[i])) return false;
    }
    return true;
  }
  if (const auto map = a.as_map()) {
    const auto other = b.as_map();
    if (!other || other->size() != map->size()) return false;
    for (std::size_t i = 0; i < map->size(); ++i) {
      if ((*map)[i].key != (*other)[i].key || !are_same((*map)[i].value, (*other)[i].value)) return false;
    }
    return true;
  }
  if (const auto number = a.as_number()) {
    const auto other = b.as_number();
    if (other && std::isnan(*number)) return std::isnan(*other);
    return other && bits_of(*number) == bits_of(*other);
  }
  return a.as_text() == b.as_text() && a.as_bool() == b.as_bool() && a.is_null() == b.is_null();
}

/// The document is a map, as an empty one is refused.
void expect_reads_back(const Tree& value) {
  const Tree tree(Tree::Map{{"value", value}});
  const std::string yaml = to_yaml(tree);
  try {
    EXPECT_TRUE(are_same(tree_from_yaml(yaml), tree)) << yaml;
  } catch (const scene::SceneError& error) {
    ADD_FAILURE() << error.what() << "\n" << yaml;
  }
}

/// A character of Unicode in UTF-8. RFC 3629, section 3.
std::string utf8(char32_t c) {
  const auto byte = [](char32_t bits) { return static_cast<char>(static_cast<unsigned char>(bits)); };
  if (c < 0x80) return {byte(c)};
  if (c < 0x800) return {byte(0xc0 | c >> 6), byte(0x80 | (c & 0x3f))};
  if (c < 0x10000) return {byte(0xe0 | c >> 12), byte(0x80 | (c >> 6 & 0x3f)), byte(0x80 | (c & 0x3f))};
  return {byte(0xf0 | c >> 18), byte(0x80 | (c >> 12 & 0x3f)), byte(0x80 | (c >> 6 & 0x3f)),
          byte(0x80 | (c & 0x3f))};
}

class RandomTrees {
 public:
  Tree tree(int depth) {
    switch (below(depth > 0 ? 8 : 5)) {
      case 0: return number();
      case 1: return text();
      case 2: return below(2) == 0;
      case 3: return {};
      case 4: return below(2) == 0 ? Tree(Tree::List{}) : Tree(Tree::Map{});
      case 5: return numbers();
      case 6: {
        Tree::List items;
        for (int i = below(4); i >= 0; --i) items.push_back(tree(depth - 1));
        return items;
      }
      default: {
        Tree::Map entries;
        for (int i = below(4); i >= 0; --i) entries.emplace_back(std::to_string(i) + text(), tree(depth - 1));
        return entries;
      }
    }
  }

  double number() {
    const double sizes[] = {0,     -0.0,      1e-308, 5e-324, 1e308, std::numeric_limits<double>::max(),
                            1e-60, 123456789, 1e15,   0.1,    1e16,  -1e-12};
    if (below(3) == 0) return sizes[below(static_cast<int>(std::size(sizes)))];
    for (;;) {
      double drawn = 0;
      const std::uint64_t bits = random_();
      std::memcpy(&drawn, &bits, sizeof drawn);
      if (std::isfinite(drawn)) return drawn;
    }
  }

  std::string text() {
    static const std::string plain[] = {"",    "null", "~",   "1e5", "0x10", "yes",  "true", "- a",  "a: b",
                                        "#no", "'",    "\"",  "\\",  "\\n",  "[1]",  "{a}",  " x ",  "a\n b",
                                        "\t",  "%",    "---", "...", "*a",   "&a b", "!tag", "\r\n", "|"};
    if (below(2) == 0) return plain[below(static_cast<int>(std::size(plain)))];
    std::string drawn;
    for (int i = below(12); i > 0; --i) drawn += character();
    return drawn;
  }

 private:
  int below(int end) { return static_cast<int>(random_() % static_cast<unsigned>(end)); }

  std::string character() {
    const int kind = below(4);
    if (kind == 0) return utf8(static_cast<char32_t>(below(0x20)));
    if (kind == 1) return utf8(static_cast<char32_t>(below(0x100)));
    const char32_t special[] = {0x7f, 0x85, 0xa0, 0x2028, 0x2029, 0x202e, 0xfeff, 0xfffe, 0xffff, 0x1f600};
    if (kind == 2) return utf8(special[below(static_cast<int>(std::size(special)))]);
    const auto drawn = static_cast<char32_t>(below(0x110000));
    return drawn >= 0xd800 && drawn < 0xe000 ? "x" : utf8(drawn);
  }

  Tree numbers() {
    Tree::List items;
    for (int i = below(5); i > 0; --i) items.emplace_back(number());
    return items;
  }

  std::mt19937_64 random_{20240501};
};

TEST(TreeAsYaml, ReadsBackAsTheSameTree) {
  RandomTrees random;
  for (int i = 0; i < 1500; ++i) expect_reads_back(random.tree(5));
}

TEST(TreeAsYaml, KeepsEveryCharacterOfAText) {
  // Line breaks of YAML 1.1, what its readers refuse unless it is escaped, and the ends of the planes.
  for (char32_t c = 0; c < 0x300; ++c) expect_reads_back("a" + utf8(c) + " b");
  for (const char32_t c : {U'\x2027', U'\x2028', U'\x2029', U'\x202a', U'\xd7ff', U'\xe000', U'\xfeff',
                           U'\xfffd', U'\xfffe', U'\xffff', U'\x10000', U'\x1fffe', U'\x10ffff'}) {
    expect_reads_back(utf8(c));
    expect_reads_back(" " + utf8(c) + utf8(c) + " ");
  }
}

TEST(TreeAsYaml, KeepsEveryBitOfANumber) {
  RandomTrees random;
  for (int i = 0; i < 20000; ++i) {
    const double number = random.number();
    const Tree back = tree_from_yaml(to_yaml(number));
    ASSERT_TRUE(back.as_number() && bits_of(*back.as_number()) == bits_of(number)) << to_yaml(number);
  }
  for (const double number : {std::numeric_limits<double>::infinity(),
                              -std::numeric_limits<double>::infinity(), std::nan(""), -std::nan("")}) {
    expect_reads_back(number);
  }
}

TEST(TreeAsYaml, KeepsListsOfListsAndWhatIsEmpty) {
  const Tree empty_list(Tree::List{});
  const Tree empty_map(Tree::Map{});
  expect_reads_back(empty_list);
  expect_reads_back(empty_map);
  expect_reads_back(Tree::List{empty_list, empty_map, {}, ""});
  expect_reads_back(Tree::List{Tree::List{Tree::List{empty_list}, 1.0}, Tree::List{2.0, 3.0}});
  expect_reads_back(Tree::List{Tree::Map{{"a", Tree::List{Tree::Map{{"b", empty_map}}}}, {"", {}}}});
}

TEST(TreeAsYaml, IsAsDeepAsAFileMayBe) {
  Tree tree = 1.0;
  for (int i = 0; i < 15; ++i) tree = i % 2 == 0 ? Tree(Tree::List{tree}) : Tree(Tree::Map{{"k", tree}});
  expect_reads_back(tree);
}

void expect_survives(const std::string& file, const std::string& directory) {
  const Tree tree = scene::tree_from_yaml_file(file);
  const Tree back = tree_from_yaml(to_yaml(tree));
  EXPECT_TRUE(are_same(tree, back)) << file;
  EXPECT_EQ(numbers_of(scene::read_scene(tree, directory)), numbers_of(scene::read_scene(back, directory)))
      << file;
}

TEST(TreeAsYaml, KeepsTheScenesOfThePackage) {
  const std::string config = std::string(TEST_DATA_DIR) + "/../../config";
  int scenes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(config)) {
    if (entry.path().extension() != ".yaml") continue;
    expect_survives(entry.path().string(), config);
    ++scenes;
  }
  EXPECT_GE(scenes, 10);
}

TEST(TreeAsYaml, KeepsTheScenesOfTheTests) {
  const std::string oracle = std::string(TEST_DATA_DIR) + "/oracle";
  for (const std::string& name : yaml_files("oracle")) expect_survives(oracle + "/" + name + ".yaml", oracle);
}

const Tree& sample() {
  static const Tree tree = tree_from_yaml("{a: {b: [1, [2, 3], {c: four}]}, d: 5, e: ~}");
  return tree;
}

TEST(TreePlace, LeadsThroughMapsAndLists) {
  EXPECT_EQ(at_place(sample(), {"d"}).as_number(), 5);
  EXPECT_EQ(at_place(sample(), {"a", "b", std::size_t{1}, std::size_t{0}}).as_number(), 2);
  EXPECT_EQ(at_place(sample(), {"a", "b", std::size_t{2}, "c"}).as_text(), "four");
  EXPECT_EQ(to_yaml(at_place(sample(), {})), to_yaml(sample()));
}

TEST(TreePlace, IsNullWhereThereIsNothing) {
  const TreePlace nowhere[] = {{"z"},      {"a", "z"},      {"a", "b", std::size_t{3}},
                               {"d", "z"}, {"a", "b", "c"}, {"d", std::size_t{0}},
                               {"e", "z"}, {std::size_t{0}}};
  for (const TreePlace& place : nowhere) EXPECT_TRUE(at_place(sample(), place).is_null());
}

TEST(TreePlace, TakesAnotherValue) {
  EXPECT_EQ(to_yaml(with_value(sample(), {"d"}, 6.0)),
            to_yaml(tree_from_yaml("{a: {b: [1, [2, 3], {c: four}]}, d: 6, e: ~}")));
  EXPECT_EQ(to_yaml(with_value(sample(), {"a", "b", std::size_t{1}, std::size_t{1}}, -0.0)),
            to_yaml(tree_from_yaml("{a: {b: [1, [2, -0.0], {c: four}]}, d: 5, e: ~}")));
  EXPECT_EQ(to_yaml(with_value(sample(), {"a", "b", std::size_t{0}}, "text")),
            to_yaml(tree_from_yaml("{a: {b: [text, [2, 3], {c: four}]}, d: 5, e: ~}")));
  EXPECT_EQ(with_value(sample(), {}, 1.0).as_number(), 1);
  EXPECT_EQ(at_place(sample(), {"d"}).as_number(), 5) << "a tree does not change";
}

TEST(TreePlace, MakesMapsThatAreMissing) {
  EXPECT_EQ(to_yaml(with_value(tree_from_yaml("{a: 1}"), {"b", "c", "d"}, 2.0)),
            to_yaml(tree_from_yaml("{a: 1, b: {c: {d: 2}}}")));
  EXPECT_EQ(to_yaml(with_value(sample(), {"e", "f"}, 2.0)),
            to_yaml(tree_from_yaml("{a: {b: [1, [2, 3], {c: four}]}, d: 5, e: {f: 2}}")));
  EXPECT_EQ(to_yaml(with_value(Tree(), {"a"}, 2.0)), to_yaml(tree_from_yaml("{a: 2}")));
}

TEST(TreePlace, RefusesWhatIsNeitherAMapNorAnItem) {
  const TreePlace bad[] = {{"d", "x"},
                           {"d", std::size_t{0}},
                           {"a", std::size_t{0}},
                           {"a", "b", "c"},
                           {"a", "b", std::size_t{3}},
                           {"z", std::size_t{0}},
                           {"a", "b", std::size_t{1}, std::numeric_limits<std::size_t>::max()}};
  for (const TreePlace& place : bad) EXPECT_THROW(with_value(sample(), place, 1.0), std::invalid_argument);
}

}  // namespace
}  // namespace hybrid_sphere::testing::tree_place_test
