#include "scene/tree.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>
#include <utility>

#include "scene/printable.hpp"
#include "text/refusal.hpp"

namespace hybrid_sphere::scene {
namespace {

constexpr std::size_t longest_list = 60;  // that is shown

std::string describe_list(const Tree::ListView& list) {
  std::string shown = "[";
  for (const Tree& item : list) {
    if (item.as_list() || item.as_map() || shown.size() > longest_list) {
      return "a list of " + std::to_string(list.size());
    }
    shown += (shown.size() > 1 ? ", " : "") + item.describe();
  }
  return shown + "]";
}

}  // namespace

struct Tree::Node {
  std::atomic<std::uint32_t> owners{1};
  std::uint32_t size;
};

template <class Value>
Tree::Tree(Kind kind, Value value) : kind_(kind) {
  static_assert(sizeof value <= longest_short_text);
  std::memcpy(data_, &value, sizeof value);
}

template <class Value>
Value Tree::value() const {
  Value value;
  std::memcpy(&value, data_, sizeof value);
  return value;
}

template <class Item>
Item* Tree::items() const {
  return reinterpret_cast<Item*>(value<Node*>() + 1);
}

/// With room for the items, which are to be made; takes no memory for none.
template <class Item>
Tree Tree::shared(Kind kind, std::size_t size) {
  static_assert(sizeof(Node) % alignof(Item) == 0);
  if (size > UINT32_MAX) throw SceneError("more than 4294967295 values in one list, map or text");
  if (size == 0) return {kind, static_cast<Node*>(nullptr)};
  void* memory = ::operator new(sizeof(Node) + size * sizeof(Item));
  return {kind, new (memory) Node{{1}, static_cast<std::uint32_t>(size)}};
}

/// Copies of Trees: throws nothing once there is the memory.
template <class Iterator>
Tree Tree::shared_copies(Kind kind, Iterator begin, Iterator end) {
  Tree made = shared<Tree>(kind, static_cast<std::size_t>(end - begin));
  if (begin != end) std::uninitialized_copy(begin, end, made.items<Tree>());
  return made;
}

template <class Iterator>
Tree Tree::list(Iterator begin, Iterator end) {
  if (!std::all_of(begin, end, [](const Tree& item) { return item.kind_ == Kind::number; })) {
    return shared_copies(Kind::list, begin, end);
  }
  Tree made = shared<double>(Kind::numbers, static_cast<std::size_t>(end - begin));
  if (begin != end) {
    std::transform(begin, end, made.items<double>(), [](const Tree& item) { return *item.as_number(); });
  }
  return made;
}

Tree::Tree(bool value) : Tree(Kind::boolean, value) {}
Tree::Tree(double value) : Tree(Kind::number, value) {}
Tree::Tree(std::string_view text) {
  if (text.size() > longest_short_text) {
    *this = shared<char>(Kind::text, text.size());
    std::copy(text.begin(), text.end(), items<char>());
    return;
  }
  std::copy(text.begin(), text.end(), data_);
  length_ = static_cast<std::uint8_t>(text.size());
  kind_ = Kind::short_text;
}
Tree::Tree(const List& items) : Tree(list(items.begin(), items.end())) {}
Tree::Tree(const Map& entries) {
  std::deque<Tree> stack;
  for (const auto& [key, value] : entries) {
    stack.emplace_back(key);
    stack.push_back(value);
  }
  *this = map_from(stack, 0);
}

Tree::Tree(const Tree& other) noexcept : length_(other.length_), kind_(other.kind_) {
  std::memcpy(data_, other.data_, sizeof data_);
  if (Node* node = is_shared() ? value<Node*>() : nullptr) node->owners.fetch_add(1);
}
Tree::Tree(Tree&& other) noexcept : length_(other.length_), kind_(other.kind_) {
  std::memcpy(data_, other.data_, sizeof data_);
  other.kind_ = Kind::null;
}
Tree& Tree::operator=(Tree other) noexcept {
  std::swap(data_, other.data_);
  std::swap(length_, other.length_);
  std::swap(kind_, other.kind_);
  return *this;
}
Tree::~Tree() {
  if (is_shared()) release();
}

void Tree::release() noexcept {
  Node* node = value<Node*>();
  if (node == nullptr || node->owners.fetch_sub(1) != 1) return;
  const std::size_t trees = kind_ == Kind::list || kind_ == Kind::map ? size() : 0;
  if (trees > 0) std::destroy_n(items<Tree>(), trees);
  node->~Node();
  ::operator delete(node);
}

Tree Tree::list_from(std::deque<Tree>& stack, std::size_t first) {
  const auto begin = stack.begin() + static_cast<std::ptrdiff_t>(first);
  Tree made = list(begin, stack.end());
  stack.erase(begin, stack.end());
  return made;
}

Tree Tree::map_from(std::deque<Tree>& stack, std::size_t first) {
  const auto begin = stack.begin() + static_cast<std::ptrdiff_t>(first);
  Tree made = shared_copies(Kind::map, begin, stack.end());
  stack.erase(begin, stack.end());
  return made;
}

/// Of what is shared.
std::size_t Tree::size() const {
  const Node* node = value<Node*>();
  return node == nullptr ? 0 : node->size;
}

std::optional<bool> Tree::as_bool() const {
  return kind_ == Kind::boolean ? std::optional(value<bool>()) : std::nullopt;
}
std::optional<double> Tree::as_number() const {
  return kind_ == Kind::number ? std::optional(value<double>()) : std::nullopt;
}
std::optional<std::string_view> Tree::as_text() const {
  if (kind_ == Kind::short_text) return std::string_view(data_, length_);
  if (kind_ == Kind::text) return std::string_view(items<char>(), size());
  return std::nullopt;
}
std::optional<Tree::ListView> Tree::as_list() const {
  if (kind_ != Kind::list && kind_ != Kind::numbers) return std::nullopt;
  ListView view;
  view.size_ = size();
  if (view.size_ > 0 && kind_ == Kind::list) view.items_ = items<Tree>();
  if (view.size_ > 0 && kind_ == Kind::numbers) view.numbers_ = items<double>();
  return view;
}
std::optional<Tree::MapView> Tree::as_map() const {
  if (kind_ != Kind::map) return std::nullopt;
  MapView view;
  view.size_ = size() / 2;
  view.items_ = view.size_ > 0 ? items<Tree>() : nullptr;
  return view;
}

const Tree* Tree::MapView::find(std::string_view key) const {
  for (std::size_t i = 0; i < size_; ++i) {
    if ((*this)[i].key == key) return &(*this)[i].value;
  }
  return nullptr;
}

std::size_t Tree::memory() const {
  if (!is_shared() || size() == 0) return 0;
  const std::size_t item = kind_ == Kind::text      ? sizeof(char)
                           : kind_ == Kind::numbers ? sizeof(double)
                                                    : sizeof(Tree);
  return sizeof(Node) + size() * item;
}

std::optional<double> parse_number(std::string_view text) {
  if (text.empty() || text.find_first_not_of("0123456789+-.eE") != std::string_view::npos)
    return std::nullopt;
  const std::string_view digits = text.substr(text.find_first_not_of("+-") == 1 ? 1 : 0);
  const bool is_whole = digits.find_first_not_of("0123456789") == std::string_view::npos;
  if (is_whole && digits.size() > 1 && digits.front() == '0') return std::nullopt;
  char few[40] = {};
  std::string many;
  if (text.size() >= sizeof few) many = text;
  const char* begin = many.empty() ? (text.copy(few, sizeof few - 1), few) : many.c_str();
  char* end = nullptr;
  const double number = std::strtod(begin, &end);
  if (end != begin + text.size()) return std::nullopt;
  return number;
}

std::string Tree::describe() const {
  if (const auto value = as_bool()) return *value ? "true" : "false";
  if (const auto value = as_number()) return text::shortest(*value);
  if (const auto value = as_text()) return '"' + printable(*value) + '"';
  if (const auto value = as_list()) return describe_list(*value);
  if (const auto value = as_map()) return "a map with " + std::to_string(value->size()) + " keys";
  return "an empty value";
}

SceneError::SceneError(const std::string& message, Parts parts)
    : std::runtime_error(message), parts_(std::make_shared<const Parts>(std::move(parts))) {}

SceneError::SceneError(const std::string& path, const std::string& value, const std::string& allowed)
    : SceneError(text::refusal(path + ": " + value, allowed), {path, value, allowed}) {}

SceneError SceneError::missing(const std::string& path, const std::string& allowed) {
  return {path + ": is missing; allowed: " + allowed, {path, "", allowed}};
}

SceneError SceneError::unknown(const std::string& path, const std::string& hint, const std::string& allowed) {
  return {path + ": an unknown key is refused" + hint + "; allowed: " + allowed, {path, "", allowed}};
}

}  // namespace hybrid_sphere::scene
