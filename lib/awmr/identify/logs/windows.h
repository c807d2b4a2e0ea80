/// Division of the logs into windows, each with its samples and its own initial state (multiple
/// shooting without continuity constraints, so that a disturbance affects one window only). Private
/// to identify/.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "awmr/core/interval.h"
#include "awmr/trials/replay.h"

namespace awmr {

/// Length of a window.
inline constexpr double kWindow_s = 10.0;

/// Position of one measured value. Kept small, because long logs have millions.
struct Sample {
  std::uint32_t row;
  LogChannel channel;
  double since_s = 0.0;  ///< time since the window's previous sample of this channel; 0: the first
};

struct FitWindow {
  LogWindow rows;
  std::shared_ptr<const LogSignals> signals;               ///< the log's commands
  std::shared_ptr<const std::vector<Sample>> all_samples;  ///< in order of rows, never empty
  State<double> measured{};     ///< the initial state, as far as it was measured
  std::vector<double> weights;  ///< by sample: square roots of the weights of a robust loss; empty:
                                ///< all 1

  const std::vector<Sample>& samples() const { return *all_samples; }
  double weight(std::size_t sample) const { return weights.empty() ? 1.0 : weights[sample]; }
};

/// The windows of all logs, within `only_s` if given, without those that have no sample. The logs
/// must outlive them.
std::vector<FitWindow> fit_windows(const std::vector<DrivingLog>& logs,
                                   const std::optional<Interval>& only_s = {});

/// Divides the window into equal parts of at most `longest_s`, each with its own initial state.
std::vector<FitWindow> parts_of(const FitWindow& window, double longest_s);

/// A component of the initial state that is free in every window, with the channel that measures
/// it.
struct InitialComponent {
  LogChannel channel;
  double prior_std;  ///< of the weak prior at the measured or assumed initial state, SI
};

/// The components of the initial state that affect any measurement.
std::vector<InitialComponent> initial_components(const std::vector<DrivingLog>& logs);

/// By window, then by component: the measured initial states.
std::vector<double> measured_initial_states(const std::vector<FitWindow>& windows,
                                            const std::vector<InitialComponent>& components);

}  // namespace awmr
