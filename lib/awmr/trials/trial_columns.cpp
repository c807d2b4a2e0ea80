#include "awmr/trials/trial_columns.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <utility>

#include "awmr/core/column_expression.h"
#include "awmr/core/nearest.h"
#include "awmr/core/text.h"

namespace awmr {
namespace {

const CsvColumn kSurgeColumns[] = {{"tau_speed", false},
                                   {"wheel_force", false},
                                   {"speed_mps", false},
                                   {"distance_m", false},
                                   {"elapsed_s", false}};

const CsvColumn kTurningColumns[] = {{"steering_deg", true},    {"wheel_force", true},
                                     {"yaw_rate_radps", false}, {"turns", false},
                                     {"elapsed_s", false},      {"tau_turn", false}};

/// Of a vehicle without steering.
const CsvColumn kSidesTurningColumns[] = {{"force_left", true},      {"force_right", true},
                                          {"yaw_rate_radps", false}, {"turns", false},
                                          {"elapsed_s", false},      {"tau_turn", false}};

const CsvColumn kCoastdownColumns[] = {{"initial_speed_mps", false},
                                       {"stop_time_s", false},
                                       {"t_s", false},
                                       {"speed_mps", false, EmptyCells::kAbsent},
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

/// Every column that some trial has, each once.
std::vector<std::string> all_columns() {
  std::set<std::string> names;
  for (const TrialKind kind : values_in(kTrialKindNames)) {
    for (const CsvColumn& column : columns_of(kind)) names.insert(column.name);
  }
  return {names.begin(), names.end()};
}

std::optional<std::string> unknown_target(const ColumnMapping& mapping) {
  const std::vector<std::string> names = all_columns();
  if (std::find(names.begin(), names.end(), mapping.name) != names.end()) return std::nullopt;
  const std::string near = nearest(mapping.name, names);
  return fmt::format("no trial has a column {}; {}", mapping.name,
                     near.empty() ? fmt::format("there are {}", fmt::join(names, ", "))
                                  : fmt::format("did you mean {}?", near));
}

std::string place_of(const ColumnMapping& mapping) {
  return fmt::format("column mapping \"{}\"", shortened(text_of(mapping), 100));
}

/// Why no file used a mapping, as far as it can be told.
std::string unused(const ColumnMapping& mapping) {
  std::string message =
      "unused: no file that was read asks for this column and has what it is made from; correct it "
      "or leave it out";
  const auto expression = ColumnExpression::parse(mapping.expression);
  if (!mapping.expression.empty() && !expression) {
    message += fmt::format(" (as arithmetic: {})", expression.error());
  }
  return message;
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
  for (const auto& [name, expression] : vehicle.columns) {
    AWMR_ASSIGN_OR_RETURN(ColumnMapping mapping, parse_column(name, expression));
    mapping.standing = true;
    options.columns.push_back(std::move(mapping));
  }
  std::vector<Fault> faults;
  for (const ColumnMapping& mapping : options.columns) {
    if (auto unknown = unknown_target(mapping)) {
      faults.push_back({place_of(mapping), *std::move(unknown)});
    }
  }
  if (!faults.empty()) return input_errors(std::move(faults));
  return options;
}

Status check_mappings(const TrialOptions& options, std::span<const std::size_t> used) {
  std::vector<Fault> faults;
  for (std::size_t i = 0; i < options.columns.size(); ++i) {
    const ColumnMapping& mapping = options.columns[i];
    if (mapping.standing || std::find(used.begin(), used.end(), i) != used.end()) continue;
    faults.push_back({place_of(mapping), unused(mapping)});
  }
  if (!faults.empty()) return input_errors(std::move(faults));
  return {};
}

}  // namespace awmr
