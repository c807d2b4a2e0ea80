#include "awmr/identify/logs/problem/windows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "awmr/core/index.h"
#include "awmr/trials/log_start.h"

namespace awmr {
namespace {

std::vector<Sample> samples_of(const LogWindow& window) {
  const DrivingLog& log = *window.log;
  std::vector<Sample> samples;
  std::array<std::optional<double>, kChannelCount> previous_s;
  for (std::size_t row = window.begin; row < window.end; ++row) {
    for (const LogChannel channel : kChannels) {
      if (!is_measurement(log, channel, row)) continue;
      auto& before_s = previous_s[at(channel)];
      samples.push_back(
          {static_cast<std::uint32_t>(row), channel, before_s ? log.t_s[row] - *before_s : 0.0});
      before_s = log.t_s[row];
    }
  }
  samples.shrink_to_fit();
  return samples;
}

/// The rows of a window with a time in [only_s.lo, only_s.hi).
LogWindow within(const LogWindow& window, const Interval& only_s) {
  const std::vector<double>& t_s = window.log->t_s;
  const auto from = t_s.begin() + static_cast<std::ptrdiff_t>(window.begin);
  const auto to = t_s.begin() + static_cast<std::ptrdiff_t>(window.end);
  return {window.log, at(std::lower_bound(from, to, only_s.lo) - t_s.begin()),
          at(std::lower_bound(from, to, only_s.hi) - t_s.begin())};
}

/// Index of the first row that is fitted. If a log begins in motion, its first second is not
/// fitted: lagged forces and filtered sensors then depend on commands and speeds before the log.
std::size_t first_fitted_row(const DrivingLog& log) {
  constexpr double kForgotten_s = 1.0;
  constexpr double kShortest_s = 5.0;  // shorter logs are fitted from the first row
  const std::vector<double>& t_s = log.t_s;
  if (t_s.back() - t_s.front() < kShortest_s || !begins_in_motion(log)) return 0;
  return at(std::ranges::lower_bound(t_s, t_s.front() + kForgotten_s) - t_s.begin());
}

/// Adds a window with these rows, unless nothing is measured in them.
void add_window(const LogWindow& rows, std::shared_ptr<const LogSignals> signals,
                double row_spacing_s, std::vector<FitWindow>& windows) {
  auto samples = std::make_shared<const std::vector<Sample>>(samples_of(rows));
  if (samples->empty()) return;
  windows.push_back({rows,
                     std::move(signals),
                     row_spacing_s,
                     std::move(samples),
                     measured_initial_state(rows),
                     {},
                     uncertain_changes(rows)});
}

}  // namespace

std::vector<FitWindow> fit_windows(const std::vector<DrivingLog>& logs, double longest_s,
                                   const std::optional<Interval>& only_s) {
  std::vector<FitWindow> windows;
  for (const DrivingLog& log : logs) {
    const auto signals = std::make_shared<const LogSignals>(log);
    const double row_spacing_s = log.median_step_s();
    const std::size_t first = first_fitted_row(log);
    for (const LogWindow& all : windows_of(log, longest_s)) {
      LogWindow rows = only_s ? within(all, *only_s) : all;
      rows.begin = std::clamp(first, rows.begin, rows.end);
      add_window(rows, signals, row_spacing_s, windows);
    }
  }
  return windows;
}

std::vector<FitWindow> parts_of(const FitWindow& window, double longest_s) {
  constexpr double kShortestRows = 3.0;
  constexpr double kTolerance = 0.01;  // a window that is hardly longer stays one part
  const auto [log, begin, end] = window.rows;
  const double span_s = log->t_s[end - 1] - log->t_s[begin];
  const double most = std::max(1.0, std::floor(static_cast<double>(end - begin) / kShortestRows));
  const auto count =
      static_cast<std::size_t>(std::clamp(std::ceil(span_s / longest_s - kTolerance), 1.0, most));
  std::vector<FitWindow> parts;
  for (std::size_t part = 0; part < count; ++part) {
    const LogWindow rows{log, begin + (end - begin) * part / count,
                         begin + (end - begin) * (part + 1) / count};
    add_window(rows, window.signals, window.row_spacing_s, parts);
  }
  return parts;
}

std::vector<InitialComponent> initial_components(const std::vector<DrivingLog>& logs) {
  bool position = false;
  bool heading = false;
  bool turning = false;
  bool servo = false;
  for (const DrivingLog& log : logs) {
    position = position || log[LogChannel::kX] || log[LogChannel::kY];
    heading = heading || log[LogChannel::kHeading];
    turning = turning || log[LogChannel::kYawRate] || log[LogChannel::kSway];
    servo = servo || log.steering_command_rad;
  }
  std::vector<InitialComponent> components;
  if (position) {
    components.push_back({LogChannel::kX, 100.0});
    components.push_back({LogChannel::kY, 100.0});
  }
  if (position || heading) components.push_back({LogChannel::kHeading, 10.0});
  components.push_back({LogChannel::kSpeed, 1.0});
  if (position || heading || turning) {
    components.push_back({LogChannel::kSway, 1.0});
    components.push_back({LogChannel::kYawRate, 1.0});
  }
  if (servo) components.push_back({LogChannel::kSteering, 0.2});
  return components;
}

std::vector<double> measured_initial_states(const std::vector<FitWindow>& windows,
                                            const std::vector<InitialComponent>& components) {
  std::vector<double> states;
  for (const FitWindow& window : windows) {
    for (const InitialComponent& component : components) {
      states.push_back(channel_of(window.measured, component.channel));
    }
  }
  return states;
}

}  // namespace awmr
