#pragma once

#include <string>

#include "cli/output_sink.hpp"
#include "cli/table.hpp"

namespace hybrid_sphere::cli {

/// The states of a run as a CSV table.
class StatesSink : public OutputSink {
 public:
  /// @param path  a file, or "-" for `out`. Throws WriteError.
  StatesSink(const std::string& path, std::ostream& out);
  void write(const OutputBlock& block) override;

 private:
  Table table_;
};

/// The switches of a run as a CSV table.
class SwitchesSink : public OutputSink {
 public:
  /// @param path  a file, or "-" for `out`. Throws WriteError.
  SwitchesSink(const std::string& path, std::ostream& out);
  void write(const OutputBlock& block) override;

 private:
  Table table_;
};

}  // namespace hybrid_sphere::cli
