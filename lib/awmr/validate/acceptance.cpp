#include "awmr/validate/acceptance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "awmr/core/index.h"
#include "awmr/core/parallel.h"
#include "awmr/core/statistics/sample_quantile.h"
#include "awmr/core/units.h"
#include "awmr/simulate/conditions.h"
#include "awmr/simulate/plant_sampler.h"
#include "awmr/simulate/simulate.h"
#include "awmr/trials/replay.h"
#include "awmr/validate/drive_series.h"

namespace awmr {
namespace {

/// Fraction of the predicted drives that are within the limits. A larger fraction makes the limits
/// wider, so that they detect fewer differences.
constexpr double kLevel = 0.95;
/// Shortest time that can be compared, s.
constexpr double kShortest_s = 2.0;
/// Drive i draws its latencies, its initial state and its added noise from the random stream
/// kReadingsStream + i. The number is so large that the simulator uses none of these streams.
constexpr std::uint64_t kReadingsStream = std::uint64_t{1} << 40;

Status check_options(const AcceptanceOptions& options) {
  if (options.draws >= 39 && options.draws <= 10000) return {};
  return input_error(
      ErrorCode::kOutOfRange, "draws",
      fmt::format("{} is not a valid number of predicted drives; give a number from 39 to 10000",
                  options.draws));
}

State<double> moved_by(State<double> state, const State<double>& error, Random& random) {
  for (const LogChannel which : kChannels) {
    channel_of(state, which) += channel_of(error, which) * random.normal();
  }
  return state;
}

/// Draws each sensor latency and the motor lag, uniformly between 0 and twice the default, unless
/// the vehicle file has a value for it.
LoopConditions drawn(LoopConditions c, const Vehicle& vehicle, Random& random) {
  const auto draw = [&](const std::optional<double>& given, double& value) {
    const double share = 2.0 * random.uniform();
    if (!given) value *= share;
  };
  draw(vehicle.sensors.heading_latency_s, c.heading_latency_s);
  draw(vehicle.sensors.yaw_rate_latency_s, c.yaw_rate_latency_s);
  draw(vehicle.sensors.speed_latency_s, c.speed_latency_s);
  draw(vehicle.motor_time_constant_s, c.motor_time_constant_s);
  return c;
}

/// The logged drive, with the conditions and the initial state for its prediction.
struct LoggedDrive {
  double from_s = 0.0;  ///< time in the log, s, at which the scenario begins
  /// Time from from_s to the end of the log or of the scenario, whichever comes first.
  double duration_s = 0.0;
  LoopConditions conditions;
  std::vector<DriveChannel> channels;
  DriveStart start;
  Scenario scenario;  ///< scenario with these conditions, from this initial state
};

/// A simulated drive, reduced to the means of each channel over windows of half a second.
struct PredictedDrive {
  /// Scenario time at the end of the run, s. Windows after this time have no simulated values.
  double end_s = 0.0;
  std::vector<WindowMeans> windows;  ///< window means by channel
};

PredictedDrive predicted_drive(const Run& run, const std::vector<DriveChannel>& channels,
                               double sample_time_s, double duration_s, Random& random) {
  PredictedDrive drive{.end_s = run.rows.back().t_s, .windows = {}};
  for (const DriveChannel& channel : channels) {
    drive.windows.push_back(means_of(channel, run, sample_time_s, duration_s, &random));
  }
  return drive;
}

/// Simulates options.draws predicted drives.
Result<std::vector<PredictedDrive>> predicted_drives(const Model& model,
                                                     const Controller<double>& controller,
                                                     const Scenario& as_given,
                                                     const LoggedDrive& logged,
                                                     const AcceptanceOptions& options) {
  std::optional<PlantSampler> sampler;
  if (!model.covariance.parameters.empty()) {
    AWMR_ASSIGN_OR_RETURN(sampler, PlantSampler::make(model));
  }
  const double sample_s = model.vehicle.sample_time_s;
  std::vector<PredictedDrive> drives(at(options.draws));
  std::vector<Status> ended(drives.size());
  parallel_for(drives.size(), options.threads, [&](std::size_t i) {
    const auto sample = static_cast<int>(i) + 1;
    const auto plant = sampler ? sampler->draw(options.seed, sample) : model.plant();
    if (!plant) {
      ended[i] = tl::unexpected(plant.error());
      return;
    }
    Random random(options.seed, kReadingsStream + i);
    Scenario world = under(drawn(logged.conditions, model.vehicle, random), as_given);
    world.initial = moved_by(logged.start.state, logged.start.error, random);
    const Run run = simulate(*plant, controller, world, options.mode,
                             {.sample_time_s = sample_s,
                              .substeps = {},
                              .seed = options.seed,
                              .sample = static_cast<std::uint64_t>(sample)});
    ended[i] = failure_of(run, world);
    if (ended[i]) {
      drives[i] = predicted_drive(run, logged.channels, sample_s, logged.duration_s, random);
    }
  });
  for (Status& status : ended) AWMR_RETURN_IF_ERROR(std::move(status));
  return drives;
}

/// Mean and standard deviation of the predicted window means of a channel.
PredictedBand prediction_of(const DriveChannel& channel, const std::vector<WindowMeans>& draws) {
  const std::size_t windows = draws.front().mean.size();
  const auto n = static_cast<double>(draws.size());
  PredictedBand series{std::vector<double>(windows), std::vector<double>(windows)};
  for (std::size_t w = 0; w < windows; ++w) {
    for (const WindowMeans& draw : draws) series.mean[w] += draw.mean[w] / n;
    double squares = 0.0;
    for (const WindowMeans& draw : draws) squares += std::pow(draw.mean[w] - series.mean[w], 2);
    series.spread[w] = std::sqrt(squares / (n - 1.0));
  }
  // Standard deviations get a small lower bound, because 0 would make distances infinite. 0 occurs
  // if all predicted drives are equal, such as for a command that stays at its limit.
  const double most = *std::max_element(series.spread.begin(), series.spread.end());
  double size = channel.noise;
  for (const double mean : series.mean) size = std::max(size, std::abs(mean));
  const double least = std::max(1e-3 * most, 1e-6 * size + 1e-12);
  for (double& spread : series.spread) spread = std::max(spread, least);
  return series;
}

/// Distance of each window from the prediction, in standard deviations of the predictions; 0 for a
/// window without a measurement.
std::vector<double> distances(const WindowMeans& windows, const PredictedBand& predicted) {
  std::vector<double> all(windows.mean.size());
  for (std::size_t w = 0; w < all.size(); ++w) {
    if (windows.rows[w] > 0) {
      all[w] = std::abs(windows.mean[w] - predicted.mean[w]) / predicted.spread[w];
    }
  }
  return all;
}

double largest_distance(const WindowMeans& windows, const PredictedBand& predicted) {
  const std::vector<double> all = distances(windows, predicted);
  return *std::max_element(all.begin(), all.end());
}

int samples_in(const WindowMeans& windows) {
  return std::accumulate(windows.rows.begin(), windows.rows.end(), 0);
}

ComparedChannel compare_channel(const DriveChannel& channel, std::vector<WindowMeans> draws,
                                double duration_s) {
  ComparedChannel one{.channel = channel,
                      .measured = means_of(channel, duration_s),
                      .predicted = {},
                      .largest = {}};
  for (WindowMeans& draw : draws) {
    draw.mean.resize(one.measured.mean.size());
    draw.rows.resize(one.measured.rows.size());
  }
  one.predicted = prediction_of(channel, draws);
  for (const WindowMeans& draw : draws)
    one.largest.push_back(largest_distance(draw, one.predicted));
  one.usual = rank_quantile(one.largest, kLevel);
  return one;
}

/// Returns for each predicted drive the largest ratio of distance to usual distance
/// (ComparedChannel::largest/usual) over the channels. The ratio makes channels with different
/// distributions comparable.
std::vector<double> factors_of_draws(const std::vector<ComparedChannel>& channels,
                                     std::size_t draws) {
  std::vector<double> factors(draws);
  for (const ComparedChannel& one : channels) {
    for (std::size_t i = 0; i < draws; ++i) {
      factors[i] = std::max(factors[i], one.largest[i] / one.usual);
    }
  }
  return factors;
}

ChannelAcceptance evaluate(const ComparedChannel& one, double factor) {
  ChannelAcceptance result{.channel = one.channel.name,
                           .unit = one.channel.unit,
                           .samples = samples_in(one.measured),
                           .noise = one.channel.noise,
                           .noise_from_log = one.channel.noise_from_log,
                           .allowed = factor * one.usual};
  const std::vector<double> all = distances(one.measured, one.predicted);
  const auto farthest = std::max_element(all.begin(), all.end());
  const auto w = static_cast<std::size_t>(farthest - all.begin());
  result.distance = *farthest;
  result.difference = one.measured.mean[w] - one.predicted.mean[w];
  result.inside = result.distance <= result.allowed;
  for (std::size_t k = 0; k < all.size() && !result.outside_since_s; ++k) {
    if (all[k] > result.allowed) result.outside_since_s = kWindow_s * static_cast<double>(k);
  }
  return result;
}

/// True if the vehicle file gives the noise of this sensor of the controller.
bool is_given(const std::string& channel, const SensorQuality& sensors) {
  if (channel == info(LogChannel::kHeading).name) return sensors.heading_deg.has_value();
  if (channel == info(LogChannel::kYawRate).name) return sensors.yaw_rate_degps.has_value();
  return sensors.speed_mps.has_value();
}

std::vector<ComparedChannel> compare(const std::vector<DriveChannel>& channels,
                                     const std::vector<PredictedDrive>& drives, double duration_s) {
  std::vector<ComparedChannel> all;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    std::vector<WindowMeans> draws;
    for (const PredictedDrive& drive : drives) draws.push_back(drive.windows[c]);
    all.push_back(compare_channel(channels[c], std::move(draws), duration_s));
    if (samples_in(all.back().measured) == 0) all.pop_back();
  }
  return all;
}

/// Compares each channel with its allowed distance, and computes the p-value from the rank of the
/// logged drive among the predicted drives.
void take_verdict(const std::vector<ComparedChannel>& channels, Acceptance& result) {
  const std::vector<double> factors = factors_of_draws(channels, at(result.draws));
  const double allowed = rank_quantile(factors, kLevel);
  double reached = 0.0;
  for (const ComparedChannel& one : channels) {
    result.channels.push_back(evaluate(one, allowed));
    reached = std::max(reached, result.channels.back().distance / one.usual);
  }
  // p is the rank of the logged drive among all n + 1 drives (n predicted drives and itself),
  // divided by n + 1. If the model is right, this rank is uniformly distributed.
  const auto as_far = std::count_if(factors.begin(), factors.end(),
                                    [&](double factor) { return factor >= reached; });
  result.p_value = static_cast<double>(as_far + 1) / static_cast<double>(factors.size() + 1);
  result.inside = result.p_value > 1.0 - kLevel;
}

Result<LoggedDrive> logged_drive(const DrivingLog& log, const Model& model,
                                 const Scenario& as_given, const std::optional<double>& from_s) {
  AWMR_ASSIGN_OR_RETURN(const std::size_t first, first_row_of(log, from_s));
  LoggedDrive drive{.from_s = log.t_s[first],
                    .conditions = conditions_in(log, first, model.vehicle),
                    .channels = {},
                    .start = {},
                    .scenario = {}};
  drive.scenario = under(drive.conditions, as_given);
  drive.duration_s = std::min(drive.scenario.duration_s, log.t_s.back() - drive.from_s);
  drive.channels = channels_of(log, first, drive.duration_s, drive.scenario);
  for (DriveChannel& channel : drive.channels) {
    channel.noise_from_log |=
        channel.noise_in_run && !as_given.sensors && !is_given(channel.name, model.vehicle.sensors);
  }
  drive.start = start_of(log, first, drive.channels, drive.scenario);
  drive.scenario.initial = drive.start.state;
  return drive;
}

}  // namespace

Result<Acceptance> accept_drive(const DrivingLog& log, const Model& model, const ModeGains& gains,
                                const Scenario& as_given, const AcceptanceOptions& options) {
  AWMR_RETURN_IF_ERROR(check_options(options));
  AWMR_RETURN_IF_ERROR(check_mode(model.vehicle, options.mode));
  AWMR_ASSIGN_OR_RETURN(const Plant<double> plant, model.plant());
  AWMR_RETURN_IF_ERROR(check_work(plant, model.file, as_given, model.vehicle.sample_time_s));
  AWMR_ASSIGN_OR_RETURN(const Controller<double> controller,
                        controller_for(model, gains.in(options.mode)));
  AWMR_ASSIGN_OR_RETURN(const LoggedDrive drive,
                        logged_drive(log, model, as_given, options.from_s));
  AWMR_ASSIGN_OR_RETURN(const std::vector<PredictedDrive> predicted,
                        predicted_drives(model, controller, as_given, drive, options));
  Acceptance result{.file = log.file,
                    .scenario = drive.scenario.name,
                    .mode = options.mode,
                    .from_s = drive.from_s,
                    .duration_s = drive.duration_s,
                    .draws = options.draws};
  for (const PredictedDrive& one : predicted)
    result.duration_s = std::min(result.duration_s, one.end_s);
  if (result.duration_s < kShortest_s) {
    return input_error(ErrorCode::kTooFewData, log.file,
                       fmt::format("only {:.3g} s of the log overlap scenario '{}'; give a log of "
                                   "at least {:g} s of the scenario",
                                   result.duration_s, drive.scenario.name, kShortest_s));
  }
  const std::vector<ComparedChannel> channels =
      compare(drive.channels, predicted, result.duration_s);
  take_verdict(channels, result);
  if (!result.inside) {
    result.hypotheses =
        fault_hypotheses(model, controller, drive.scenario, options, result.duration_s, channels);
  }
  return result;
}

std::string acceptance_table(const Acceptance& acceptance) {
  std::string text = fmt::format(
      "{} against scenario '{}', {}, {:.4g} s from {:g} s on: {} the prediction (p {:.3g}, {} "
      "draws)\n",
      acceptance.file, acceptance.scenario, name_of(acceptance.mode), acceptance.duration_s,
      acceptance.from_s, acceptance.inside ? "within" : "outside of", acceptance.p_value,
      acceptance.draws);
  text += fmt::format("  {:<18} {:>8} {:>10} {:>9} {:>9}  {}\n", "channel", "samples", "noise",
                      "distance", "allowed", "outside since, by");
  for (const ChannelAcceptance& one : acceptance.channels) {
    const std::string since =
        one.inside ? "-"
                   : fmt::format("{:.1f} s, {:+.3g} {}", one.outside_since_s.value_or(0.0),
                                 one.difference, one.unit);
    text += fmt::format("  {:<18} {:>8} {:>10} {:>9.3g} {:>9.3g}  {}\n", one.channel, one.samples,
                        fmt::format("{:.3g}{}", one.noise, one.noise_from_log ? "*" : ""),
                        one.distance, one.allowed, since);
  }
  text += "  * noise estimated from the log\n";
  if (acceptance.inside) return text;
  text += acceptance.hypotheses.empty() ? "  no single model change explains the difference\n"
                                        : "  most likely single causes:\n";
  for (const FaultHypothesis& hypothesis : acceptance.hypotheses) {
    text += fmt::format("    {:<28} {:>9.3g} {:<6} explains {:.0f} %\n", hypothesis.what,
                        hypothesis.value, hypothesis.unit, 100.0 * hypothesis.explained);
  }
  return text;
}

}  // namespace awmr
