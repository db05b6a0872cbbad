#include "cli/study_report.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <sstream>

#include "cli/csv_row.hpp"
#include "cli/table.hpp"

namespace hybrid_sphere::cli::studies {
namespace {

using study::Analysis;
using study::Column;
using study::NumberAnalysis;
using study::Results;

/// The column of a table that is as wide as its widest cell.
std::string aligned(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths;
  for (const std::vector<std::string>& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string text;
  for (const std::vector<std::string>& row : rows) {
    std::string line = " ";
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string space(widths[i] - row[i].size(), ' ');
      line += " " + (i == 0 ? row[i] + space : space + row[i]);
    }
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

std::string number(double value) {
  std::ostringstream text;
  text << std::setprecision(5) << value;
  return text.str();
}

/// "5 halted (numerical 3, livelock 2)"
std::string counted(std::uint64_t count, const char* what,
                    const std::vector<std::pair<std::string, std::uint64_t>>& reasons) {
  std::string text = ", " + std::to_string(count) + " " + what;
  for (const auto& [reason, times] : reasons) {
    text += (&reason == &reasons.front().first ? " (" : ", ") + reason + " " + std::to_string(times);
  }
  return text + (reasons.empty() ? "" : ")");
}

std::string outcomes(const Analysis& analysis) {
  return std::to_string(analysis.done + analysis.halted + analysis.refused) +
         " runs: " + std::to_string(analysis.done) + " done" +
         counted(analysis.halted, "halted", analysis.halts) +
         counted(analysis.refused, "refused", analysis.refusals) + "\n";
}

std::string entered(const Analysis& analysis) {
  std::ostringstream text;
  for (const study::Entered& region : analysis.entered) {
    text << "enters \"" << region.region << "\" with the probability " << number(region.probability) << " ("
         << number(region.interval.low) << " to " << number(region.interval.high) << " with 95 %)\n";
  }
  return text.str();
}

std::string summaries(const Results& results, const Analysis& analysis) {
  const auto& asked = results.study().summarize;
  if (!asked) return "";
  std::vector<std::vector<std::string>> rows{{"", "unit", "mean", "deviation", "least", "greatest"}};
  for (const double p : asked->quantiles) rows.front().push_back(number(100 * p) + " %");
  rows.front().emplace_back("missing");
  for (const NumberAnalysis& each : analysis.numbers) {
    const study::Summary& summary = each.summary;
    rows.push_back({each.name, each.unit});
    if (summary.count == 0) continue;
    for (const double value : {summary.mean, summary.deviation, summary.least, summary.greatest}) {
      rows.back().push_back(number(value));
    }
    for (const double value : summary.quantiles) rows.back().push_back(number(value));
    rows.back().push_back(summary.missing > 0 ? std::to_string(summary.missing) : "");
  }
  return aligned(rows);
}

std::string cell(const study::SobolIndex& index) {
  return number(index.value) + " (" + number(index.low) + " to " + number(index.high) + ")";
}

std::string sensitivities(const Results& results, const Analysis& analysis) {
  std::vector<std::vector<std::string>> rows{{"Sobol' indices", "of", "first (95 %)", "total (95 %)"}};
  for (const NumberAnalysis& each : analysis.numbers) {
    for (std::size_t i = 0; i < each.sensitivity.first.size(); ++i) {
      rows.push_back({i == 0 ? each.name : "", results.study().variables[i].path,
                      cell(each.sensitivity.first[i]), cell(each.sensitivity.total[i])});
    }
  }
  return rows.size() > 1 ? aligned(rows) : "";
}

std::string header_of(const std::vector<Column>& columns) {
  std::string header;
  CsvRow row(header);
  row << "run";
  for (const Column& column : columns) {
    for (std::size_t i = 0; i < column.size(); ++i) row << study::name_of(column, i);
  }
  return header;
}

/// Of a code its name; of what is missing nothing.
void put(const Column& column, double value, CsvRow& row) {
  if (std::isnan(value)) {
    row << "";
  } else if (column.type == Column::Type::real) {
    row << value;
  } else if (column.names.empty()) {
    row << static_cast<std::uint64_t>(value);
  } else {
    row << column.names[static_cast<std::size_t>(value)];
  }
}

void write_runs(const std::string& file, const Results& results) {
  const std::vector<Column>& columns = results.columns().all;
  Table table(file, header_of(columns), std::cout);
  for (std::uint64_t chunk = 0; chunk < results.chunks(); ++chunk) {
    std::vector<std::vector<double>> values;
    std::vector<const Column*> owners;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      for (std::size_t element = 0; element < columns[i].size(); ++element) {
        values.push_back(results.values(chunk, i, element));
        owners.push_back(&columns[i]);
      }
    }
    for (std::uint64_t run = 0; run < results.runs_of(chunk); ++run) {
      CsvRow row(table.rows());
      row << results.first_run(chunk) + run;
      for (std::size_t i = 0; i < values.size(); ++i) put(*owners[i], values[i][run], row);
      row.end();
    }
    table.write();
  }
}

void write_summary(const std::string& file, const Results& results, const Analysis& analysis) {
  std::string header = "name,unit,count,missing,mean,deviation,least,greatest";
  for (const double p : results.study().summarize->quantiles) header += ",quantile " + number(p);
  Table table(file, header, std::cout);
  for (const NumberAnalysis& each : analysis.numbers) {
    CsvRow row(table.rows());
    const study::Summary& summary = each.summary;
    row << each.name << each.unit << summary.count << summary.missing;
    if (summary.count > 0) row << summary.mean << summary.deviation << summary.least << summary.greatest;
    for (const double value : summary.quantiles) row << value;
    row.end();
  }
  table.write();
}

void write_sensitivity(const std::string& file, const Results& results, const Analysis& analysis) {
  Table table(file, "name,variable,first,first_low,first_high,total,total_low,total_high", std::cout);
  for (const NumberAnalysis& each : analysis.numbers) {
    for (std::size_t i = 0; i < each.sensitivity.first.size(); ++i) {
      const study::SobolIndex& first = each.sensitivity.first[i];
      const study::SobolIndex& total = each.sensitivity.total[i];
      CsvRow row(table.rows());
      row << each.name << results.study().variables[i].path << first.value << first.low << first.high
          << total.value << total.low << total.high;
      row.end();
    }
  }
  table.write();
}

}  // namespace

std::string report(const Results& results, const Analysis& analysis) {
  return outcomes(analysis) + entered(analysis) + summaries(results, analysis) +
         sensitivities(results, analysis);
}

void write_tables(const std::string& directory, const Results& results, const Analysis& analysis) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (error) throw WriteError("--csv: \"" + directory + "\" cannot be made: " + error.message());
  write_runs(directory + "/runs.csv", results);
  if (results.study().summarize) write_summary(directory + "/summary.csv", results, analysis);
  if (results.study().sensitivity) write_sensitivity(directory + "/sensitivity.csv", results, analysis);
}

}  // namespace hybrid_sphere::cli::studies
