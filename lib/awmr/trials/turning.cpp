#include <fmt/format.h>

#include <cmath>

#include "awmr/core/csv_text.h"
#include "awmr/core/units.h"
#include "read_table.h"
#include "trial_reader.h"

namespace awmr {
namespace {

const Rate kTurningRate{.printed_column = "yaw_rate_radps",
                        .amount_column = "turns",
                        .per_amount = 2.0 * pi<double>(),
                        .code = "yaw-rate-mismatch"};

/// l_f and the steering angle are set up to about 1 %; F' is set exactly.
constexpr double kGeometryError = 0.01;

void check_turning_columns(TrialReader& reader) {
  if (!reader.has("yaw_rate_radps") && !(reader.has("turns") && reader.has("elapsed_s"))) {
    reader.header_fault("no yaw rate: add a column yaw_rate_radps, or turns and elapsed_s");
  }
}

/// The yaw rate's magnitude. Its sign has to be the steering's: counted turns have none.
std::optional<double> printed_yaw_rate(TrialReader& reader, std::size_t row, double steering_deg) {
  const auto rate = reader.cell(row, "yaw_rate_radps");
  if (!rate) return std::nullopt;
  if (*rate * steering_deg < 0.0) {
    reader.fault(row, "yaw_rate_radps",
                 fmt::format("found {} with steering_deg {}: both are positive to the left, so "
                             "their signs must agree",
                             *rate, steering_deg));
  }
  return std::abs(*rate);
}

void check_stop(const TrialReader& reader, std::size_t row, const Vehicle& vehicle,
                double steering_deg, std::vector<Finding>& findings) {
  if (std::abs(steering_deg) <= vehicle.steering_max_deg) return;
  findings.push_back(reader.finding(
      row, Severity::kWarning, "steering-stop",
      fmt::format("steering_deg is {}, beyond the vehicle's stop at {}; the row is used as given",
                  steering_deg, vehicle.steering_max_deg)));
}

/// tau_turn as printed, else 2 l_f F' sin d_r                                          [paper (62)]
/// The paper heads its column N m; over F_max, as everywhere here, it is in m.
double tau_turn_of(TrialReader& reader, std::size_t row, double computed, const Vehicle& vehicle,
                   std::vector<Finding>& findings) {
  const auto cell = reader.cell(row, "tau_turn");
  if (!cell) return computed;
  if (*cell * *reader.cell(row, "steering_deg") < 0.0) {
    reader.fault(row, "tau_turn",
                 fmt::format("found {} with steering_deg {}: both are positive to the left, so "
                             "their signs must agree",
                             *cell, *reader.cell(row, "steering_deg")));
  }
  const double printed = std::abs(*cell);
  const double tolerance = reader.rounding_error(printed, "tau_turn") + kGeometryError * computed;
  if (std::abs(printed - computed) > tolerance) {
    const std::string implied = computed > 0.0
                                    ? fmt::format(" (it implies a front_axle_m of {:.3f})",
                                                  vehicle.front_axle_m * printed / computed)
                                    : std::string();
    findings.push_back(reader.finding(
        row, Severity::kWarning, "tau-turn-mismatch",
        fmt::format("tau_turn is {}, but 2 l_f F' sin(steering) with front_axle_m {} makes {:.4g}; "
                    "the printed value {} is used{}",
                    printed, vehicle.front_axle_m, computed, printed, implied)));
  }
  return printed;
}

/// One row, or nothing where it is faulty; a row that carries no information has no tau_turn or
/// rate. g3 is odd, so a turn to the right is taken as its mirror image to the left.
std::optional<TurningRow> read_row(TrialReader& reader, std::size_t row, const Vehicle& vehicle,
                                   Preference preference, std::vector<Finding>& findings) {
  const double steering_deg = *reader.cell(row, "steering_deg");
  if (std::abs(steering_deg) >= 90.0) {
    reader.fault(row, "steering_deg",
                 fmt::format("must lie between -90 and 90, found {}", steering_deg));
    return std::nullopt;
  }
  const double wheel_force = *reader.non_negative(row, "wheel_force");
  const auto printed = printed_yaw_rate(reader, row, steering_deg);
  const auto yaw_rate = rate_of(reader, row, kTurningRate, printed, preference, findings);
  if (!yaw_rate) return std::nullopt;
  check_stop(reader, row, vehicle, steering_deg, findings);
  const double steering_rad = radians(std::abs(steering_deg));
  const double computed = 2.0 * vehicle.front_axle_m * wheel_force * std::sin(steering_rad);
  return TurningRow{.line = reader.table().line(row),
                    .steering_rad = steering_rad,
                    .wheel_force = wheel_force,
                    .tau_turn_m = tau_turn_of(reader, row, computed, vehicle, findings),
                    .yaw_rate_radps = yaw_rate->used,
                    .turns = yaw_rate->amount,
                    .elapsed_s = yaw_rate->elapsed_s};
}

}  // namespace

Result<TrialSet<TurningRow>> read_turning(const std::filesystem::path& path, const Vehicle& vehicle,
                                          const TrialOptions& options,
                                          std::vector<Finding>& findings) {
  AWMR_ASSIGN_OR_RETURN(CsvTable table, read_table(path, TrialKind::kTurning, options));
  TrialReader reader(std::move(table), options);
  check_turning_columns(reader);
  if (!reader.faults().empty()) return input_errors(std::move(reader.faults()));

  TrialSet<TurningRow> set{finding_file(reader.table()), {}, 0, reader.table().mapped()};
  set.force_column = "wheel_force";
  note_format(reader, findings);
  std::vector<std::size_t> set_aside;
  for (std::size_t i = 0; i < reader.table().rows(); ++i) {
    const auto row = read_row(reader, i, vehicle, options.preference, findings);
    if (!row) continue;
    if (row->tau_turn_m == 0.0 || row->yaw_rate_radps == 0.0) {
      set_aside.push_back(i);
    } else {
      set.rows.push_back(*row);
    }
  }
  if (!reader.faults().empty()) return input_errors(std::move(reader.faults()));
  set.set_aside = static_cast<int>(set_aside.size());
  note_rows_set_aside(reader, set_aside,
                      "without yaw moment or yaw rate, a run shows nothing of tau_turn = a3 r^b3",
                      findings);
  return set;
}

}  // namespace awmr
