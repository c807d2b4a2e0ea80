#include "table_consistency.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "awmr/core/containers.h"
#include "awmr/core/option_text.h"
#include "awmr/core/units.h"
#include "force_units.h"
#include "table_units.h"

namespace awmr {
namespace {

struct Table {
  const std::filesystem::path& path;
  const std::string& file;
  const TrialOptions& options;
  std::vector<Finding>& findings;
  std::vector<Fault>& faults;

  /// Reports a contradiction as a fault, or as a finding if the option `as_is` is set. `remedy`:
  /// advice such as "map it with ..."; may be empty.
  void report(int line, const std::string& message, const std::string& remedy) const {
    if (options.as_is) {
      findings.push_back({file, line, Severity::kWarning, "table-contradiction", message});
      return;
    }
    faults.push_back({ErrorCode::kContradiction, fmt::format("{}:{}", path.string(), line),
                      fmt::format("{}; {}{}accept it with {}", message, remedy,
                                  remedy.empty() ? "" : ", or ", option_text("as-is"))});
  }
  void report(const std::optional<WrongUnit>& wrong) const {
    if (!wrong) return;
    const std::string mapped = mapped_by(wrong->unit_fixes, options.columns);
    report(wrong->line, wrong->message, mapped.empty() ? wrong->remedy : mapped);
  }
};

/// Result of comparing forces with the vehicle's limit: the first row beyond it (null if none), and
/// the range of the forces of all rows.
template <class Row>
struct Beyond {
  const Row* first = nullptr;
  ForceSpan span{std::numeric_limits<double>::infinity(), 0.0};
};

/// Compares the forces of the rows with `limit`. `force(row)` returns the range of the row's
/// forces. Ignores forces of 0, which are 0 in any unit.
template <class Row, class Force>
Beyond<Row> beyond(const std::vector<Row>& rows, Force force, double limit) {
  Beyond<Row> found;
  for (const Row& row : rows) {
    const ForceSpan here = force(row);
    if (here.largest == 0.0) continue;
    found.span = joined(found.span, here);
    if (found.first == nullptr && here.largest > limit * kForceRounding) found.first = &row;
  }
  return found;
}

ForceSpan side_forces(const TurningRow& row) {
  if (!row.sides) return {};
  const auto& [left, right] = *row.sides;
  const double largest = std::max(std::abs(left), std::abs(right));
  if (left == 0.0 || right == 0.0) return {left + right, largest};
  return {std::min(left, right), largest};
}

ForceSpan steered_force(const TurningRow& row) { return {row.wheel_force, row.wheel_force}; }
ForceSpan thrust(const SurgeRow& row) { return {row.tau_speed, row.tau_speed}; }

/// Range of the wheel forces in those tables of a vehicle in which the forces exceed the limit and
/// cannot be F' (force over F_max). They decide the unit of each force column whose values cannot
/// be F'. Empty if there is no such table.
std::optional<ForceSpan> forces_in_other_units(const Tables& tables) {
  std::optional<ForceSpan> found;
  const auto add = [&found](const auto& forces, int wheels) {
    const ForceSpan span{forces.span.least / wheels, forces.span.largest / wheels};
    if (forces.first == nullptr || is_share_of_f_max(span)) return;
    found = found ? joined(*found, span) : span;
  };
  if (tables.surge && tables.surge->force_column == "wheel_force") {
    const int wheels = tables.vehicle.driven_wheels();
    add(beyond(tables.surge->rows, thrust, wheels * tables.vehicle.wheel_force.hi), wheels);
  }
  if (tables.turning) {
    for (const auto* rows :
         {&tables.turning->rows, &tables.turning->by_sides, &tables.turning->standing}) {
      add(beyond(*rows, side_forces, largest_wheel_force(tables.vehicle)), 1);
      add(beyond(*rows, steered_force, tables.vehicle.wheel_force.hi), 1);
    }
  }
  return found;
}

/// Range of forces that decides the unit of a column: `own`, the range of the column itself, if its
/// values can be F'; else forces_in_other_units().
ForceSpan deciding_forces(const ForceSpan& own, const Tables& tables) {
  return is_share_of_f_max(own) ? own : forces_in_other_units(tables).value_or(own);
}

std::string limits_text(const Interval& force) {
  return fmt::format("wheel_force [{:g}, {:g}] of the vehicle", force.lo, force.hi);
}

void check_sides(const Table& table, const std::vector<TurningRow>& rows, const Tables& tables) {
  const auto [first, span] = beyond(rows, side_forces, largest_wheel_force(tables.vehicle));
  if (first == nullptr) return;
  const ForceUnits units = force_units(deciding_forces(span, tables), tables.vehicle);
  for (const char* column : {"force_left", "force_right"}) {
    table.report(
        first->line,
        fmt::format("force_left or force_right is beyond {} (largest in the table: {:.4g}): {}",
                    limits_text(tables.vehicle.wheel_force), span.largest, words_of(units)),
        remedy_of(units, force_unit_fixes(units, column), table.options.columns));
  }
}

void check_wheel_force(const Table& table, const std::vector<TurningRow>& rows,
                       const Tables& tables) {
  const auto [first, span] = beyond(rows, steered_force, tables.vehicle.wheel_force.hi);
  if (first == nullptr) return;
  const ForceUnits units = force_units(deciding_forces(span, tables), tables.vehicle);
  table.report(first->line,
               fmt::format("wheel_force is {:.4g}, beyond {} (largest in the table: {:.4g}): {}",
                           first->wheel_force, limits_text(tables.vehicle.wheel_force),
                           span.largest, words_of(units)),
               remedy_of(units, force_unit_fixes(units, "wheel_force"), table.options.columns));
}

/// Checks the tau_speed of surge runs against its limit n F'max, with the number n of driven wheels
/// and the largest force F'max of one wheel. For n = 4 and straight wheels
///   tau_speed = 4 F'                                                                [paper (41)]
void check_thrust(const Table& table, const TrialSet<SurgeRow>& surge, const Tables& tables) {
  const Vehicle& vehicle = tables.vehicle;
  const int wheels = vehicle.driven_wheels();
  const double limit = wheels * vehicle.wheel_force.hi;
  const auto [first, span] = beyond(surge.rows, thrust, limit);
  if (first == nullptr) return;
  const bool by_wheel = surge.force_column == "wheel_force";
  ThrustUnits found;
  if (by_wheel) {
    const ForceSpan of_one{span.least / wheels, span.largest / wheels};
    found.units = force_units(deciding_forces(of_one, tables), vehicle);
    found.unit_fixes = force_unit_fixes(found.units, "wheel_force");
  } else {
    found = thrust_units(span, forces_in_other_units(tables), vehicle);
  }
  const std::string of_wheel =
      by_wheel ? fmt::format("{} x wheel_force {:.4g} = ", wheels, first->tau_speed / wheels) : "";
  table.report(
      first->line,
      fmt::format("tau_speed is {}{:.4g}, beyond {} F'max = {:g} ({}; largest in the table: "
                  "{:.4g}): {}",
                  of_wheel, first->tau_speed, wheels, limit, limits_text(vehicle.wheel_force),
                  span.largest, words_of(found.units)),
      remedy_of(found.units, found.unit_fixes, table.options.columns));
}

/// Reports steering angles that are probably in radians. Returns false if it reports them.
bool check_steering(const Table& table, const std::vector<TurningRow>& rows,
                    const Vehicle& vehicle) {
  // Angles may be in radians if all are below this fraction of the stop in degrees: 1 deg is 0.0175
  // rad.
  constexpr double kSmall = 0.02;
  if (rows.empty()) return true;
  const double steepest_deg =
      degrees(std::ranges::max_element(rows, {}, &TurningRow::steering_rad)->steering_rad);
  if (steepest_deg >= kSmall * vehicle.steering_max_deg) return true;
  const UnitFix radians{"radians", "steering_deg", degrees(1.0)};
  table.report(
      rows.front().line,
      fmt::format("steering_deg is at most {:.4g} in all runs, below 2 % of the stop at {:g}: "
                  "the angles look like radians",
                  steepest_deg, vehicle.steering_max_deg),
      mapped_by({&radians, 1}, table.options.columns));
  return false;
}

double fastest_run_mps(const TrialSet<SurgeRow>& surge) {
  return std::ranges::max_element(surge.rows, {}, &SurgeRow::speed_mps)->speed_mps;
}

/// Adds the warning `coast-beyond-surge` if a coast-down begins much faster than every surge run.
void warn_of_fast_coasts(const Table& table, int line, double fastest_mps,
                         const std::optional<TrialSet<SurgeRow>>& surge) {
  constexpr double kFar = 1.5;
  if (!surge || surge->rows.empty()) return;
  const double driven_mps = fastest_run_mps(*surge);
  if (fastest_mps <= kFar * driven_mps) return;
  table.findings.push_back(
      {table.file, line, Severity::kWarning, "coast-beyond-surge",
       fmt::format("a coast-down begins at {:.3g} m/s, {:.2g} times the fastest surge run "
                   "({:.3g} m/s): mass_norm depends on a resistance that no run measured. "
                   "Record faster surge runs, or check the unit of the speeds (km/h are 3.6 "
                   "times m/s)",
                   fastest_mps, fastest_mps / driven_mps, driven_mps)});
}

/// The coast-down with the highest initial speed, and the line with its first row.
struct FastestCoast {
  std::string file = {};
  int line = 0;
  double speed_mps = 0.0;
};

FastestCoast fastest_coast(const TrialData& data) {
  FastestCoast fastest;
  const auto consider = [&](const std::string& file, int line, double speed_mps) {
    if (speed_mps > fastest.speed_mps) fastest = {file, line, speed_mps};
  };
  if (data.coastdown) {
    for (const StopTimeRow& row : data.coastdown->rows) {
      consider(data.coastdown->file, row.line, row.initial_speed_mps);
    }
  }
  for (const CoastCurve& curve : data.curves) {
    consider(curve.file, curve.line, std::ranges::max(curve.speed_mps));
  }
  return fastest;
}

}  // namespace

void warn_of_slow_coasts(const TrialData& data, std::vector<Finding>& findings) {
  constexpr double kSlow = 1.0 / 3.0;
  const FastestCoast coast = fastest_coast(data);
  if (coast.speed_mps == 0.0 || !data.surge || data.surge->rows.empty()) return;
  const double driven_mps = fastest_run_mps(*data.surge);
  if (coast.speed_mps >= kSlow * driven_mps) return;
  findings.push_back(
      {coast.file, coast.line, Severity::kWarning, "coast-below-surge",
       fmt::format(
           "the fastest coast-down begins at {:.3g} m/s, {:.2g} times the fastest surge run "
           "({:.3g} m/s): one of the tables may have its speeds in another unit (km/h are 3.6 "
           "times m/s), which makes mass_norm wrong. If both are in m/s, coast from a higher "
           "speed",
           coast.speed_mps, coast.speed_mps / driven_mps, driven_mps)});
}

void check_consistency(const TrialSet<SurgeRow>& surge, const std::filesystem::path& path,
                       const Tables& tables, const TrialOptions& options,
                       std::vector<Finding>& findings, std::vector<Fault>& faults) {
  const Table table{path, surge.file, options, findings, faults};
  table.report(wrong_unit(surge, tables.vehicle));
  check_thrust(table, surge, tables);
}

void check_consistency(const TrialSet<TurningRow>& turning, const std::filesystem::path& path,
                       const Tables& tables, const TrialOptions& options,
                       std::vector<Finding>& findings, std::vector<Fault>& faults) {
  const Table table{path, turning.file, options, findings, faults};
  const bool is_by_sides = !turning.rows.empty() && turning.rows.front().sides;
  const bool is_steered = tables.vehicle.has_steering() && !is_by_sides;
  const auto wrong = wrong_unit(turning);
  table.report(wrong);
  const bool angles_right = !is_steered || check_steering(table, turning.rows, tables.vehicle);
  if (!wrong && angles_right) table.report(wrong_turn(turning, tables.surge, tables.vehicle));
  std::vector<TurningRow> by_sides = is_by_sides || !is_steered ? turning.rows : turning.by_sides;
  append(by_sides, turning.standing);
  check_sides(table, by_sides, tables);
  if (is_steered) check_wheel_force(table, turning.rows, tables);
}

void check_consistency(const CoastdownSet& coastdown, const std::filesystem::path& path,
                       const Tables& tables, const TrialOptions& options,
                       std::vector<Finding>& findings, std::vector<Fault>& faults) {
  const auto check = [&](const std::string& file, int line, double fastest_mps,
                         const std::optional<WrongUnit>& wrong) {
    const Table table{path, file, options, findings, faults};
    table.report(wrong);
    if (!wrong) warn_of_fast_coasts(table, line, fastest_mps, tables.surge);
  };
  if (const auto* stops = std::get_if<TrialSet<StopTimeRow>>(&coastdown)) {
    if (stops->rows.empty()) return;
    const auto& fastest =
        *std::ranges::max_element(stops->rows, {}, &StopTimeRow::initial_speed_mps);
    check(stops->file, fastest.line, fastest.initial_speed_mps,
          wrong_unit(*stops, tables.surge, tables.vehicle));
    return;
  }
  const auto& curves = std::get<std::vector<CoastCurve>>(coastdown);
  if (curves.empty()) return;
  const auto top = [](const CoastCurve& curve) { return std::ranges::max(curve.speed_mps); };
  const CoastCurve& fastest = *std::ranges::max_element(curves, {}, top);
  check(fastest.file, fastest.line, top(fastest), wrong_unit(curves, tables.surge, tables.vehicle));
}

}  // namespace awmr
