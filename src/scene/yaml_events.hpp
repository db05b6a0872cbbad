#pragma once

#include <yaml.h>

#include <istream>
#include <string>

#include "scene/yaml.hpp"

namespace hybrid_sphere::scene {

/// " (line 3)" for a place in a text.
std::string at_line(const yaml_mark_t& mark);

/// An event of the parser, valid until the next one is requested.
class YamlEvent {
 public:
  YamlEvent() = default;
  ~YamlEvent() { yaml_event_delete(&event_); }
  YamlEvent(const YamlEvent&) = delete;
  YamlEvent& operator=(const YamlEvent&) = delete;

  yaml_event_type_t type() const { return event_.type; }
  const yaml_mark_t& mark() const { return event_.start_mark; }
  bool is_plain() const { return event_.data.scalar.style == YAML_PLAIN_SCALAR_STYLE; }
  std::string_view text() const;    ///< of a scalar
  std::string_view tag() const;     ///< of a scalar; empty: none
  std::string_view anchor() const;  ///< of a scalar, a list, a map, an alias; empty: none

 private:
  friend class YamlEvents;
  yaml_event_t event_{};
};

/// The events of a YAML stream, read on request. libyaml looks ahead by at most 1024 characters, one comment
/// or one scalar: bounding the bytes between two events therefore bounds its memory, too.
class YamlEvents {
 public:
  /// @param source  read to its end, but not beyond the limits; must outlive this object
  YamlEvents(std::istream& source, const YamlLimits& limits);
  ~YamlEvents() { yaml_parser_delete(&parser_); }
  YamlEvents(const YamlEvents&) = delete;
  YamlEvents& operator=(const YamlEvents&) = delete;

  /// @throws SceneError      if the source is not YAML, cannot be read, or exceeds the limits
  /// @throws std::bad_alloc
  void next(YamlEvent& event);

 private:
  static int read(void* self, unsigned char* buffer, std::size_t size, std::size_t* read);
  bool read(unsigned char* buffer, std::size_t size, std::size_t& read);
  [[noreturn]] void fail() const;

  std::istream& source_;
  const YamlLimits& limits_;
  yaml_parser_t parser_{};
  std::size_t bytes_ = 0;           // read so far
  std::size_t bytes_at_event_ = 0;  // in which the last event was found
  bool any_ = false;                // event of the document
  std::string fault_;               // of reading
};

}  // namespace hybrid_sphere::scene
