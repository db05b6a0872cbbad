#include "scene/yaml.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <deque>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <streambuf>

#include "scene/printable.hpp"
#include "scene/yaml_events.hpp"

namespace hybrid_sphere::scene {
namespace {

bool is_one_of(std::string_view text, std::initializer_list<const char*> words) {
  return std::any_of(words.begin(), words.end(), [&](const char* word) { return text == word; });
}

/// A plain scalar is what YAML 1.1, and so the parameter server, takes it for.
Tree tree_from_plain(std::string_view text) {
  const char first = text.empty() ? '\0' : text.front();
  if (('0' <= first && first <= '9') || first == '-' || first == '+' || first == '.') {
    if (const auto number = parse_number(text)) return *number;  // most scalars of a large map
  }
  if (is_one_of(text, {"", "~", "null", "Null", "NULL"})) return {};
  if (is_one_of(text, {"true", "True", "TRUE", "yes", "Yes", "YES", "on", "On", "ON"})) return true;
  if (is_one_of(text, {"false", "False", "FALSE", "no", "No", "NO", "off", "Off", "OFF"})) return false;
  if (is_one_of(text, {".nan", ".NaN", ".NAN"})) return std::numeric_limits<double>::quiet_NaN();
  if (is_one_of(text, {".inf", ".Inf", ".INF", "+.inf", "+.Inf", "+.INF"})) {
    return std::numeric_limits<double>::infinity();
  }
  if (is_one_of(text, {"-.inf", "-.Inf", "-.INF"})) return -std::numeric_limits<double>::infinity();
  return text;
}

Tree tree_from_scalar(const YamlEvent& event) {
  const bool is_text = !event.is_plain() || is_one_of(event.tag(), {"!", YAML_STR_TAG});
  return is_text ? Tree(event.text()) : tree_from_plain(event.text());
}

/// What a value comes to with all that is in it, where it is written out.
struct Size {
  std::size_t values = 0;
  std::size_t text = 0;  ///< bytes
};

/// Builds the tree of one document while it is parsed, so that a bound stops the parser where it is crossed.
class Builder {
 public:
  explicit Builder(const YamlLimits& limits) : limits_(limits) {}

  /// False at the end of the document.
  bool take(const YamlEvent& event) {
    switch (event.type()) {
      case YAML_SCALAR_EVENT: take_scalar(event); break;
      case YAML_ALIAS_EVENT: take_alias(event); break;
      case YAML_SEQUENCE_START_EVENT:
      case YAML_MAPPING_START_EVENT: open(event); break;
      case YAML_SEQUENCE_END_EVENT:
      case YAML_MAPPING_END_EVENT: close(event); break;
      case YAML_DOCUMENT_END_EVENT: return false;
      default: break;
    }
    return true;
  }

  const Tree& root() const { return stack_.front(); }

 private:
  struct Open {
    yaml_mark_t mark;
    std::string anchor;
    bool is_map;
    std::size_t first;  // of its keys and values on the stack
    Size before;        // what had been counted before it
  };
  struct Anchored {
    Tree tree;
    Size size;
    bool is_open;
  };
  static constexpr std::size_t per_anchor = 160;  // bytes that the map of anchors takes for one

  bool expects_key() const {
    return !open_.empty() && open_.back().is_map && (stack_.size() - open_.back().first) % 2 == 0;
  }

  void count(const YamlEvent& event, const Size& size) {
    size_.values += size.values;
    size_.text += size.text;
    if (size_.values > limits_.values) refuse(event, std::to_string(limits_.values) + " values");
    if (size_.text > limits_.bytes) refuse(event, std::to_string(limits_.bytes) + " bytes of text");
    check_memory(event);
  }

  /// Where a list or a map closes, its items are on the stack and in their place.
  void check_memory(const YamlEvent& event) const {
    if (memory_ + 2 * stack_.size() * sizeof(Tree) > limits_.memory) {
      refuse(event, std::to_string(limits_.memory) + " bytes of memory for the values");
    }
  }

  [[noreturn]] static void refuse(const YamlEvent& event, const std::string& limit) {
    throw SceneError("more than " + limit + at_line(event.mark()));
  }

  void remember(const YamlEvent& event, std::string_view anchor, const Anchored& anchored) {
    if (anchor.empty()) return;
    memory_ += per_anchor + anchor.size();
    check_memory(event);
    anchors_.insert_or_assign(std::string(anchor), anchored);
  }

  /// An allocation takes its bytes, 8 more of its own, in all a multiple of 16, and at least 32.
  void keep(const YamlEvent& event, const Tree& tree) {
    const std::size_t bytes = tree.memory();
    if (bytes > 0) memory_ += std::max<std::size_t>(32, (bytes + 8 + 15) / 16 * 16);
    check_memory(event);
  }

  void take_scalar(const YamlEvent& event) {
    const bool is_key = expects_key();
    Tree tree = is_key ? Tree(event.text()) : tree_from_scalar(event);
    keep(event, tree);
    const Size size{is_key ? 0U : 1U, event.text().size()};
    stack_.push_back(tree);
    count(event, size);
    remember(event, event.anchor(), {tree, {1, size.text}, false});
  }

  void take_alias(const YamlEvent& event) {
    // An alias may stand for a large part of the document, again and again.
    const auto found = anchors_.find(event.anchor());
    if (found == anchors_.end())
      throw SceneError("not YAML: an alias without an anchor" + at_line(event.mark()));
    if (found->second.is_open) throw SceneError("an alias inside its own anchor" + at_line(event.mark()));
    if (expects_key()) refuse_key(event);
    stack_.push_back(found->second.tree);
    count(event, found->second.size);
  }

  [[noreturn]] static void refuse_key(const YamlEvent& event) {
    throw SceneError("a key that is not text" + at_line(event.mark()));
  }

  void open(const YamlEvent& event) {
    if (expects_key()) refuse_key(event);
    if (open_.size() >= limits_.depth) {
      throw SceneError("nested deeper than " + std::to_string(limits_.depth) + " levels" +
                       at_line(event.mark()));
    }
    remember(event, event.anchor(), {Tree(), {}, true});
    open_.push_back({event.mark(), std::string(event.anchor()), event.type() == YAML_MAPPING_START_EVENT,
                     stack_.size(), size_});
    count(event, {1, 0});
  }

  void close(const YamlEvent& event) {
    const Open closed = std::move(open_.back());
    open_.pop_back();
    Tree tree = closed.is_map ? Tree::map_from(stack_, closed.first) : Tree::list_from(stack_, closed.first);
    keep(event, tree);
    stack_.push_back(tree);
    const Size size{size_.values - closed.before.values, size_.text - closed.before.text};
    remember(event, closed.anchor, {tree, size, false});
  }

  const YamlLimits& limits_;
  Size size_;
  std::size_t memory_ = 0;  // of what is behind the values and the anchors [bytes]
  std::deque<Tree> stack_;  // keys and values of the lists and maps that are open, at the end the root alone
  std::vector<Open> open_;
  std::map<std::string, Anchored, std::less<>> anchors_;
};

Tree read_tree(std::istream& source, const YamlLimits& limits) {
  YamlEvents events(source, limits);
  YamlEvent event;
  do {
    events.next(event);
    if (event.type() == YAML_STREAM_END_EVENT) throw SceneError("empty");
  } while (event.type() != YAML_DOCUMENT_START_EVENT);
  Builder builder(limits);
  do events.next(event);
  while (builder.take(event));
  if (builder.root().is_null()) throw SceneError("empty");
  events.next(event);
  if (event.type() != YAML_STREAM_END_EVENT) throw SceneError("more than one YAML document");
  return builder.root();
}

/// Reads from a text without a copy of it.
class TextSource : public std::streambuf {
 public:
  explicit TextSource(const std::string& text) {
    char* begin = const_cast<char*>(text.data());  // is only read
    setg(begin, begin, begin + text.size());
  }
};

[[noreturn]] void refuse_file(const std::string& path, const std::string& why) {
  throw SceneError("scene file \"" + escaped(path) + "\": " + why);
}

std::string too_large(const YamlLimits& limits) {
  return "larger than the allowed " + std::to_string(limits.bytes) + " bytes";
}

}  // namespace

Tree tree_from_yaml(const std::string& text, const YamlLimits& limits) {
  if (text.size() > limits.bytes) throw SceneError(too_large(limits));
  TextSource source(text);
  std::istream stream(&source);
  return read_tree(stream, limits);
}

Tree tree_from_yaml_file(const std::string& path, const YamlLimits& limits) {
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) refuse_file(path, std::string("cannot be read: ") + std::strerror(errno));
  std::error_code unknown;  // of what is no regular file
  const auto size = std::filesystem::file_size(path, unknown);
  if (!unknown && size > limits.bytes) refuse_file(path, too_large(limits));
  try {
    return read_tree(file, limits);
  } catch (const SceneError& error) {
    refuse_file(path, error.what());
  }
}

}  // namespace hybrid_sphere::scene
