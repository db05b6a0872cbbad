#include "hybrid_sphere/scene/yaml.hpp"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>
#include <sstream>
#include <unordered_map>

namespace hybrid_sphere::scene {
namespace {

std::string at(const YAML::Mark& mark) {
  return mark.is_null() ? "" : " (line " + std::to_string(mark.line + 1) + ")";
}

bool is_one_of(const std::string& text, std::initializer_list<const char*> words) {
  return std::any_of(words.begin(), words.end(), [&](const char* word) { return text == word; });
}

/// A plain scalar is what YAML 1.1, and so the parameter server, takes it for.
Tree tree_from_plain(const std::string& text) {
  const char first = text.empty() ? '\0' : text.front();
  if (('0' <= first && first <= '9') || first == '-' || first == '+' || first == '.') {
    if (const auto number = parse_number(text)) return *number;  // most scalars of a large map
  }
  if (is_one_of(text, {"true", "True", "TRUE", "yes", "Yes", "YES", "on", "On", "ON"})) return true;
  if (is_one_of(text, {"false", "False", "FALSE", "no", "No", "NO", "off", "Off", "OFF"})) return false;
  if (is_one_of(text, {".nan", ".NaN", ".NAN"})) return std::numeric_limits<double>::quiet_NaN();
  if (is_one_of(text, {".inf", ".Inf", ".INF", "+.inf", "+.Inf", "+.INF"})) {
    return std::numeric_limits<double>::infinity();
  }
  if (is_one_of(text, {"-.inf", "-.Inf", "-.INF"})) return -std::numeric_limits<double>::infinity();
  return text;
}

std::size_t count_values(const Tree& tree) {
  std::size_t count = 1;
  if (const Tree::List* list = tree.as_list()) {
    for (const Tree& item : *list) count += count_values(item);
  } else if (const Tree::Map* map = tree.as_map()) {
    for (const auto& entry : *map) count += count_values(entry.second);
  }
  return count;
}

/// Builds the tree while the text is parsed, so that a bound stops the parser where it is crossed.
class Builder : public YAML::EventHandler {
 public:
  explicit Builder(const YamlLimits& limits) : limits_(limits) {}

  Tree take() { return std::move(root_); }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override { add(mark, Tree(), anchor); }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    if (expects_key()) {
      stack_.back().key = value;
      stack_.back().has_key = true;
    } else {
      add(mark, tag == "!" ? Tree(value) : tree_from_plain(value), anchor);
    }
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    // An alias may stand for a large part of the document, again and again.
    const auto found = anchors_.find(anchor);
    if (found == anchors_.end()) throw SceneError("an alias inside of what it stands for" + at(mark));
    const Tree& tree = found->second;
    count(mark, count_values(tree) - 1);
    add(mark, tree, 0);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open(mark, anchor, false);
  }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open(mark, anchor, true);
  }
  void OnSequenceEnd() override { close(); }
  void OnMapEnd() override { close(); }

 private:
  struct Open {
    YAML::Mark mark;
    YAML::anchor_t anchor;
    bool is_map;
    bool has_key;
    std::string key;
    Tree::List list;
    Tree::Map map;
  };

  bool expects_key() const { return !stack_.empty() && stack_.back().is_map && !stack_.back().has_key; }

  void count(const YAML::Mark& mark, std::size_t values) {
    values_ += values;
    if (values_ > limits_.values) {
      throw SceneError("more than " + std::to_string(limits_.values) + " values" + at(mark));
    }
  }

  void open(const YAML::Mark& mark, YAML::anchor_t anchor, bool is_map) {
    if (expects_key()) throw SceneError("a key that is not text" + at(mark));
    if (stack_.size() >= limits_.depth) {
      throw SceneError("nested deeper than " + std::to_string(limits_.depth) + " levels" + at(mark));
    }
    stack_.push_back({mark, anchor, is_map, false, {}, {}, {}});
  }

  void close() {
    Open closed = std::move(stack_.back());
    stack_.pop_back();
    add(closed.mark, closed.is_map ? Tree(std::move(closed.map)) : Tree(std::move(closed.list)),
        closed.anchor);
  }

  void add(const YAML::Mark& mark, Tree tree, YAML::anchor_t anchor) {
    if (expects_key()) throw SceneError("a key that is not text" + at(mark));
    count(mark, 1);
    if (anchor != 0) anchors_[anchor] = tree;
    if (stack_.empty()) {
      root_ = std::move(tree);
    } else if (Open& parent = stack_.back(); parent.is_map) {
      parent.map.emplace_back(std::move(parent.key), std::move(tree));
      parent.has_key = false;
    } else {
      parent.list.push_back(std::move(tree));
    }
  }

  const YamlLimits& limits_;
  std::size_t values_ = 0;
  Tree root_;
  std::vector<Open> stack_;
  std::unordered_map<YAML::anchor_t, Tree> anchors_;
};

/// The parser looks ahead over all brackets that are open: they are bounded before it sees them. To be safe,
/// brackets that open in quotes count, brackets that close in quotes do not, and nothing in a comment does.
class BracketCount {
 public:
  explicit BracketCount(const std::string& text) : text_(text) {}

  long most() {
    while (i_ < text_.size()) step();
    return most_;
  }

 private:
  char here() const { return text_[i_]; }
  bool at_start_of_token() const {
    return i_ == 0 || std::strchr(" \t\r\n[]{},:-?", text_[i_ - 1]) != nullptr;
  }

  void close_quote() {
    const bool doubled = quote_ == '\'' && i_ + 1 < text_.size() && text_[i_ + 1] == quote_;
    if (doubled) {
      ++i_;
    } else {
      quote_ = 0;
    }
  }

  void step() {
    if (here() == '[' || here() == '{') {
      most_ = std::max(most_, ++open_);
    } else if (quote_ != 0) {
      if (here() == '\\' && quote_ == '"') ++i_;
      if (i_ < text_.size() && here() == quote_) close_quote();
    } else if (here() == ']' || here() == '}') {
      open_ = std::max(0L, open_ - 1);
    } else if ((here() == '"' || here() == '\'') && at_start_of_token()) {
      quote_ = here();
    } else if (here() == '#' && (i_ == 0 || std::isspace(static_cast<unsigned char>(text_[i_ - 1])) != 0)) {
      i_ = std::min(text_.find('\n', i_), text_.size() - 1);
    }
    ++i_;
  }

  const std::string& text_;
  std::size_t i_ = 0;
  char quote_ = 0;  // the one that is open
  long open_ = 0;
  long most_ = 0;
};

void refuse_many_brackets(const std::string& text) {
  constexpr long most_open = 1000;
  if (BracketCount(text).most() > most_open) {
    throw SceneError("more than " + std::to_string(most_open) + " open brackets");
  }
}

[[noreturn]] void refuse_file(const std::string& path, const std::string& why) {
  throw SceneError("scene file \"" + path + "\": " + why);
}

std::string too_large(const YamlLimits& limits) {
  return "larger than the allowed " + std::to_string(limits.bytes) + " bytes";
}

}  // namespace

Tree tree_from_yaml(const std::string& text, const YamlLimits& limits) {
  if (text.size() > limits.bytes) throw SceneError(too_large(limits));
  refuse_many_brackets(text);
  try {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    Builder builder(limits);
    if (!parser.HandleNextDocument(builder)) throw SceneError("empty");
    Tree tree = builder.take();
    if (tree.is_null()) throw SceneError("empty");
    Builder second(limits);
    if (parser.HandleNextDocument(second)) throw SceneError("more than one YAML document");
    return tree;
  } catch (const YAML::Exception& error) {
    throw SceneError("no YAML: " + error.msg + at(error.mark));
  }
}

Tree tree_from_yaml_file(const std::string& path, const YamlLimits& limits) {
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) refuse_file(path, std::string("cannot be read: ") + std::strerror(errno));
  std::string text;
  char block[65536];
  while (file.read(block, sizeof block), file.gcount() > 0) {
    text.append(block, static_cast<std::size_t>(file.gcount()));
    if (text.size() > limits.bytes) refuse_file(path, too_large(limits));
  }
  if (file.bad()) refuse_file(path, std::string("cannot be read: ") + std::strerror(errno));
  try {
    return tree_from_yaml(text, limits);
  } catch (const SceneError& error) {
    refuse_file(path, error.what());
  }
}

}  // namespace hybrid_sphere::scene
