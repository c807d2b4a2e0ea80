#include "awmr/identify/logs/set_points.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "awmr/identify/logs/family_score.h"
#include "awmr/identify/logs/model_choice.h"
#include "awmr/identify/uncertainty/akaike.h"

namespace awmr {
namespace {

using Signal = std::vector<double>;

/// Smallest difference between two values of the signal: the unit of rounded values. Infinite if
/// the signal is constant.
double resolution_of(Signal signal) {
  constexpr double kRounding = 1e-9;  // of the range: equal values that were computed differently
  std::ranges::sort(signal);
  const double least = kRounding * (signal.back() - signal.front());
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < signal.size(); ++i) {
    const double gap = signal[i] - signal[i - 1];
    if (gap > least) smallest = std::min(smallest, gap);
  }
  return smallest;
}

/// By row: true where a straight line ends. A row is on a line if its value differs from that of
/// the line through its neighbours by at most `tolerance`.
std::vector<bool> line_ends(const Signal& t_s, const Signal& signal, double tolerance) {
  std::vector<bool> ends(signal.size(), true);
  for (std::size_t i = 1; i + 1 < signal.size(); ++i) {
    const double share = (t_s[i] - t_s[i - 1]) / (t_s[i + 1] - t_s[i - 1]);
    const double on_line = signal[i - 1] + share * (signal[i + 1] - signal[i - 1]);
    ends[i] = std::abs(signal[i] - on_line) > tolerance;
  }
  return ends;
}

/// True if most changes of the signal lie on straight lines of several rows and at most 0.5 s.
bool is_interpolated(const Signal& t_s, const Signal& signal, const std::vector<bool>& ends) {
  constexpr double kLongest_s = 0.5;
  constexpr std::size_t kFewest = 40;
  std::size_t changes = 0;
  std::size_t on_short_lines = 0;
  std::size_t begin = 0;  // of the present line
  for (std::size_t i = 1; i < signal.size(); ++i) {
    if (!ends[i]) continue;
    if (signal[i] != signal[begin]) {
      changes += i - begin;
      if (i - begin > 1 && t_s[i] - t_s[begin] < kLongest_s) on_short_lines += i - begin;
    }
    begin = i;
  }
  return changes >= kFewest && 2 * on_short_lines > changes;
}

/// The signal held from each end of a line to the next, if it is interpolated. The values on the
/// lines may be exact or rounded.
std::optional<Signal> held(const Signal& t_s, const Signal& signal) {
  constexpr double kExact = 1e-3;    // of the resolution
  constexpr double kRounded = 1.05;  // a row and the mean of its neighbours, by half of it each
  const double resolution = resolution_of(signal);
  for (const double share : {kExact, kRounded}) {
    const std::vector<bool> ends = line_ends(t_s, signal, share * resolution);
    if (!is_interpolated(t_s, signal, ends)) continue;
    Signal result = signal;
    for (std::size_t i = 1; i < signal.size(); ++i) {
      if (!ends[i]) result[i] = result[i - 1];
    }
    return result;
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::vector<DrivingLog>> with_held_set_points(const std::vector<DrivingLog>& logs) {
  std::vector<DrivingLog> changed = logs;
  bool is_any_held = false;
  for (DrivingLog& log : changed) {
    if (log.has_held_set_points) return std::nullopt;
    log.has_held_set_points = true;
    const auto hold = [&](Signal& signal) {
      std::optional<Signal> steps = held(log.t_s, signal);
      is_any_held = is_any_held || steps;
      if (steps) signal = *std::move(steps);
    };
    hold(log.force_left);
    hold(log.force_right);
    if (log.steering_command_rad) hold(*log.steering_command_rad);
  }
  if (!is_any_held) return std::nullopt;
  return changed;
}

bool are_set_points_held(const std::vector<DrivingLog>& held, const LogFitOptions& power_law,
                         const FamilyFit& first, const IdentifyOptions& options) {
  using Kind = FreeQuantity::Kind;
  LogFitOptions from = from_optimum(power_law, first);
  std::erase_if(from.terms, [](const FreeTerm& term) {
    const Kind kind = term.quantity.kind;
    return kind == Kind::kDelay || kind == Kind::kSteeringDelay || kind == Kind::kMotorLag;
  });
  const FamilyFit steps = fit_first_family(held, from, options);
  return steps.fit.usable && aic_lead(steps.fit, first.fit) > kFamilyAicThreshold;
}

Finding interpolated_set_points_finding(const std::string& file) {
  return {file, 0, Severity::kWarning, "interpolated-set-points",
          "the logged commands are straight lines between set-points, but the vehicle moves as if "
          "each set-point was held until the next; the fit uses held set-points. Log the commands "
          "when they are sent, without interpolation"};
}

}  // namespace awmr
