#pragma once

#include <string>

#include "cli/output_file.hpp"
#include "cli/output_sink.hpp"
#include "html/recording.hpp"

namespace hybrid_sphere::cli {

/// A run as a page for a browser, written when it has ended.
class HtmlSink : public OutputSink {
 public:
  /// @param path   a file, or "-" for `out`. Throws WriteError.
  /// @param title  of the page
  /// @param err    where it says what the page leaves out; null: nowhere
  /// @param scene  has to live as long
  HtmlSink(const std::string& path, const std::string& title, const scene::Scene& scene, std::ostream& out,
           std::ostream* err);

  void write(const OutputBlock& block) override;
  void ended_early(const std::string& why) override { ended_ = why; }
  void finish() override;

 private:
  OutputFile file_;
  std::string title_;
  std::string ended_;
  const scene::Scene& scene_;
  std::ostream* err_;
  html::Recording recording_;
};

}  // namespace hybrid_sphere::cli
