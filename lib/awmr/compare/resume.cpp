#include "awmr/compare/resume.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <set>

#include "awmr/compare/metric_columns.h"
#include "awmr/core/csv_cell.h"
#include "awmr/core/file.h"
#include "awmr/core/hash.h"
#include "awmr/core/json_document.h"
#include "awmr/core/shard_file.h"
#include "awmr/simulate/batch.h"

namespace awmr {
namespace {

/// Options that may differ when a comparison is resumed, because they do not change finished rows.
const std::set<std::string, std::less<>> kFreeOptions{"samples", "weight", "relevance",
                                                      "break_even"};

/// Largest accepted value of a metric, so that sums of squares over the samples stay finite.
constexpr double kLargest = 1e100;

template <class Number>
bool read_number(const std::string& text, Number& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size();
}

/// Reads a row of comparison.csv. Empty if the cells are not as comparison_csv() writes them.
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

/// Keys of comparison.json that show which comparison its rows belong to.
struct Origin {
  Provenance provenance;
  std::string version;  ///< version of the program that wrote the file
  /// Arithmetic with which the rows were computed; "scalar" if the key is missing.
  std::string arithmetic;
  std::optional<std::string> csv_sha256;  ///< hash of comparison.csv; absent in older files
};

Origin origin_from_json(JsonObject& json) {
  const std::string written_by = json.optional_string("version").value_or("unknown");
  return {read_provenance(json), written_by, json.optional_string("arithmetic").value_or("scalar"),
          json.optional_string("csv_sha256")};
}

Result<Origin> read_origin(const std::filesystem::path& path) {
  AWMR_RETURN_IF_ERROR(check_regular_file(path));
  AWMR_ASSIGN_OR_RETURN(const Json document, read_json_file(path));
  std::vector<Fault> faults;
  JsonObject json(document, path.string(), "", faults);
  Origin origin = origin_from_json(json);
  if (!faults.empty()) return input_errors(std::move(faults));
  return origin;
}

/// The provenance without kFreeOptions: the inputs and options that determine the rows.
Provenance fixed(Provenance provenance) {
  std::erase_if(provenance.options,
                [](const auto& option) { return kFreeOptions.contains(option.first); });
  return provenance;
}

/// Reason why the rows of a comparison do not match `now`, with the remedy; empty if they match.
std::string difference(const Origin& before, const Provenance& now, std::string_view arithmetic) {
  const std::string other =
      origin_difference(fixed(before.provenance), before.version, fixed(now), "this comparison");
  if (!other.empty()) {
    return other + "; resume with the same inputs and options, or compare into another directory";
  }
  if (before.arithmetic == arithmetic) return {};
  return fmt::format(
      "was computed in {} arithmetic, but this processor would use {}, which rounds "
      "differently; compare into another directory",
      before.arithmetic, arithmetic);
}

}  // namespace

Result<std::vector<ComparisonRow>> comparison_rows(std::string_view text, const std::string& file) {
  std::vector<ComparisonRow> rows;
  std::string_view rest = text;
  const std::vector<std::string> head = take_text_record(rest);
  const bool with_gains = head.back() == "gains";
  if (head != comparison_columns(with_gains)) {
    return input_error(ErrorCode::kStaleResult, file + ":1:1",
                       "the file does not have the columns of comparison.csv; compare into another "
                       "directory");
  }
  while (!rest.empty()) {
    const std::string_view before = text.substr(0, text.size() - rest.size());
    auto row = row_of(take_text_record(rest), with_gains);
    if (!row) {
      const auto line = 1 + std::count(before.begin(), before.end(), '\n');
      return input_error(ErrorCode::kStaleResult, fmt::format("{}:{}:1", file, line),
                         "this line is not a row of a comparison; compare into another directory");
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
  // comparison.json is written last, because it has the hash of comparison.csv.
  const OutputFile files[] = {
      {directory / kComparisonTable, comparison_csv(comparison), check_comparison_csv},
      {directory / kComparisonJson, document, [](std::string_view text, const std::string& file) {
         return check_json_object(text, file, origin_from_json);
       }}};
  return write_files(files);
}

Result<std::vector<ComparisonRow>> read_finished(const std::filesystem::path& directory,
                                                 const Provenance& provenance) {
  const std::filesystem::path json = directory / kComparisonJson;
  const std::filesystem::path csv = directory / kComparisonTable;
  AWMR_ASSIGN_OR_RETURN(const Origin before, read_origin(json));
  AWMR_ASSIGN_OR_RETURN(const BatchArithmetic arithmetic, batch_arithmetic());
  const std::string other = difference(before, provenance, arithmetic.rounding);
  if (!other.empty()) return input_error(ErrorCode::kStaleResult, json.string(), other);
  AWMR_RETURN_IF_ERROR(check_regular_file(csv));
  AWMR_ASSIGN_OR_RETURN(const std::string text, read_file(csv));
  if (before.csv_sha256 && *before.csv_sha256 != sha256_hex(text)) {
    return input_error(ErrorCode::kStaleResult, csv.string(),
                       "does not belong to this comparison.json: it was changed, or is of another "
                       "comparison; compare into another directory");
  }
  return comparison_rows(text, csv.string());
}

}  // namespace awmr
