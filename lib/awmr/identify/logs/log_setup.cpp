#include "awmr/identify/logs/log_setup.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "awmr/core/containers.h"
#include "awmr/core/index.h"
#include "awmr/identify/logs/choice/back_emf.h"
#include "awmr/identify/logs/choice/further_terms.h"
#include "awmr/identify/logs/log_fit.h"
#include "awmr/identify/logs/problem/initial_guess.h"
#include "awmr/trials/calibration_checks.h"
#include "awmr/trials/checks/log_consistency.h"

namespace awmr {
namespace {

/// Reason why the channels and commands of the logs cannot identify a parameter, known before any
/// search. Empty if they can. Indirect effects, for example of the yaw rate on the speed, do not
/// count.
std::string cannot_show(const std::vector<DrivingLog>& logs, ParameterId id) {
  switch (id) {
    case ParameterId::kSteeringTimeConstant: {
      const bool any_servo = std::ranges::any_of(
          logs, [](const DrivingLog& log) { return log.steering_command_rad.has_value(); });
      if (!any_servo) return "the logs contain the measured steering angle, not its command";
      if (!std::ranges::any_of(logs, has_steering_changes)) {
        return "the steering command never changes";
      }
      return is_logged(logs, {LogChannel::kSteering, LogChannel::kYawRate, LogChannel::kHeading,
                              LogChannel::kX, LogChannel::kY})
                 ? ""
                 : "no channel shows how the vehicle turns or steers (yaw_rate_radps, "
                   "heading_deg, a position or steering_deg)";
    }
    case ParameterId::kSurgeAlpha:
    case ParameterId::kSurgeBeta:
    case ParameterId::kMassNorm:
      return is_logged(logs, {LogChannel::kSpeed, LogChannel::kX, LogChannel::kY})
                 ? ""
                 : "no channel shows how fast the vehicle drives (speed_mps or a position)";
    case ParameterId::kYawAlpha:
    case ParameterId::kYawBeta:
    case ParameterId::kInertiaNorm:
      return is_logged(logs,
                       {LogChannel::kYawRate, LogChannel::kHeading, LogChannel::kX, LogChannel::kY})
                 ? ""
                 : "no channel shows how the vehicle turns (yaw_rate_radps, heading_deg or a "
                   "position)";
    case ParameterId::kSwayAlpha:
      return is_logged(logs, {LogChannel::kSway, LogChannel::kX, LogChannel::kY})
                 ? ""
                 : "no channel shows whether the vehicle slides sideways (sway_mps or a position)";
    case ParameterId::kBackEmf:
      return why_no_back_emf(logs);
    default:
      return {};
  }
}

/// True if commands turn the vehicle: left and right forces differ, or a steering angle is above
/// kMuch_rad.
bool turns(const std::vector<DrivingLog>& logs) {
  constexpr double kMuch_rad = 0.01;
  return std::ranges::any_of(logs, [](const DrivingLog& log) {
    return has_force_difference(log) ||
           std::ranges::any_of(log.driving_steering_rad(),
                               [](double angle) { return std::abs(angle) > kMuch_rad; });
  });
}

/// Channels whose constant offset the fit estimates: those that the user requested; the yaw rate,
/// if the heading determines its offset; the heading, if the course over ground determines its
/// offset.
std::vector<LogChannel> biased_channels(const std::vector<DrivingLog>& logs,
                                        std::vector<LogChannel> requested) {
  const auto add = [&](LogChannel channel, bool is_biased) {
    if (is_biased && !contains(requested, channel)) requested.push_back(channel);
  };
  add(LogChannel::kYawRate, std::ranges::any_of(logs, [](const DrivingLog& log) {
        return gyro_bias_radps(log).has_value();
      }));
  add(LogChannel::kHeading, std::ranges::any_of(logs, [](const DrivingLog& log) {
        return heading_offset_rad(log).has_value();
      }));
  return requested;
}

/// Limit of the work of all searches (Effort): about 50 s on a processor of 2023, more for long
/// logs. For short logs, the limit is about 10 000 evaluations, so that a search that does not
/// converge stops early. A log that the model describes well needs a tenth of this. Several logs
/// multiply the limit by their number, because the differences between them are searched too.
std::int64_t effort_limit(const std::vector<DrivingLog>& logs) {
  constexpr double kUsualEffort = 1e9;
  constexpr double kPerSecond = 1e6;  // additional work per second of log
  constexpr double kEvaluations = 10000.0;
  constexpr double kUsualColumns = 20.0;
  constexpr double kStep_s = 0.01;
  double duration_s = 0.0;
  double readings = 0.0;
  for (const DrivingLog& log : logs) {
    duration_s += log.t_s.back() - log.t_s.front();
    const auto channels = std::ranges::count_if(
        kChannels, [&](LogChannel channel) { return log[channel].has_value(); });
    readings += static_cast<double>(log.rows()) * static_cast<double>(channels);
  }
  const double of_evaluation = kUsualColumns * (readings + duration_s / kStep_s);
  return std::llround(
      static_cast<double>(logs.size()) *
      (std::min(kUsualEffort, kEvaluations * of_evaluation) + kPerSecond * duration_s));
}

LogFitOptions fit_options(const Vehicle& vehicle, const std::vector<DrivingLog>& logs,
                          const IdentifyOptions& options) {
  LogFitOptions fit;
  fit.vehicle = vehicle;
  // In interpolated commands, the time of each change is known only to about one row spacing. The
  // fit therefore estimates the delay of the commands.
  const bool is_interpolated = std::ranges::any_of(logs, &DrivingLog::has_interpolated_commands);
  fit.terms = requested_terms(options.terms);
  const bool has_delay = contains(options.terms, kInputDelayName);
  if (is_interpolated && !has_delay)
    fit.terms.push_back({free_term(FreeQuantity::Kind::kDelay), 0.0});
  fit.candidate_terms = {ParameterId::kSurgeCoulomb, ParameterId::kSurgeQuadratic,
                         ParameterId::kWheelDeadZone, ParameterId::kYawCoulomb,
                         ParameterId::kYawQuadratic};
  fit.biases = biased_channels(logs, options.biases);
  fit.loss = options.loss;
  fit.seed = options.seed;
  fit.multistart = options.starts;
  fit.bootstrap = options.bootstrap;
  fit.threads = options.threads;
  fit.effort = std::make_shared<Effort>(effort_limit(logs));
  if (options.time_limit_s > 0.0) {
    fit.deadline = std::chrono::steady_clock::now() +
                   std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                       std::chrono::duration<double>(options.time_limit_s));
  }
  return fit;
}

/// Makes the parameters free that the user requested or that have no value, and guesses the latter.
/// Stores the reason for each parameter that the logs cannot identify.
void free_parameters(LogFitOptions& fit, const std::vector<DrivingLog>& logs,
                     const std::vector<ParameterId>& requested, const Model& model,
                     std::map<ParameterId, std::string>& reasons) {
  const bool turning = turns(logs);
  for (const ParameterInfo& parameter : parameter_table()) {
    const Estimate& known = model[parameter.id];
    if (known.value) fit.initial_guess[at(parameter.id)] = *known.value;
    const bool wanted = contains(requested, parameter.id) || !known.value;
    // Back-EMF and the servo's time constant stay fixed if the logs cannot identify them. (With a
    // steering command that never changes, the fitted initial steering angle of each window would
    // act like a trim if the time constant were free.)
    const bool never_acts =
        parameter.id == ParameterId::kBackEmf || parameter.id == ParameterId::kSteeringTimeConstant;
    if (!can_be_requested(parameter) || !wanted) continue;
    const std::string why = cannot_show(logs, parameter.id);
    if (!why.empty()) reasons[parameter.id] = why;
    // In logs with turns, a parameter that the logs cannot identify still affects the values of the
    // parameters that they can. It stays free during the fit, so that the intervals of those
    // parameters include its uncertainty, and is refused afterwards.
    if (!why.empty() && (!turning || never_acts)) continue;
    fit.free.push_back(parameter.id);
    if (!known.value) fit.guessed.push_back(parameter.id);
  }
  if (fit.frees(ParameterId::kBackEmf)) fit = with_back_emf(std::move(fit));
}

/// True if the fit has to be tested for back-EMF. All conditions must hold: the vehicle file does
/// not give k_e; the user requested no parameters; the logs contain enough coasting; no resistance
/// comes from a table, which would include the back-EMF.
bool looks_for_back_emf(const Vehicle& vehicle, const std::vector<DrivingLog>& logs,
                        const IdentifyOptions& options, const Model& model) {
  return options.requested.empty() && !vehicle.back_emf_s_per_m &&
         !model[ParameterId::kSurgeAlpha].value && !model[ParameterId::kYawAlpha].value &&
         why_no_back_emf(logs).empty();
}

/// Number of measured x positions per window.
double mean_positions(const std::vector<FitWindow>& windows) {
  double positions = 0.0;
  for (const FitWindow& window : windows) {
    positions +=
        static_cast<double>(std::ranges::count(window.samples(), LogChannel::kX, &Sample::channel));
  }
  return windows.empty() ? 0.0 : positions / static_cast<double>(windows.size());
}

/// Length of the windows of all fits, s: kWindow_s, unless positions are so precise that the errors
/// of a model grow to many times the noise within a few seconds. The search then has very many
/// wrong optima, which short windows avoid; and precise positions also determine the initial states
/// of short windows. Windows are short if three conditions hold: a short window has kFewest
/// positions on average (with fewer, its own initial state would fit them exactly); the errors of a
/// quick fit are above kFar times the noise (mean squares); short windows reduce them to a tenth.
double window_length_s(const std::vector<DrivingLog>& logs, LogFitOptions fit) {
  constexpr double kFar = 1000.0;
  constexpr double kMuchLess = 0.1;
  constexpr double kShort_s = 0.6;
  constexpr double kFewest = 5.0;
  if (fit.free.empty() || !is_logged(logs, {LogChannel::kX, LogChannel::kY})) return kWindow_s;
  if (mean_positions(fit_windows(logs, kShort_s)) < kFewest) return kWindow_s;
  const double error = fit_roughly(logs, fit).relative_error;
  if (!(error > kFar)) return kWindow_s;
  fit.window_s = kShort_s;
  const double less = fit_roughly(logs, fit).relative_error;
  return less < kMuchLess * error ? kShort_s : kWindow_s;
}

}  // namespace

bool is_logged(const std::vector<DrivingLog>& logs, std::initializer_list<LogChannel> channels) {
  return std::ranges::any_of(logs, [&](const DrivingLog& log) {
    return std::ranges::any_of(channels, [&](LogChannel c) { return log[c].has_value(); });
  });
}

LogFitOptions log_setup(const Vehicle& vehicle, const std::vector<DrivingLog>& logs,
                        const IdentifyOptions& options, const std::vector<ParameterId>& requested,
                        const Model& model, std::map<ParameterId, std::string>& reasons) {
  LogFitOptions fit = fit_options(vehicle, logs, options);
  fit.initial_guess = guess_from_logs(logs, vehicle);
  free_parameters(fit, logs, requested, model, reasons);
  if (looks_for_back_emf(vehicle, logs, options, model)) {
    fit.candidate_terms.push_back(ParameterId::kBackEmf);
  }
  fit.window_s = window_length_s(logs, fit);
  return fit;
}

}  // namespace awmr
