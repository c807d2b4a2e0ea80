#include "table_consistency.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>

#include "awmr/core/option_text.h"
#include "awmr/core/units.h"
#include "awmr/trials/log_evidence.h"
#include "full_scale.h"
#include "table_units.h"

namespace awmr {
namespace {

/// Where the file and its findings are named, and what becomes of a contradiction.
struct Table {
  const std::filesystem::path& path;
  const std::string& file;
  const TrialOptions& options;
  std::vector<Finding>& findings;
  std::vector<Fault>& faults;

  void tell(int line, const std::string& message, std::string_view column, double factor) const {
    if (options.as_is) {
      findings.push_back({file, line, Severity::kWarning, "table-contradiction", message});
      return;
    }
    const std::string mapping = scaled_mapping(options.columns, column, factor);
    faults.push_back({fmt::format("{}:{}", path.string(), line),
                      fmt::format("{}; map it by {}, or take it {}", message,
                                  option_text("column '" + mapping + "'"), option_text("as-is"))});
  }
};

/// The first row whose number is above `limit`, the largest number being `largest`.
template <class Row>
struct Beyond {
  const Row* first = nullptr;
  double largest = 0.0;
};

/// `number` is a member of Row, or a function of one.
template <class Row, class Number>
Beyond<Row> beyond(const std::vector<Row>& rows, Number number, double limit) {
  constexpr double kRounding = 1.01;
  Beyond<Row> found;
  for (const Row& row : rows) {
    const double here = std::invoke(number, row);
    found.largest = std::max(found.largest, here);
    if (found.first == nullptr && here > limit * kRounding) found.first = &row;
  }
  return found;
}

void tell_unit(const Table& table, const std::optional<WrongUnit>& wrong) {
  if (wrong) table.tell(wrong->line, wrong->message, wrong->column, wrong->factor);
}

double largest_side_force(const TurningRow& row) {
  if (!row.sides) return 0.0;
  return std::max(std::abs(row.sides->left), std::abs(row.sides->right));
}

/// In turns by the sides each has a force of its own.
void check_sides(const Table& table, const std::vector<TurningRow>& rows, const Interval& force) {
  const double limit = std::max(force.hi, -force.lo);
  const auto [first, largest] = beyond(rows, largest_side_force, limit);
  if (first == nullptr) return;
  const auto [words, factor] = full_scale_of(largest, limit);
  for (const char* column : {"force_left", "force_right"}) {
    table.tell(first->line,
               fmt::format("the forces of the sides go beyond wheel_force [{:g}, {:g}] of the "
                           "vehicle, and reach {:.4g}: {}",
                           force.lo, force.hi, largest, words),
               column, factor);
  }
}

}  // namespace

void check_consistency(const TrialSet<SurgeRow>& surge, const std::filesystem::path& path,
                       const Vehicle& vehicle, const TrialOptions& options,
                       std::vector<Finding>& findings, std::vector<Fault>& faults) {
  const Table table{path, surge.file, options, findings, faults};
  tell_unit(table, wrong_unit(surge, vehicle));
  // tau_speed = 4 F' with the wheels straight                                    [paper (41)]
  const int wheels = vehicle.driven_wheels();
  const double limit = wheels * vehicle.wheel_force.hi;
  const auto [first, largest] = beyond(surge.rows, &SurgeRow::tau_speed, limit);
  if (first == nullptr) return;
  const auto [words, factor] = full_scale_of(largest / wheels, vehicle.wheel_force.hi);
  table.tell(
      first->line,
      fmt::format("tau_speed is {:.4g}, beyond {} F'max = {:g} (wheel_force [{:g}, {:g}] of the "
                  "vehicle), and reaches {:.4g}: {}",
                  first->tau_speed, wheels, limit, vehicle.wheel_force.lo, vehicle.wheel_force.hi,
                  largest, words),
      surge.force_column, factor);
}

void check_consistency(const TrialSet<TurningRow>& turning, const std::filesystem::path& path,
                       const Vehicle& vehicle, const TrialOptions& options,
                       std::vector<Finding>& findings, std::vector<Fault>& faults) {
  const Table table{path, turning.file, options, findings, faults};
  tell_unit(table, wrong_unit(turning));
  const bool is_by_sides = !turning.rows.empty() && turning.rows.front().sides;
  if (!vehicle.has_steering() || is_by_sides) {
    return check_sides(table, turning.rows, vehicle.wheel_force);
  }
  check_sides(table, turning.by_sides, vehicle.wheel_force);
  const double limit = vehicle.wheel_force.hi;
  if (const auto [first, largest] = beyond(turning.rows, &TurningRow::wheel_force, limit); first) {
    const auto [words, factor] = full_scale_of(largest, limit);
    table.tell(first->line,
               fmt::format("wheel_force is {:.4g}, beyond wheel_force [{:g}, {:g}] of the vehicle, "
                           "and reaches {:.4g}: {}",
                           first->wheel_force, vehicle.wheel_force.lo, limit, largest, words),
               turning.force_column, factor);
  }
  constexpr double kSmall = 0.02;  // of the stop: what a degree is in radians
  const double steepest_deg = degrees(
      beyond(turning.rows, &TurningRow::steering_rad, radians(vehicle.steering_max_deg)).largest);
  if (turning.rows.empty() || steepest_deg >= kSmall * vehicle.steering_max_deg) return;
  table.tell(
      turning.rows.front().line,
      fmt::format("steering_deg is at most {:.4g} in all runs, below 2 % of the stop at {:g}: "
                  "the angles look like radians",
                  steepest_deg, vehicle.steering_max_deg),
      "steering_deg", degrees(1.0));
}

void check_consistency(const TrialSet<StopTimeRow>& coastdown,
                       const std::optional<TrialSet<SurgeRow>>& surge,
                       const std::filesystem::path& path, const Vehicle& vehicle,
                       const TrialOptions& options, std::vector<Finding>& findings,
                       std::vector<Fault>& faults) {
  tell_unit({path, coastdown.file, options, findings, faults},
            wrong_unit(coastdown, surge, vehicle));
}

}  // namespace awmr
