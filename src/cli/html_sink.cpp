#include "cli/html_sink.hpp"

#include <sstream>

#include "html/page.hpp"

namespace hybrid_sphere::cli {

HtmlSink::HtmlSink(const std::string& path, const std::string& title, const scene::Scene& scene,
                   std::ostream& out, std::ostream* err)
    : file_(path, out), title_(title), scene_(scene), err_(err) {}

void HtmlSink::write(const OutputBlock& block) {
  for (const State& state : block.states) recording_.add(state);
  for (const Switch& event : block.switches) recording_.add(event);
}

void HtmlSink::finish() {
  std::ostringstream page;
  const auto left_out = html::write_page(scene_, recording_, {title_, ended_}, page);
  file_.write(page.str());
  if (err_ == nullptr) return;
  for (const std::string& each : left_out) *err_ << "simulate: --html: " << each << '\n';
}

}  // namespace hybrid_sphere::cli
