#include "html/page.hpp"

#include <algorithm>
#include <ostream>

#include "html/embedded.hpp"
#include "html/json.hpp"
#include "html/page_data.hpp"

namespace hybrid_sphere::html {
namespace {

constexpr std::size_t max_page = 1'990'000;  // bytes

/// What stands for a name in page.html.
std::string_view part(std::string_view name, const std::string& title, const std::string& data) {
  if (name == "title") return title;
  if (name == "style") return embedded::style();
  if (name == "licence") return embedded::licence();
  if (name == "three") return embedded::three();
  if (name == "controls") return embedded::controls();
  if (name == "script") return embedded::script();
  return data;
}

}  // namespace

bool can_write_pages() { return !embedded::three().empty() && !embedded::controls().empty(); }

std::vector<std::string> write_page(const scene::Scene& scene, const Recording& recording,
                                    const PageText& text, std::ostream& out) {
  const std::string title = html_text(text.title);
  const std::size_t fixed = embedded::page().size() + embedded::style().size() + embedded::script().size() +
                            embedded::licence().size() + embedded::three().size() +
                            embedded::controls().size() + title.size();
  const PageData data = page_data(scene, recording, text, max_page - std::min(max_page, fixed));
  std::string_view rest = embedded::page();
  for (std::size_t at = rest.find("{{"); at != std::string_view::npos; at = rest.find("{{")) {
    const std::size_t end = rest.find("}}", at);
    out << rest.substr(0, at) << part(rest.substr(at + 2, end - at - 2), title, data.json);
    rest = rest.substr(end + 2);
  }
  out << rest;
  return data.left_out;
}

}  // namespace hybrid_sphere::html
