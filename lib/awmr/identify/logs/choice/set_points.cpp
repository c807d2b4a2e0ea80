#include "awmr/identify/logs/choice/set_points.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace awmr {
namespace {

using Kind = FreeQuantity::Kind;

using Signal = std::vector<double>;

/// Returns the unit to which the values of the signal were rounded: the smallest difference of two
/// different values. Infinite if the signal is constant.
double resolution_of(Signal signal) {
  // Differences below this fraction of the range of the signal are rounding errors.
  constexpr double kRounding = 1e-9;
  std::ranges::sort(signal);
  const double least = kRounding * (signal.back() - signal.front());
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < signal.size(); ++i) {
    const double gap = signal[i] - signal[i - 1];
    if (gap > least) smallest = std::min(smallest, gap);
  }
  return smallest;
}

/// Returns true for each row at which a straight line ends. A row continues a line if its value
/// differs by at most `tolerance` from the line between the rows before and after it.
std::vector<bool> line_ends(const Signal& t_s, const Signal& signal, double tolerance) {
  std::vector<bool> ends(signal.size(), true);
  for (std::size_t i = 1; i + 1 < signal.size(); ++i) {
    const double share = (t_s[i] - t_s[i - 1]) / (t_s[i + 1] - t_s[i - 1]);
    const double on_line = signal[i - 1] + share * (signal[i + 1] - signal[i - 1]);
    ends[i] = std::abs(signal[i] - on_line) > tolerance;
  }
  return ends;
}

/// Returns the lengths, in rows, of those lines on which the signal changes.
std::vector<std::size_t> lengths_of(const Signal& signal, const std::vector<bool>& ends) {
  std::vector<std::size_t> lengths;
  std::size_t begin = 0;
  for (std::size_t i = 1; i < signal.size(); ++i) {
    if (!ends[i]) continue;
    if (signal[i] != signal[begin]) lengths.push_back(i - begin);
    begin = i;
  }
  return lengths;
}

/// Number of rows between two set-points: the most frequent length of a line. Returns 0 in these
/// cases, because the signal is then not interpolated between set-points:
///   - The most frequent length is below two rows or above 0.5 s.
///   - The signal changes in fewer than kFewest rows.
///   - At most half of these rows are on lines whose length is a multiple of the most frequent
///     length.
std::size_t rows_of_set_point(const Signal& t_s, const Signal& signal,
                              const std::vector<bool>& ends) {
  constexpr double kLongest_s = 0.5;
  constexpr std::size_t kFewest = 40;
  std::map<std::size_t, std::size_t> counts;
  const std::vector<std::size_t> lengths = lengths_of(signal, ends);
  for (const std::size_t rows : lengths) ++counts[rows];
  if (counts.empty()) return 0;
  const std::size_t usual =
      std::ranges::max_element(counts, {}, [](const auto& one) { return one.second; })->first;
  std::size_t changes = 0;
  std::size_t on_multiples = 0;
  for (const std::size_t rows : lengths) {
    changes += rows;
    if (rows % usual == 0) on_multiples += rows;
  }
  const double step_s = (t_s.back() - t_s.front()) / static_cast<double>(t_s.size() - 1);
  const bool is_usual = usual > 1 && static_cast<double>(usual) * step_s <= kLongest_s &&
                        changes >= kFewest && 2 * on_multiples > changes;
  return is_usual ? usual : 0;
}

/// Returns, for each row, the index of the row with its set-point. Set-points are the rows at which
/// a line ends, and the rows at multiples of rows_of_set_point() after them. Values on the lines
/// may be exact or rounded. Empty if the signal is not interpolated between set-points.
std::optional<std::vector<std::size_t>> set_points_of(const Signal& t_s, const Signal& signal) {
  constexpr double kExact = 1e-3;  // tolerance for exact values, relative to the resolution
  // Tolerance for rounded values: 0.5 for the row itself, 0.5 for its two neighbours.
  constexpr double kRounded = 1.05;
  const double resolution = resolution_of(signal);
  for (const double share : {kExact, kRounded}) {
    const std::vector<bool> ends = line_ends(t_s, signal, share * resolution);
    const std::size_t rows = rows_of_set_point(t_s, signal, ends);
    if (rows == 0) continue;
    std::vector<std::size_t> places(signal.size(), 0);
    std::size_t begin = 0;
    for (std::size_t i = 1; i < signal.size(); ++i) {
      if (ends[i]) begin = i;
      places[i] = i - (i - begin) % rows;
    }
    return places;
  }
  return std::nullopt;
}

void hold(const std::vector<std::size_t>& places, Signal& signal) {
  const Signal before = signal;
  for (std::size_t i = 0; i < signal.size(); ++i) signal[i] = before[places[i]];
}

}  // namespace

std::optional<std::vector<DrivingLog>> with_held_set_points(const std::vector<DrivingLog>& logs) {
  std::vector<DrivingLog> changed = logs;
  bool is_any_held = false;
  for (DrivingLog& log : changed) {
    if (log.has_held_set_points || log.has_interpolated_commands) return std::nullopt;
    log.has_held_set_points = true;
    // One program writes both forces, so both are held if one of them is interpolated.
    auto of_forces = set_points_of(log.t_s, log.force_left);
    if (!of_forces) of_forces = set_points_of(log.t_s, log.force_right);
    if (of_forces) {
      hold(*of_forces, log.force_left);
      hold(*of_forces, log.force_right);
    }
    auto& steering = log.steering_command_rad;
    const auto of_steering = steering ? set_points_of(log.t_s, *steering) : std::nullopt;
    if (of_steering) hold(*of_steering, *steering);
    is_any_held = is_any_held || of_forces || of_steering;
  }
  if (!is_any_held) return std::nullopt;
  return changed;
}

bool are_set_points_held(const std::vector<DrivingLog>& held, const LogFitOptions& power_law,
                         const FamilyFit& first) {
  constexpr double kAlike = 10.0;  // largest accepted increase of AIC
  LogFitOptions from = from_optimum(power_law, first);
  std::erase_if(from.terms, [](const FreeTerm& term) {
    const Kind kind = term.quantity.kind;
    return kind == Kind::kDelay || kind == Kind::kSteeringDelay || kind == Kind::kMotorLag;
  });
  const FamilyFit steps = fit_family(held, from, first.surge, first.yaw);
  return steps.fit.usable && aic_lead(steps.fit, first.fit) > -kAlike;
}

Finding interpolated_set_points_finding(const std::string& file) {
  return {file, 0, Severity::kWarning, "interpolated-set-points",
          "the logged commands are straight lines between set-points, but the vehicle moves as if "
          "each set-point was held until the next; the fit uses held set-points. Log the commands "
          "when they are sent, without interpolation"};
}

}  // namespace awmr
