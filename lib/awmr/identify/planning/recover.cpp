#include "awmr/identify/planning/recover.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <thread>

namespace awmr {
namespace {

RowError error_of(const IdentifyOptions& options) {
  if (options.method != Method::kNonlinear) return RowError::kLogForce;
  switch (options.noise.value_or(ErrorModel::kTime)) {
    case ErrorModel::kForce:
      return RowError::kForce;
    case ErrorModel::kSpeed:
      return RowError::kSpeed;
    case ErrorModel::kTime:
      return RowError::kTime;
    case ErrorModel::kLogForce:
      break;
  }
  return RowError::kLogForce;
}

const char* name_of(RowError error) {
  switch (error) {
    case RowError::kLogForce:
      return "log force";
    case RowError::kForce:
      return "force";
    case RowError::kSpeed:
      return "speed";
    case RowError::kTime:
      return "time";
  }
  return "";
}

/// The residual scatter that the model's own fit of this subject left, in the unit of the error.
double scatter(const Model& model, FitSubject subject, RowError error) {
  for (const EstimatorReport& report : model.record.reports) {
    if (report.subject == subject && report.noise == name_of(error) &&
        (report.family.empty() || report.family == "power")) {
      return report.residual_std;
    }
  }
  return 0.0;
}

/// The inputs of the model's own trials.
TablePlan plan_of(const Model& model) {
  TablePlan plan;
  double force_sum = 0.0;
  for (const TrialPoint& trial : model.record.trials) {
    if (trial.kind == TrialKind::kSurge) plan.surge_tau_speed.push_back(trial.input);
    if (trial.kind == TrialKind::kCoastdown) plan.stop_from_mps.push_back(trial.input);
    if (trial.kind == TrialKind::kTurning) force_sum = std::max(force_sum, trial.input);
  }
  // tau_turn = 2 l_f F' sin d_r: one F' whose largest angle is the vehicle's stop.        [paper
  // (62)]
  const double stop_rad = model.vehicle.steering_max_deg * 0.017453292519943295;
  plan.turning_wheel_force = force_sum / (2.0 * model.vehicle.front_axle_m * std::sin(stop_rad));
  for (const TrialPoint& trial : model.record.trials) {
    if (trial.kind != TrialKind::kTurning) continue;
    plan.turning_steering_rad.push_back(
        std::asin(trial.input / (2.0 * model.vehicle.front_axle_m * plan.turning_wheel_force)));
  }
  return plan;
}

/// What the runs of one parameter add up to. Sums are taken in the order of the runs afterwards, so
/// that threads do not matter.
struct OneRun {
  std::vector<std::optional<Estimate>> estimates;  ///< by ParameterId
  bool failed = false;
};

class Recoverer {
 public:
  Recoverer(const Model& model, const Plant<double>& plant, const RecoverOptions& options)
      : model_(model), plant_(plant), options_(options), plan_(plan_of(model)) {
    noise_.error = options.error.value_or(error_of(options.identify));
    noise_.surge = scatter(model, FitSubject::kSurge, noise_.error);
    noise_.turning = scatter(model, FitSubject::kYaw, noise_.error);
    constexpr double kStopWatch_s = 0.02;
    noise_.stop_time_s = kStopWatch_s;
  }

  const RowNoise& noise() const { return noise_; }

  OneRun run(int index) const {
    Random random(options_.seed, static_cast<std::uint64_t>(index));
    TrialData data;
    if (options_.plan == RecoverPlan::kLog) {
      DrivePlan drive = options_.drive;
      drive.drive = options_.seed + static_cast<std::uint64_t>(index);
      data.logs.push_back(simulate_log(plant_, model_.vehicle, drive, options_.sensors, random));
    } else {
      TablePlan plan = plan_;
      const bool curve = options_.plan == RecoverPlan::kCurve;
      if (curve) plan.stop_from_mps.clear();
      data = simulate_tables(plant_, plan, noise_, random);
      if (curve) {
        const auto top = steady_top();
        data.curves.push_back(simulate_coastdown(plant_, top, options_.curve_s,
                                                 options_.curve_rate_hz, options_.sensors.speed_mps,
                                                 options_.sensors.correlation_s, random));
      }
    }
    IdentifyOptions identify_options = options_.identify;
    identify_options.threads = 1;
    identify_options.side_by_side = false;
    const auto identified = identify(model_.vehicle, data, identify_options, {});
    OneRun one;
    if (!identified) {
      one.failed = true;
      return one;
    }
    one.failed = !identified->refused.empty();
    for (const Estimate& estimate : identified->model.estimates) {
      const bool fitted = estimate.value && estimate.ci95 && estimate.source != Source::kGiven;
      one.estimates.push_back(fitted ? std::optional(estimate) : std::nullopt);
    }
    return one;
  }

 private:
  /// The fastest of the model's surge trials, as the coast-down starts from it.
  double steady_top() const {
    double top = 0.5;
    for (const TrialPoint& trial : model_.record.trials) {
      if (trial.kind == TrialKind::kSurge) top = std::max(top, trial.measured);
    }
    return top;
  }

  const Model& model_;
  const Plant<double>& plant_;
  const RecoverOptions& options_;
  TablePlan plan_;
  RowNoise noise_;
};

RecoveredParameter judged(ParameterId id, double truth, const std::vector<OneRun>& runs) {
  RecoveredParameter p{.id = id, .truth = truth};
  int covered = 0;
  for (const OneRun& run : runs) {
    const auto at = static_cast<std::size_t>(id);
    if (at >= run.estimates.size() || !run.estimates[at]) continue;
    const Estimate& estimate = *run.estimates[at];
    const double error = *estimate.value - truth;
    p.bias += error;
    p.rmse += error * error;
    p.mean_std_error += estimate.std_error.value_or(0.0);
    p.worst_error = std::max(p.worst_error, std::abs(error / truth));
    covered += estimate.ci95->contains(truth) ? 1 : 0;
    ++p.runs;
  }
  if (p.runs == 0) return p;
  const double n = p.runs;
  p.bias /= n;
  p.rmse = std::sqrt(p.rmse / n);
  p.mean_std_error /= n;
  p.coverage95 = covered / n;
  return p;
}

}  // namespace

Result<Recovery> recover(const Model& model,
                         const RecoverOptions& options, const std::function<void(int)>& progress) {
  const auto plant = model.plant();
  if (!plant) return tl::unexpected(plant.error());
  if (options.runs < 2) return input_error("--runs", "at least 2 are needed");
  if (options.plan != RecoverPlan::kLog && model.record.trials.empty()) {
    return input_error(model.file + ":/trials",
                       "holds no trials whose inputs could be simulated again; use --plan log");
  }
  const Recoverer recoverer(model, *plant, options);
  std::vector<OneRun> runs(static_cast<std::size_t>(options.runs));
  std::mutex mutex;
  int next = 0;
  int done = 0;
  const auto work = [&] {
    for (;;) {
      int index = 0;
      {
        const std::scoped_lock lock(mutex);
        if (next == options.runs) return;
        index = next++;
      }
      OneRun one = recoverer.run(index);
      const std::scoped_lock lock(mutex);
      runs[static_cast<std::size_t>(index)] = std::move(one);
      if (progress) progress(++done);
    }
  };
  const unsigned available = std::max(1U, std::thread::hardware_concurrency());
  const unsigned count = options.threads > 0 ? static_cast<unsigned>(options.threads) : available;
  std::vector<std::thread> pool;
  for (unsigned t = 1; t < count; ++t) pool.emplace_back(work);
  work();
  for (std::thread& thread : pool) thread.join();

  Recovery recovery;
  recovery.runs = options.runs;
  recovery.noise = recoverer.noise();
  recovery.failed = static_cast<int>(
      std::count_if(runs.begin(), runs.end(), [](const OneRun& run) { return run.failed; }));
  for (const ParameterInfo& parameter : parameter_table()) {
    const RecoveredParameter p = judged(parameter.id, *model[parameter.id].value, runs);
    if (p.runs > 0) recovery.parameters.push_back(p);
  }
  const SensorNoise& s = options.sensors;
  recovery.noise_text =
      options.plan == RecoverPlan::kLog
          ? fmt::format(
                "speed {:g} m/s, yaw rate {:.3g} rad/s, heading {:.3g} rad, position {:g} m "
                "at {:g} Hz, correlated over {:g} s",
                s.speed_mps, s.yaw_rate_radps, s.heading_rad, s.position_m, s.position_rate_hz,
                s.correlation_s)
          : fmt::format("on {}: surge {:.3g}, turning {:.3g}; stop time {:g} s; curve {:g} m/s",
                        name_of(recovery.noise.error), recovery.noise.surge, recovery.noise.turning,
                        recovery.noise.stop_time_s, s.speed_mps);
  return recovery;
}

}  // namespace awmr
