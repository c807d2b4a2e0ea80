/// Division of the logs into windows for the fit. Private to identify/.
///
/// Each window has its own fitted initial state (multiple shooting without continuity constraints).
/// A disturbance then affects only one window, not the rest of the log.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "awmr/core/interval.h"
#include "awmr/identify/logs/problem/uncertain_changes.h"
#include "awmr/trials/replay.h"

namespace awmr {

/// Length of a window, s, unless the sensors are very precise (LogFitOptions::window_s). With
/// shorter windows, the fit has more initial states to estimate; with longer windows, a disturbance
/// affects more rows, and the effect of wrong parameters accumulates.
inline constexpr double kWindow_s = 10.0;

/// Position of one measured value in a log.
struct Sample {
  std::uint32_t row;
  LogChannel channel;
  double since_s = 0.0;  ///< time since the window's previous sample of this channel, s; 0: none
};

struct FitWindow {
  LogWindow rows;
  std::shared_ptr<const LogSignals> signals;  ///< commands of the log
  double row_spacing_s = 0.0;                 ///< median row spacing of the log
  /// All samples in the order of the rows; never empty.
  std::shared_ptr<const std::vector<Sample>> all_samples;
  State<double> measured{};  ///< measured initial state; 0 for components that are not measured
  /// One per sample: square root of its weight under the robust loss. Empty: all weights are 1.
  std::vector<double> weights;
  /// Changes of the commands within the window at uncertain times (DrivingLog::change_std_s).
  std::vector<UncertainChange> changes;

  const std::vector<Sample>& samples() const { return *all_samples; }
  double weight(std::size_t sample) const { return weights.empty() ? 1.0 : weights[sample]; }
};

/// Divides all logs (only the time interval `only_s`, if given) into windows of at most about
/// `longest_s` seconds. Omits windows without samples. If a log of 5 s or more begins in motion,
/// also omits its first second, because motors and filters then depend on unknown earlier commands.
/// The logs must outlive the windows.
std::vector<FitWindow> fit_windows(const std::vector<DrivingLog>& logs, double longest_s,
                                   const std::optional<Interval>& only_s = {});

/// Divides a window into parts with about equal numbers of rows. Each part has its own initial
/// state, lasts at most about `longest_s` seconds, and has at least three rows. Omits parts without
/// samples.
std::vector<FitWindow> parts_of(const FitWindow& window, double longest_s);

/// A component of the initial state that is fitted in every window.
struct InitialComponent {
  LogChannel channel;  ///< the component, for example kSpeed for u
  double prior_std;    ///< standard deviation of the weak prior about the measured value, SI
};

/// Components of the initial state that every window fits, because they influence a measured
/// channel of the logs.
std::vector<InitialComponent> initial_components(const std::vector<DrivingLog>& logs);

/// Measured initial states: all components of the first window, then of the next, and so on.
std::vector<double> measured_initial_states(const std::vector<FitWindow>& windows,
                                            const std::vector<InitialComponent>& components);

}  // namespace awmr
