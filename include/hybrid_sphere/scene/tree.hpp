#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace hybrid_sphere::scene {

/// A tree of named values: the one form in which scenes arrive, whether from a YAML file, from the parameter
/// server or in a message.
class Tree {
 public:
  using List = std::vector<Tree>;
  using Map =
      std::vector<std::pair<std::string, Tree>>;  ///< in the order of the source; keys may repeat there

  Tree() = default;
  Tree(bool value) : value_(value) {}                      // NOLINT(google-explicit-constructor)
  Tree(double value) : value_(value) {}                    // NOLINT(google-explicit-constructor)
  Tree(std::string value) : value_(std::move(value)) {}    // NOLINT(google-explicit-constructor)
  Tree(const char* value) : value_(std::string(value)) {}  // NOLINT(google-explicit-constructor)
  Tree(List value) : value_(std::move(value)) {}           // NOLINT(google-explicit-constructor)
  Tree(Map value) : value_(std::move(value)) {}            // NOLINT(google-explicit-constructor)

  bool is_null() const { return std::holds_alternative<std::monostate>(value_); }
  const bool* as_bool() const { return std::get_if<bool>(&value_); }
  const double* as_number() const { return std::get_if<double>(&value_); }
  const std::string* as_text() const { return std::get_if<std::string>(&value_); }
  const List* as_list() const { return std::get_if<List>(&value_); }
  const Map* as_map() const { return std::get_if<Map>(&value_); }

  /// A short rendering for error messages: the value itself, or what kind of thing it is when it is long.
  std::string describe() const;

 private:
  std::variant<std::monostate, bool, double, std::string, List, Map> value_;
};

/// The decimal number that a whole text is: digits, sign, point and exponent, not in hexadecimal, and no
/// whole number that begins with 0, which YAML 1.1 would take for octal.
std::optional<double> parse_number(const std::string& text);

/// Text as it may be shown on a terminal: shortened, without control characters.
std::string printable(const std::string& text);

/// A value that cannot be taken. what() is "<path>: <value> is refused: <what is allowed>".
class SceneError : public std::runtime_error {
 public:
  /// @param path     full path of the key, e.g. surface.regions[2].circle.radius
  /// @param value    what stood there
  /// @param allowed  the allowed range or form
  SceneError(const std::string& path, const std::string& value, const std::string& allowed);
  /// A source that cannot be read at all (no file, no YAML, too large).
  explicit SceneError(const std::string& message) : std::runtime_error(message) {}
};

}  // namespace hybrid_sphere::scene
