#include "hybrid_sphere/scene/yaml.hpp"

#include <yaml-cpp/yaml.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

namespace hybrid_sphere::scene {
namespace {

std::string at(const YAML::Mark& mark) {
  return mark.is_null() ? "" : " (line " + std::to_string(mark.line + 1) + ")";
}

/// A plain scalar is what YAML 1.1, and so the parameter server, takes it for; a quoted one is text.
Tree tree_from_scalar(const YAML::Node& node) {
  const std::string& text = node.Scalar();
  if (node.Tag() == "!") return text;
  double number = 0;
  if (YAML::convert<double>::decode(node, number)) return number;
  bool flag = false;
  if (text.size() > 1 && YAML::convert<bool>::decode(node, flag)) return flag;
  return text;
}

class Converter {
 public:
  explicit Converter(const YamlLimits& limits) : limits_(limits) {}

  Tree convert(const YAML::Node& node, std::size_t depth) {
    if (depth > limits_.depth) {
      throw SceneError("nested deeper than " + std::to_string(limits_.depth) + " levels" + at(node.Mark()));
    }
    // An alias may stand for a large part of the document, again and again.
    if (++values_ > limits_.values) {
      throw SceneError("more than " + std::to_string(limits_.values) + " values" + at(node.Mark()));
    }
    if (node.IsScalar()) return tree_from_scalar(node);
    if (node.IsSequence()) {
      Tree::List list;
      for (const YAML::Node& item : node) list.push_back(convert(item, depth + 1));
      return list;
    }
    if (node.IsMap()) {
      Tree::Map map;
      for (const auto& entry : node) {
        if (!entry.first.IsScalar()) throw SceneError("a key that is not text" + at(entry.first.Mark()));
        map.emplace_back(entry.first.Scalar(), convert(entry.second, depth + 1));
      }
      return map;
    }
    return {};
  }

 private:
  const YamlLimits& limits_;
  std::size_t values_ = 0;
};

[[noreturn]] void refuse_file(const std::string& path, const std::string& why) {
  throw SceneError("scene file \"" + path + "\": " + why);
}

}  // namespace

Tree tree_from_yaml(const std::string& text, const YamlLimits& limits) {
  if (text.size() > limits.bytes) {
    throw SceneError("larger than the allowed " + std::to_string(limits.bytes) + " bytes");
  }
  try {
    const std::vector<YAML::Node> documents = YAML::LoadAll(text);
    if (documents.empty() || (documents.size() == 1 && documents.front().IsNull())) throw SceneError("empty");
    if (documents.size() > 1) throw SceneError("more than one YAML document");
    return Converter(limits).convert(documents.front(), 1);
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
    if (text.size() > limits.bytes) {
      refuse_file(path, "larger than the allowed " + std::to_string(limits.bytes) + " bytes");
    }
  }
  if (file.bad()) refuse_file(path, std::string("cannot be read: ") + std::strerror(errno));
  try {
    return tree_from_yaml(text, limits);
  } catch (const SceneError& error) {
    refuse_file(path, error.what());
  }
}

}  // namespace hybrid_sphere::scene
