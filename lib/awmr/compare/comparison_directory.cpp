#include "awmr/compare/comparison_directory.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "awmr/compare/metric_columns.h"
#include "awmr/core/csv.h"
#include "awmr/core/csv/csv_cell.h"
#include "awmr/core/file.h"
#include "awmr/core/json/json_document.h"

namespace awmr {
namespace {

/// Largest accepted value of a metric. Larger values could make sums of squares infinite.
constexpr double kLargest = 1e100;

template <class Number>
bool read_number(const std::string& text, Number& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size();
}

/// Reads a row of comparison.csv. Empty if comparison_csv() cannot have written these cells.
std::optional<ComparisonRow> row_of(const std::vector<std::string>& cells, bool with_gains) {
  constexpr std::size_t kFirst = 4;
  if (cells.size() != kFirst + kMetricColumns.size() + (with_gains ? 1 : 0)) return std::nullopt;
  ComparisonRow row;
  row.scenario = cells[0];
  const auto mode = value_in(kYawModeNames, cells[1]);
  if (!mode || !read_number(cells[2], row.sample) || (cells[3] != "0" && cells[3] != "1")) {
    return std::nullopt;
  }
  row.mode = *mode;
  row.metrics.completed = cells[3] == "1";
  for (std::size_t i = 0; i < kMetricColumns.size(); ++i) {
    if (cells[kFirst + i].empty()) continue;
    double value = 0.0;
    if (!read_number(cells[kFirst + i], value) || !(std::abs(value) <= kLargest)) {
      return std::nullopt;
    }
    kMetricColumns[i].set(row.metrics, value);
  }
  if (with_gains) row.gains = cells.back();
  return row;
}

/// Returns the names of the columns of comparison.csv. With `with_gains`, the last column is
/// `gains`.
std::vector<std::string> comparison_columns(bool with_gains) {
  std::vector<std::string> names{"scenario", "mode", "sample", "completed"};
  for (const MetricColumn& metric : kMetricColumns) names.emplace_back(metric.name);
  if (with_gains) names.emplace_back("gains");
  return names;
}

}  // namespace

std::vector<std::pair<std::string_view, std::optional<double>>> named_metrics(
    const Metrics& metrics) {
  std::vector<std::pair<std::string_view, std::optional<double>>> named;
  for (const MetricColumn& metric : kMetricColumns) {
    named.emplace_back(metric.name, metric.value(metrics));
  }
  return named;
}

std::string comparison_csv(const Comparison& comparison) {
  const bool several = std::any_of(comparison.rows.begin(), comparison.rows.end(),
                                   [](const ComparisonRow& row) { return !row.gains.empty(); });
  std::string text = fmt::format("{}\n", fmt::join(comparison_columns(several), ","));
  for (const ComparisonRow& row : comparison.rows) {
    text += cell_of_text(row.scenario);
    text += ',';
    text += name_of(row.mode);
    text += ',' + std::to_string(row.sample) + (row.metrics.completed ? ",1" : ",0");
    for (const MetricColumn& metric : kMetricColumns) {
      text += ',';
      if (const auto value = metric.value(row.metrics)) text += format_number(*value);
    }
    if (several) text += ',' + cell_of_text(row.gains);
    text += '\n';
  }
  return text;
}

Result<std::vector<ComparisonRow>> comparison_rows(std::string_view text, const std::string& file) {
  std::vector<ComparisonRow> rows;
  std::string_view rest = text;
  const std::vector<std::string> head = take_text_record(rest);
  const bool with_gains = head.back() == "gains";
  if (head != comparison_columns(with_gains)) {
    return input_error(ErrorCode::kStaleResult, file + ":1:1",
                       "the file does not have the columns of comparison.csv; run the part again");
  }
  while (!rest.empty()) {
    const std::string_view before = text.substr(0, text.size() - rest.size());
    auto row = row_of(take_text_record(rest), with_gains);
    if (!row) {
      const auto line = 1 + std::count(before.begin(), before.end(), '\n');
      return input_error(ErrorCode::kStaleResult, fmt::format("{}:{}:1", file, line),
                         "this line is not a row of a comparison; run the part again");
    }
    rows.push_back(std::move(*row));
  }
  return rows;
}

Status check_comparison_csv(std::string_view text, const std::string& file) {
  AWMR_RETURN_IF_ERROR(comparison_rows(text, file));
  return {};
}

Status write_comparison(const std::filesystem::path& directory, const Comparison& comparison,
                        const std::string& document) {
  AWMR_RETURN_IF_ERROR(make_directory(directory));
  // comparison.json is written last, because it contains the hash of comparison.csv.
  const OutputFile files[] = {
      {directory / kComparisonTable, comparison_csv(comparison), check_comparison_csv},
      {directory / kComparisonJson, document, check_json_text}};
  return write_files(files);
}

}  // namespace awmr
