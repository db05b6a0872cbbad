#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hybrid_sphere/scene/scene_error.hpp"

namespace hybrid_sphere::scene {

/// A tree of named values: the form in which scenes arrive from a YAML file and from the parameter server. A
/// value does not change; copies share what they hold, so that a copy takes no memory and cannot fail. 16
/// bytes, and what a long text, a list or a map holds: 8 bytes, and for each item 8 bytes of a list of
/// numbers, 16 of other lists, 32 of a map.
class Tree {
 public:
  using List = std::vector<Tree>;  ///< to build one from
  using Map =
      std::vector<std::pair<std::string, Tree>>;  ///< in the order of the source; keys may repeat there
  class ListView;
  class MapView;

  Tree() = default;
  Tree(bool value);                                                // NOLINT(google-explicit-constructor)
  Tree(double value);                                              // NOLINT(google-explicit-constructor)
  Tree(std::string_view text);                                     // NOLINT(google-explicit-constructor)
  Tree(const std::string& text) : Tree(std::string_view(text)) {}  // NOLINT(google-explicit-constructor)
  Tree(const char* text) : Tree(std::string_view(text)) {}         // NOLINT(google-explicit-constructor)
  Tree(const List& items);                                         // NOLINT(google-explicit-constructor)
  Tree(const Map& entries);                                        // NOLINT(google-explicit-constructor)
  Tree(const Tree& other) noexcept;
  Tree(Tree&& other) noexcept;
  Tree& operator=(Tree other) noexcept;
  ~Tree();

  /// The list of the values from `first` on, which are popped off the stack.
  static Tree list_from(std::deque<Tree>& stack, std::size_t first);
  /// The map of the alternating keys (text) and values from `first` on, which are popped off the stack.
  static Tree map_from(std::deque<Tree>& stack, std::size_t first);

  bool is_null() const { return kind_ == Kind::null; }
  std::optional<bool> as_bool() const;
  std::optional<double> as_number() const;
  /// The text lives as long as this Tree does.
  std::optional<std::string_view> as_text() const;
  std::optional<ListView> as_list() const;
  std::optional<MapView> as_map() const;

  /// Memory of this value in addition to its own 16 bytes, excluding that of its items [bytes].
  std::size_t memory() const;

  /// A short rendering for error messages: the value itself, or its kind if it is long.
  std::string describe() const;

 private:
  enum class Kind : std::uint8_t { null, boolean, number, short_text, text, numbers, list, map };
  struct Node;  // the shared part, followed by its items
  static constexpr std::size_t longest_short_text = 14;

  template <class Value>
  Tree(Kind kind, Value value);
  template <class Value>
  Value value() const;
  template <class Item>
  static Tree shared(Kind kind, std::size_t size);
  template <class Iterator>
  static Tree shared_copies(Kind kind, Iterator begin, Iterator end);
  template <class Iterator>
  static Tree list(Iterator begin, Iterator end);
  template <class Item>
  Item* items() const;
  bool is_shared() const { return kind_ >= Kind::text; }
  std::size_t size() const;
  void release() noexcept;

  alignas(8) char data_[longest_short_text] = {};  // a number, a flag, a pointer to a Node or a short text
  std::uint8_t length_ = 0;                        // of a short text
  Kind kind_ = Kind::null;
};

/// The items of a list; lives as long as the list does.
class Tree::ListView {
 public:
  class Iterator {
   public:
    Iterator(const ListView* list, std::size_t i) : list_(list), i_(i) {}
    Tree operator*() const { return (*list_)[i_]; }
    Iterator& operator++() { return ++i_, *this; }
    bool operator!=(const Iterator& other) const { return i_ != other.i_; }

   private:
    const ListView* list_;
    std::size_t i_;
  };

  std::size_t size() const { return size_; }
  Tree operator[](std::size_t i) const { return numbers_ ? Tree(numbers_[i]) : items_[i]; }
  Iterator begin() const { return {this, 0}; }
  Iterator end() const { return {this, size_}; }

 private:
  friend class Tree;
  const double* numbers_ = nullptr;  // if all items are numbers
  const Tree* items_ = nullptr;
  std::size_t size_ = 0;
};

/// The entries of a map; lives as long as the map does.
class Tree::MapView {
 public:
  struct Entry {
    std::string_view key;
    const Tree& value;
  };
  class Iterator {
   public:
    explicit Iterator(const Tree* key) : key_(key) {}
    Entry operator*() const { return {*key_->as_text(), key_[1]}; }
    Iterator& operator++() { return key_ += 2, *this; }
    bool operator!=(const Iterator& other) const { return key_ != other.key_; }

   private:
    const Tree* key_;
  };

  std::size_t size() const { return size_; }
  Entry operator[](std::size_t i) const { return *Iterator(items_ + 2 * i); }
  Iterator begin() const { return Iterator(items_); }
  Iterator end() const { return Iterator(items_ + 2 * size_); }
  /// Null if no entry has the key.
  const Tree* find(std::string_view key) const;

 private:
  friend class Tree;
  const Tree* items_ = nullptr;
  std::size_t size_ = 0;
};

/// The decimal number that an entire text spells: digits, sign, point and exponent; not hexadecimal, and not
/// an integer with a leading 0, which YAML 1.1 would take for octal.
std::optional<double> parse_number(std::string_view text);

}  // namespace hybrid_sphere::scene
