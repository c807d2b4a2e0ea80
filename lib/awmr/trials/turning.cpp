#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "awmr/core/containers.h"
#include "awmr/core/csv.h"
#include "awmr/core/units.h"
#include "awmr/model/dynamics.h"
#include "awmr/trials/checks/repeated_rows.h"
#include "awmr/trials/formats/read_table.h"
#include "awmr/trials/trial_columns.h"
#include "rest_limits.h"
#include "trial_reader.h"

namespace awmr {
namespace {

const Rate kTurningRate{.printed_column = "yaw_rate_radps",
                        .amount_column = "turns",
                        .per_amount = 2.0 * pi<double>(),
                        .code = "yaw-rate-mismatch"};

/// Relative error of the computed tau_turn: the vehicle's dimensions and the steering angle are
/// known to about 1 %.
constexpr double kGeometryError = 0.01;

void check_turning_columns(TrialReader& reader, const Vehicle& vehicle) {
  if (vehicle.has_steering()) {
    if (reader.has("force_left") != reader.has("force_right")) {
      reader.header_fault(ErrorCode::kMissing,
                          "force_left and force_right belong together: add the missing column");
    } else if (!reader.has("wheel_force") && !reader.has("force_left")) {
      reader.header_fault(ErrorCode::kMissing,
                          "no force: add a column wheel_force, or force_left and force_right");
    }
  }
  if (!reader.has("yaw_rate_radps") && !(reader.has("turns") && reader.has("elapsed_s"))) {
    reader.header_fault(ErrorCode::kMissing,
                        "no yaw rate: add a column yaw_rate_radps, or turns and elapsed_s");
  }
}

/// Cause of the turn in a row of the file: steering, or a force difference.
struct Turn {
  /// The value of steering_deg, or F'R - F'L if the turn is differential; left positive.
  double left = 0.0;
  std::string in_words;     ///< cause of the turn, for messages: "steering_deg 5"
  double computed_m = 0.0;  ///< tau_turn computed from the forces, over F_max, m, >= 0
  std::string equation;     ///< equation of computed_m, for messages
  std::string parameter;    ///< vehicle parameter in the equation: "front_axle_m"
  double length_m = 0.0;    ///< value of this parameter
  double steering_rad = 0.0;
  double wheel_force = 0.0;
  std::optional<SideForces<double>> sides = {};
};

/// Adds a fault if the sign of `value` is opposite to that of the turn (left positive).
void check_side(TrialReader& reader, std::size_t row, const char* column, double value,
                const Turn& turn) {
  if (value * turn.left >= 0.0) return;
  reader.fault(ErrorCode::kContradiction, row, column,
               fmt::format("found {} with {}: both are positive to the left, so their signs must "
                           "agree",
                           value, turn.in_words));
}

std::optional<double> printed_yaw_rate(TrialReader& reader, std::size_t row, const Turn& turn) {
  const auto rate = reader.cell(row, "yaw_rate_radps");
  if (!rate) return std::nullopt;
  check_side(reader, row, "yaw_rate_radps", *rate, turn);
  return std::abs(*rate);
}

void check_stop(const TrialReader& reader, std::size_t row, const Vehicle& vehicle,
                double steering_deg, std::vector<Finding>& findings) {
  if (std::abs(steering_deg) <= vehicle.steering_max_deg) return;
  findings.push_back(reader.finding(
      row, Severity::kWarning, "steering-stop",
      fmt::format("steering_deg is {}, beyond the vehicle's stop at {} deg: correct the row or "
                  "steering.max_deg; the row is used as given",
                  steering_deg, vehicle.steering_max_deg)));
}

/// Returns the magnitude of the yaw moment tau_turn, m: the value in the file, else the computed
/// value. (The paper's table gives the unit N m. In awmr, moments are divided by F_max, so the unit
/// is m.)
double tau_turn_of(TrialReader& reader, std::size_t row, const Turn& turn,
                   std::vector<Finding>& findings) {
  const auto cell = reader.cell(row, "tau_turn");
  if (!cell) return turn.computed_m;
  check_side(reader, row, "tau_turn", *cell, turn);
  const double printed = std::abs(*cell);
  const double tolerance =
      reader.rounding_error(printed, "tau_turn") + kGeometryError * turn.computed_m;
  if (std::abs(printed - turn.computed_m) > tolerance) {
    const std::string implied = turn.computed_m > 0.0
                                    ? fmt::format(" (it implies a {} of {:.3f})", turn.parameter,
                                                  turn.length_m * printed / turn.computed_m)
                                    : std::string();
    findings.push_back(reader.finding(
        row, Severity::kWarning, "tau-turn-mismatch",
        fmt::format("tau_turn is {}, but {} with {} {} gives {:.4g}; the printed value {} is "
                    "used{}. Correct the row, or remove the column tau_turn",
                    printed, turn.equation, turn.parameter, turn.length_m, turn.computed_m, printed,
                    implied)));
  }
  return printed;
}

/// Reads a steered turn:
///   tau_turn = 2 l_f F' sin d_r                                                       [paper (62)]
/// F' is the force of each wheel, d_r the steering angle; l_f is the distance from the centre of
/// gravity to the front axle. Empty on a fault.
std::optional<Turn> by_steering(TrialReader& reader, std::size_t row, const Vehicle& vehicle,
                                double wheel_force) {
  const double steering_deg = *reader.cell(row, "steering_deg");
  if (std::abs(steering_deg) >= 90.0) {
    reader.fault(ErrorCode::kOutOfRange, row, "steering_deg",
                 fmt::format("must lie between -90 and 90, found {}", steering_deg));
    return std::nullopt;
  }
  const double steering_rad = radians(std::abs(steering_deg));
  return Turn{.left = steering_deg,
              .in_words = fmt::format("steering_deg {}", steering_deg),
              .computed_m = steering_moment_m(vehicle.front_axle_m, wheel_force, steering_rad),
              .equation = "2 l_f F' sin(steering)",
              .parameter = "front_axle_m",
              .length_m = vehicle.front_axle_m,
              .steering_rad = steering_rad,
              .wheel_force = wheel_force};
}

/// Reads a differential turn, with straight wheels:
///   tau_turn = 2 d (F'R - F'L)                                                        [paper (41)]
/// F'L and F'R are the forces of each left and each right wheel, d is half the track width.
Turn by_sides(const TrialReader& reader, std::size_t row, const Vehicle& vehicle) {
  const double left = *reader.cell(row, "force_left");
  const double right = *reader.cell(row, "force_right");
  const SideForces<double> sides{std::min(left, right), std::max(left, right)};
  return {.left = right - left,
          .in_words = fmt::format("force_right - force_left {:.4g}", right - left),
          .computed_m = differential_moment_m(vehicle.half_track_m, sides.right - sides.left),
          .equation = "2 d (F'R - F'L)",
          .parameter = "half_track_m",
          .length_m = vehicle.half_track_m,
          .sides = sides};
}

/// Adds a fault if wheel_force is given together with force_left and force_right and is not their
/// mean.
void check_mean(TrialReader& reader, std::size_t row, double left, double right) {
  const auto mean = reader.cell(row, "wheel_force");
  if (!mean) return;
  const double computed = 0.5 * (left + right);
  const double tolerance = reader.rounding_error(*mean, "wheel_force") + 0.005 * std::abs(computed);
  if (std::abs(*mean - computed) <= tolerance) return;
  reader.fault(ErrorCode::kContradiction, row, "wheel_force",
               fmt::format("found {}, but the mean of force_left {} and force_right {} is "
                           "{:.4g}: correct wheel_force or leave its cell empty",
                           *mean, left, right, computed));
}

/// Reads wheel_force of a steered run that has no force_left and force_right. Adds a fault if the
/// cell is empty or negative.
std::optional<double> wheel_force_of(TrialReader& reader, std::size_t row) {
  if (!reader.has("wheel_force")) {
    reader.fault(ErrorCode::kMissing, row, "force_left",
                 "no force: give force_left and force_right, or add a column wheel_force");
    return std::nullopt;
  }
  const auto force = reader.non_negative(row, "wheel_force");
  if (!force) {
    reader.fault(ErrorCode::kMissing, row, "wheel_force",
                 "column wheel_force: the cell is empty; expected a number");
  }
  return force;
}

/// True if the row has a yaw rate, printed or timed; else adds a fault.
bool has_rate(TrialReader& reader, std::size_t row) {
  if (reader.cell(row, "yaw_rate_radps")) return true;
  if (reader.cell(row, "turns") && reader.cell(row, "elapsed_s")) return true;
  reader.fault(ErrorCode::kMissing, row, reader.has("yaw_rate_radps") ? "yaw_rate_radps" : "turns",
               "no yaw rate: give yaw_rate_radps, or turns and elapsed_s");
  return false;
}

/// Reads a run of a vehicle with steering: a steered turn or, with straight wheels, a differential
/// turn. Empty on a fault.
std::optional<Turn> by_steering_or_sides(TrialReader& reader, std::size_t row,
                                         const Vehicle& vehicle) {
  const auto left = reader.cell(row, "force_left");
  const auto right = reader.cell(row, "force_right");
  if (left.has_value() != right.has_value()) {
    reader.fault(ErrorCode::kMissing, row, left ? "force_right" : "force_left",
                 "is empty, but the other side's force is not: give both forces or neither");
    return std::nullopt;
  }
  const bool is_timed = has_rate(reader, row);
  if (!left) {
    const auto force = wheel_force_of(reader, row);
    if (!force || !is_timed) return std::nullopt;
    return by_steering(reader, row, vehicle, *force);
  }
  check_mean(reader, row, *left, *right);
  if (!is_timed) return std::nullopt;
  if (*left == *right) {
    if (*left < 0.0) {
      reader.fault(ErrorCode::kOutOfRange, row, "force_left",
                   fmt::format("must not be negative, found {}", *left));
      return std::nullopt;
    }
    return by_steering(reader, row, vehicle, *left);
  }
  if (*reader.cell(row, "steering_deg") == 0.0) return by_sides(reader, row, vehicle);
  reader.fault(
      ErrorCode::kContradiction, row, "steering_deg",
      fmt::format("found {} with force_left {} and force_right {}: a run turns either by steering "
                  "or by a force difference; keep the wheels straight, or make both forces equal",
                  *reader.cell(row, "steering_deg"), *left, *right));
  return std::nullopt;
}

/// Reads a run of a vehicle without steering. Empty if a cell is missing; check_sides_given()
/// reports missing forces.
std::optional<Turn> by_sides_alone(TrialReader& reader, std::size_t row, const Vehicle& vehicle) {
  if (!reader.cell(row, "force_left") || !reader.cell(row, "force_right")) return std::nullopt;
  if (!has_rate(reader, row)) return std::nullopt;
  return by_sides(reader, row, vehicle);
}

/// Adds a single fault that lists all rows without force_left or force_right, in the table of a
/// vehicle without steering.
void check_sides_given(TrialReader& reader) {
  std::vector<std::size_t> without;
  for (std::size_t row = 0; row < reader.table().rows(); ++row) {
    if (reader.cell(row, "force_left") && reader.cell(row, "force_right")) continue;
    without.push_back(row);
  }
  if (without.empty()) return;
  reader.fault(ErrorCode::kMissing, without.front(),
               reader.cell(without.front(), "force_left") ? "force_right" : "force_left",
               fmt::format("{} of {} rows lack force_left or force_right ({}): a vehicle without "
                           "steering turns only by left and right wheel forces; give both, remove "
                           "the rows, or correct drive in vehicle.json",
                           without.size(), reader.table().rows(), lines_of(reader, without)));
}

/// Reads one row. Stores a turn to the right as its mirror image (TurningRow). Empty on a fault.
std::optional<TurningRow> read_row(TrialReader& reader, std::size_t row, const Vehicle& vehicle,
                                   Preference preference, std::vector<Finding>& findings) {
  const auto turn = vehicle.has_steering() ? by_steering_or_sides(reader, row, vehicle)
                                           : by_sides_alone(reader, row, vehicle);
  if (!turn) return std::nullopt;
  const auto printed = printed_yaw_rate(reader, row, *turn);
  const auto rate = rate_of(reader, row, kTurningRate, printed, preference, findings);
  if (!rate) return std::nullopt;
  if (!turn->sides) check_stop(reader, row, vehicle, turn->left, findings);
  return TurningRow{.line = reader.table().line(row),
                    .steering_rad = turn->steering_rad,
                    .wheel_force = turn->wheel_force,
                    .tau_turn_m = tau_turn_of(reader, row, *turn, findings),
                    .yaw_rate_radps = rate->used,
                    .turns = rate->amount,
                    .elapsed_s = rate->elapsed_s,
                    .sides = turn->sides,
                    .is_right_turn = turn->left < 0.0};
}

/// If all turns in the table of a vehicle with steering are differential, moves them to `rows`, to
/// which the fit of the yaw resistance g3 then applies. Adds the warning `turned-by-sides`.
void take_sides_alone(TrialSet<TurningRow>& set, std::vector<Finding>& findings) {
  if (!set.rows.empty() || set.by_sides.empty()) return;
  set.rows = std::exchange(set.by_sides, {});
  findings.push_back(
      {set.file, set.rows.front().line, Severity::kWarning, "turned-by-sides",
       fmt::format(
           "all {} turns are differential, so the fitted yaw resistance includes tyre scrub; if "
           "the vehicle also steers, add steered turns (steering_deg, wheel_force)",
           set.rows.size())});
}

/// Indices of the rows of a turning table by their use.
struct TurningRowUses {
  std::vector<std::size_t> kept;
  std::vector<std::size_t> set_aside;  ///< rows that do not determine the yaw resistance
};

/// Reads all rows of a turning table into `set`: turns by steering, turns by different forces left
/// and right, and runs in which these forces did not turn the vehicle. (The last ones serve only to
/// determine tyre scrub, together with turns by steering. Without such turns they are set aside.)
TurningRowUses read_turning_rows(TrialReader& reader, const Vehicle& vehicle,
                                 const TrialOptions& options, TrialSet<TurningRow>& set,
                                 std::vector<Finding>& findings) {
  TurningRowUses uses;
  std::vector<std::size_t> standing;
  for (std::size_t i = 0; i < reader.table().rows(); ++i) {
    const auto row = read_row(reader, i, vehicle, options.preference, findings);
    if (!row) continue;
    const bool beside_steering = vehicle.has_steering() && row->sides;
    const bool is_standing = is_rest(row->yaw_rate_radps, kRestRate_radps);
    if (is_rest(row->tau_turn_m, kRestForce) || (is_standing && !beside_steering)) {
      uses.set_aside.push_back(i);
    } else if (is_standing) {
      set.standing.push_back(*row);
      standing.push_back(i);
    } else {
      uses.kept.push_back(i);
      (beside_steering ? set.by_sides : set.rows).push_back(*row);
    }
  }
  if (set.rows.empty()) {
    set.standing.clear();
    append(uses.set_aside, standing);
    std::sort(uses.set_aside.begin(), uses.set_aside.end());
  }
  return uses;
}

}  // namespace

Result<TrialSet<TurningRow>> read_turning(const std::filesystem::path& path, const Vehicle& vehicle,
                                          const TrialOptions& options,
                                          std::vector<Finding>& findings) {
  AWMR_ASSIGN_OR_RETURN(CsvTable table, read_table(path, turning_columns(vehicle), options));
  TrialReader reader(std::move(table), options);
  check_turning_columns(reader, vehicle);
  if (!reader.faults().empty()) return input_errors(std::move(reader.faults()));

  TrialSet<TurningRow> set{finding_file(reader.table()), {}, 0, reader.table().mapped};
  set.force_column = "wheel_force";
  const bool is_timed = reader.has("turns") && reader.has("elapsed_s");
  const bool takes_timed = is_timed && options.preference == Preference::kTimed;
  set.rate_column = reader.has("yaw_rate_radps") && !takes_timed ? "yaw_rate_radps" : "turns";
  note_format(reader, findings);
  if (!vehicle.has_steering()) check_sides_given(reader);
  const TurningRowUses uses = read_turning_rows(reader, vehicle, options, set, findings);
  if (!reader.faults().empty()) return input_errors(std::move(reader.faults()));
  take_sides_alone(set, findings);
  set.set_aside = static_cast<int>(uses.set_aside.size());
  note_rows_set_aside(reader, uses.set_aside,
                      "a run without yaw moment or yaw rate does not determine the yaw resistance "
                      "tau_turn = a3 r^b3",
                      findings);
  find_repeated_rows(reader, uses.kept,
                     {.settings = {"steering_deg", "wheel_force", "force_left", "force_right",
                                   "turns", "tau_turn"},
                      .printed = "yaw_rate_radps"},
                     findings);
  return set;
}

}  // namespace awmr
