#include "awmr/trials/trial_columns.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>

#include "awmr/core/containers.h"
#include "awmr/core/csv/column_expression.h"
#include "awmr/core/csv/column_sources.h"
#include "awmr/core/csv/csv_cell.h"
#include "awmr/core/nearest.h"
#include "awmr/core/text.h"
#include "awmr/trials/column_guess.h"

namespace awmr {
namespace {

const CsvColumn kSurgeColumns[] = {{"tau_speed", false},
                                   {"wheel_force", false},
                                   {"speed_mps", false},
                                   {"distance_m", false},
                                   {"elapsed_s", false}};

// Cells may be empty, because a steered and a differential turn need different columns. turning.cpp
// checks that no row lacks a cell that it needs.
const CsvColumn kTurningColumns[] = {{"steering_deg", true},
                                     {"wheel_force", false, EmptyCells::kOptional},
                                     {"force_left", false, EmptyCells::kOptional},
                                     {"force_right", false, EmptyCells::kOptional},
                                     {"yaw_rate_radps", false, EmptyCells::kOptional},
                                     {"turns", false, EmptyCells::kOptional},
                                     {"elapsed_s", false, EmptyCells::kOptional},
                                     {"tau_turn", false, EmptyCells::kOptional}};

/// Columns of a turning table of a vehicle without steering.
const CsvColumn kSidesTurningColumns[] = {
    {"force_left", true, EmptyCells::kOptional},      {"force_right", true, EmptyCells::kOptional},
    {"yaw_rate_radps", false, EmptyCells::kOptional}, {"turns", false, EmptyCells::kOptional},
    {"elapsed_s", false, EmptyCells::kOptional},      {"tau_turn", false, EmptyCells::kOptional}};

const CsvColumn kCoastdownColumns[] = {{"initial_speed_mps", false},
                                       {"stop_time_s", false},
                                       {"t_s", false},
                                       {"speed_mps", false, EmptyCells::kAbsent},
                                       {"from_mps", false},
                                       {"to_mps", false},
                                       {"elapsed_s", false},
                                       {"run", false}};

const CsvColumn kLogColumns[] = {{"t_s", true},
                                 {"force_left", true, EmptyCells::kHeld},
                                 {"force_right", true, EmptyCells::kHeld},
                                 {"x_m", false, EmptyCells::kAbsent},
                                 {"y_m", false, EmptyCells::kAbsent},
                                 {"heading_deg", false, EmptyCells::kAbsent},
                                 {"speed_mps", false, EmptyCells::kAbsent},
                                 {"sway_mps", false, EmptyCells::kAbsent},
                                 {"yaw_rate_radps", false, EmptyCells::kAbsent},
                                 {"steering_deg", false, EmptyCells::kAbsent},
                                 {"steering_cmd_deg", false, EmptyCells::kHeld},
                                 {"latitude_deg", false, EmptyCells::kAbsent},
                                 {"longitude_deg", false, EmptyCells::kAbsent},
                                 {"run", false}};

std::vector<std::string> all_columns() {
  std::set<std::string> names;
  for (const TrialKind kind : values_in(kTrialKindNames)) {
    for (const CsvColumn& column : columns_of(kind)) names.insert(column.name);
  }
  return {names.begin(), names.end()};
}

std::optional<std::string> unknown_target(const ColumnMapping& mapping) {
  const std::vector<std::string> names = all_columns();
  if (contains(names, mapping.name)) return std::nullopt;
  const std::string near = nearest(mapping.name, names);
  return fmt::format("no trial has a column {}; {}", mapping.name,
                     near.empty() ? fmt::format("there are {}", fmt::join(names, ", "))
                                  : fmt::format("did you mean {}?", near));
}

std::string place_of(const ColumnMapping& mapping) {
  return fmt::format("column mapping \"{}\"", shortened(text_of(mapping), 100));
}

struct Header {
  std::string path;
  std::vector<std::string> names;
};

/// Names in a file's header; for a directory of tables, both `TABLE.COLUMN` and `COLUMN`. Empty if
/// the file cannot be read, or if a name is a number, so that the file has no header.
std::optional<Header> header_of(const std::filesystem::path& path) {
  const auto sample = sample_of(path);
  if (!sample) return std::nullopt;
  Header header{path.string(), sample->names};
  std::error_code error;
  const bool is_directory = std::filesystem::is_directory(path, error);
  for (const std::string& name : sample->names) {
    if (number_from_text(name)) return std::nullopt;
    if (is_directory) header.names.push_back(name.substr(name.find('.') + 1));
  }
  return header;
}

std::vector<Header> headers_of(std::span<const std::filesystem::path> files) {
  std::vector<Header> headers;
  for (const std::filesystem::path& path : files) {
    auto header = header_of(path);
    if (!header) return {};
    headers.push_back(*std::move(header));
  }
  return headers;
}

/// Text for a message: "; did you mean NAME?", or the list of names if none is similar.
std::string nearest_of(const std::string& name, const std::vector<std::string>& names) {
  const std::string near = nearest(name, names);
  return near.empty()
             ? fmt::format("; there are {}", shortened(fmt::format("{}", fmt::join(names, ", "))))
             : fmt::format("; did you mean \"{}\"?", near);
}

/// Text with the syntax error of a mapping's formula; empty if the formula is valid.
std::string why_no_formula(const ColumnMapping& mapping) {
  const auto formula = ColumnExpression::parse(mapping.expression);
  if (mapping.expression.empty() || formula) return "";
  return fmt::format(" (as arithmetic: {})", formula.error());
}

/// Reason why no file can use a mapping; empty if a file can use it, or if no header is known.
std::optional<std::string> unusable(const ColumnMapping& mapping,
                                    const std::vector<Header>& headers) {
  std::vector<std::string> files;
  std::vector<std::string> names;
  std::optional<std::string> missing;
  for (const Header& header : headers) {
    files.push_back(std::filesystem::path(header.path).filename().string());
    if (!is_for(mapping, header.path)) continue;
    const std::vector<std::string> absent = missing_columns(mapping, header.names);
    if (absent.empty()) return std::nullopt;
    if (!missing) missing = absent.front();
    append(names, header.names);
  }
  if (headers.empty()) return std::nullopt;
  if (!missing) {
    return "no file that was read is called " + mapping.file + nearest_of(mapping.file, files);
  }
  return fmt::format("no file that was read has a column \"{}\"{}{}", *missing,
                     nearest_of(*missing, names), why_no_formula(mapping));
}

/// True if a kind of trial requires this column; its reader then reports a missing column.
bool is_required(const std::string& column) {
  for (const TrialKind kind : values_in(kTrialKindNames)) {
    for (const CsvColumn& c : columns_of(kind)) {
      if (c.name == column && c.required) return true;
    }
  }
  return false;
}

std::string trials_with(const std::string& column) {
  std::vector<std::string_view> kinds;
  for (const TrialKind kind : values_in(kTrialKindNames)) {
    const auto columns = columns_of(kind);
    if (std::any_of(columns.begin(), columns.end(),
                    [&](const CsvColumn& c) { return c.name == column; })) {
      kinds.push_back(name_in(kTrialKindNames, kind));
    }
  }
  return fmt::format("{}", fmt::join(kinds, ", "));
}

/// Returns the reason why a mapping is unused although a file has its source columns.
std::string why_unused(const ColumnMapping& mapping) {
  return fmt::format(
      "the files that have the input columns of this formula do not use its result {}, a column of "
      "{} trials; correct the formula or remove it{}",
      mapping.name, trials_with(mapping.name), why_no_formula(mapping));
}

}  // namespace

std::span<const CsvColumn> columns_of(TrialKind kind) {
  switch (kind) {
    case TrialKind::kSurge:
      return kSurgeColumns;
    case TrialKind::kTurning:
      return kTurningColumns;
    case TrialKind::kCoastdown:
      return kCoastdownColumns;
    case TrialKind::kLog:
      return kLogColumns;
  }
  return {};
}

std::span<const CsvColumn> turning_columns(const Vehicle& vehicle) {
  if (vehicle.has_steering()) return kTurningColumns;
  return kSidesTurningColumns;
}

Result<TrialOptions> with_vehicle_columns(TrialOptions options, const Vehicle& vehicle) {
  options.has_steering = vehicle.has_steering();
  options.driven_wheels = vehicle.driven_wheels();
  for (const auto& [name, expression] : vehicle.columns) {
    AWMR_ASSIGN_OR_RETURN(ColumnMapping mapping, parse_column(name, expression));
    mapping.standing = true;
    options.columns.push_back(std::move(mapping));
  }
  std::vector<Fault> faults;
  for (const ColumnMapping& mapping : options.columns) {
    if (auto unknown = unknown_target(mapping)) {
      faults.push_back({ErrorCode::kUnknownName, place_of(mapping), *std::move(unknown)});
    }
  }
  if (!faults.empty()) return input_errors(std::move(faults));
  return options;
}

Status check_mappings(const TrialOptions& options, std::span<const std::size_t> used,
                      std::span<const std::filesystem::path> files) {
  std::vector<Header> headers;
  std::vector<Fault> faults;
  for (std::size_t i = 0; i < options.columns.size(); ++i) {
    const ColumnMapping& mapping = options.columns[i];
    if (mapping.standing || contains(used, i)) continue;
    if (headers.empty()) headers = headers_of(files);
    const std::string why = unusable(mapping, headers).value_or(why_unused(mapping));
    faults.push_back({ErrorCode::kUnusedMapping, place_of(mapping), "unused: " + why});
  }
  if (!faults.empty()) return input_errors(std::move(faults));
  return {};
}

std::vector<Fault> unusable_mappings(const TrialOptions& options,
                                     std::span<const std::filesystem::path> files) {
  std::vector<Fault> faults;
  if (options.columns.empty()) return faults;
  const std::vector<Header> headers = headers_of(files);
  for (const ColumnMapping& mapping : options.columns) {
    if (mapping.standing || is_required(mapping.name)) continue;
    if (auto why = unusable(mapping, headers)) {
      faults.push_back(
          {ErrorCode::kUnusedMapping, place_of(mapping), "unused: " + *std::move(why)});
    }
  }
  return faults;
}

}  // namespace awmr
