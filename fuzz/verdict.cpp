#include "verdict.hpp"

#include <sstream>

#include "scene/read_tree.hpp"
#include "scene/yaml.hpp"
#include "support/print_scene.hpp"

namespace hybrid_sphere::fuzz {

scene::Scene read_back(const scene::Scene& scene) {
  std::ostringstream text;
  testing::operator<<(text, scene);
  return scene::read_scene(scene::tree_from_yaml(text.str()));
}

std::string text_of(const Case& a_case) {
  std::ostringstream text;
  text.precision(17);
  text << "# --duration " << a_case.duration << "\n";
  testing::operator<<(text, a_case.scene);
  return text.str();
}

std::string reason_alone(const std::string& words) {
  std::string reason;
  for (const char c : words) {
    const bool is_part = (c >= '0' && c <= '9') || c == '-' || c == '.' || c == '+';
    if (!is_part) {
      reason += c == '\n' || c == '\t' ? ' ' : c;
    } else if (reason.empty() || reason.back() != '#') {
      reason += '#';
    }
  }
  return reason.substr(0, 100);
}

}  // namespace hybrid_sphere::fuzz
