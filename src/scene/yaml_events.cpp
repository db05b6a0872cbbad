#include "scene/yaml_events.hpp"

#include <cerrno>
#include <cstring>
#include <new>

namespace hybrid_sphere::scene {
namespace {

std::string_view text_of(const yaml_char_t* text) {
  return text == nullptr ? std::string_view() : std::string_view(reinterpret_cast<const char*>(text));
}

std::string counted(std::size_t bytes) { return "more than " + std::to_string(bytes) + " bytes "; }

}  // namespace

std::string at_line(const yaml_mark_t& mark) { return " (line " + std::to_string(mark.line + 1) + ")"; }

std::string_view YamlEvent::text() const {
  const auto& scalar = event_.data.scalar;
  return {reinterpret_cast<const char*>(scalar.value), scalar.length};
}

std::string_view YamlEvent::tag() const { return text_of(event_.data.scalar.tag); }

std::string_view YamlEvent::anchor() const {
  switch (event_.type) {
    case YAML_SCALAR_EVENT: return text_of(event_.data.scalar.anchor);
    case YAML_SEQUENCE_START_EVENT: return text_of(event_.data.sequence_start.anchor);
    case YAML_MAPPING_START_EVENT: return text_of(event_.data.mapping_start.anchor);
    case YAML_ALIAS_EVENT: return text_of(event_.data.alias.anchor);
    default: return {};
  }
}

YamlEvents::YamlEvents(std::istream& source, const YamlLimits& limits) : source_(source), limits_(limits) {
  if (yaml_parser_initialize(&parser_) == 0) throw std::bad_alloc();
  yaml_parser_set_input(&parser_, &YamlEvents::read, this);
}

int YamlEvents::read(void* self, unsigned char* buffer, std::size_t size, std::size_t* read) {
  return static_cast<YamlEvents*>(self)->read(buffer, size, *read) ? 1 : 0;
}

/// Called by the parser, which no exception may pass.
bool YamlEvents::read(unsigned char* buffer, std::size_t size, std::size_t& read) {
  try {
    errno = 0;
    source_.read(reinterpret_cast<char*>(buffer), static_cast<std::streamsize>(size));
    read = static_cast<std::size_t>(source_.gcount());
    bytes_ += read;
    if (source_.bad()) {
      fault_ = std::string("cannot be read: ") + std::strerror(errno);
    } else if (bytes_ > limits_.bytes) {
      fault_ = "larger than the allowed " + std::to_string(limits_.bytes) + " bytes";
    } else if (!any_ && bytes_ > limits_.first_value) {
      fault_ = counted(limits_.first_value) + "before the first value";
    } else if (bytes_ - bytes_at_event_ > limits_.one_value) {
      fault_ = counted(limits_.one_value) + "from one value to the next" + at_line(parser_.mark);
    }
    return fault_.empty();
  } catch (...) {
    return false;
  }
}

void YamlEvents::next(YamlEvent& event) {
  yaml_event_delete(&event.event_);
  if (yaml_parser_parse(&parser_, &event.event_) == 0) fail();
  bytes_at_event_ = bytes_;
  any_ = any_ || event.type() == YAML_DOCUMENT_START_EVENT;
}

void YamlEvents::fail() const {
  if (!fault_.empty()) throw SceneError(fault_);
  if (parser_.error == YAML_MEMORY_ERROR) throw std::bad_alloc();
  const std::string problem = parser_.problem == nullptr ? "cannot be read" : parser_.problem;
  const bool is_decoded = parser_.error != YAML_READER_ERROR;  // so far that it has lines
  throw SceneError("not YAML: " + problem +
                   (is_decoded ? at_line(parser_.problem_mark)
                               : " (byte " + std::to_string(parser_.problem_offset) + ")"));
}

}  // namespace hybrid_sphere::scene
