#include "awmr/identify/logs/choice/interpolated_commands.h"

#include <algorithm>
#include <utility>

#include "awmr/identify/uncertainty/akaike.h"
#include "awmr/trials/held_signal.h"

namespace awmr {
namespace {

/// Number of parts into which the time between two rows is divided. In each part, the commands of
/// the interpolated log are constant.
constexpr std::size_t kParts = 4;

/// True if forces or steering command change in at least half of the rows.
bool changes_often(const DrivingLog& log) {
  const LogSignals signals(log);
  std::size_t changes = 0;
  for (std::size_t i = 1; i < log.rows(); ++i) {
    changes += signals.forces_differ(i, i - 1) || signals.steering_commands_differ(i, i - 1);
  }
  return 2 * changes >= log.rows();
}

/// Time of one row of the interpolated log: after the row `row` of the original log, at the
/// fraction `share` of the time to the next row, 0 <= share < 1.
struct RowPart {
  std::size_t row;
  double share;
};

std::vector<RowPart> places_of(const DrivingLog& log) {
  const double gap_s = kGapSteps * log.median_step_s();
  std::vector<RowPart> places;
  for (std::size_t row = 0; row < log.rows(); ++row) {
    const bool is_interpolated = row + 1 < log.rows() && log.t_s[row + 1] - log.t_s[row] <= gap_s;
    for (std::size_t part = 0; part < (is_interpolated ? kParts : 1); ++part) {
      places.push_back({row, static_cast<double>(part) / kParts});
    }
  }
  return places;
}

/// The signal, linearly interpolated to the times `places` plus the shift `later`, a fraction (< 1)
/// of the time between two rows.
std::vector<double> at_places(const std::vector<double>& signal, const std::vector<RowPart>& places,
                              double later) {
  std::vector<double> values;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::size_t row = places[i].row;
    const bool is_last_part = i + 1 == places.size() || places[i + 1].row != row;
    const bool is_only_part = is_last_part && places[i].share == 0.0;
    const double step = is_only_part ? 0.0 : signal[row + 1] - signal[row];
    values.push_back(signal[row] + (places[i].share + later) * step);
  }
  return values;
}

DrivingLog interpolated(const DrivingLog& log) {
  constexpr double kMiddle = 0.5 / kParts;  // middle of a part: mean of the line over the part
  const std::vector<RowPart> places = places_of(log);
  DrivingLog fine = log;
  fine.has_interpolated_commands = true;
  fine.t_s = at_places(log.t_s, places, 0.0);
  fine.force_left = at_places(log.force_left, places, kMiddle);
  fine.force_right = at_places(log.force_right, places, kMiddle);
  if (log.steering_command_rad) {
    fine.steering_command_rad = at_places(*log.steering_command_rad, places, kMiddle);
  }
  if (!log.line.empty()) {
    fine.line.clear();
    for (const RowPart& place : places) fine.line.push_back(log.line[place.row]);
  }
  for (auto& channel : fine.measured) {
    if (!channel) continue;
    const std::vector<bool> fresh = std::exchange(channel->fresh, {});
    channel->value = at_places(channel->value, places, 0.0);
    for (const RowPart& place : places) {
      channel->fresh.push_back(place.share == 0.0 && fresh[place.row]);
    }
  }
  return fine;
}

}  // namespace

std::vector<DrivingLog> interpolated(const std::vector<DrivingLog>& logs) {
  std::vector<DrivingLog> fine;
  for (const DrivingLog& log : logs) fine.push_back(interpolated(log));
  return fine;
}

bool are_commands_smooth(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                         const FamilyFit& first) {
  constexpr double kAlike = 10.0;  // largest accepted increase of AIC, if `first` reads early
  const auto is_smooth = [](const DrivingLog& log) {
    return !log.has_interpolated_commands && !log.has_held_set_points && changes_often(log);
  };
  if (!std::ranges::all_of(logs, is_smooth)) return false;
  LogFitOptions from = from_optimum(power_law, first);
  const bool reads_early =
      std::ranges::any_of(from.terms, is_late_commands) || std::ranges::any_of(from.terms, is_slip);
  std::erase_if(from.terms, [](const FreeTerm& term) {
    return term.quantity.kind == FreeQuantity::Kind::kDelay || is_slip(term);
  });
  from.terms.push_back({free_term(FreeQuantity::Kind::kDelay), 0.0});
  from.finds_delays = reads_early;  // the slip may have hidden other terms
  const FamilyFit lines = fit_family(interpolated(logs), from, first.surge, first.yaw);
  return lines.fit.usable &&
         aic_lead(lines.fit, first.fit) > (reads_early ? -kAlike : kFamilyAicThreshold);
}

Finding interpolated_commands_finding(const std::string& file) {
  return {file, 0, Severity::kWarning, "interpolated-commands",
          "the commands change from row to row, and straight lines between the rows describe the "
          "motion better than steps; the fit uses such lines. Log every command when it is sent, "
          "or at a higher rate"};
}

}  // namespace awmr
