#include "awmr/identify/logs/log_stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>

#include "awmr/identify/tables/steady_fit.h"

namespace awmr {
namespace {

constexpr double kDisagreement = 0.01;

bool contains(const std::vector<ParameterId>& ids, ParameterId id) {
  return std::find(ids.begin(), ids.end(), id) != ids.end();
}

double rms(const std::vector<double>& values) {
  double squares = 0.0;
  for (const double value : values) squares += value * value;
  return std::sqrt(squares / static_cast<double>(values.size()));
}

/// Orders of magnitude from the logs themselves, for parameters that nothing else gives: resistance
/// balances thrust at typical speed, inertia makes time constants of a third of a second.
std::map<ParameterId, double> guesses(const std::vector<DrivingLog>& logs, const Vehicle& vehicle) {
  double thrust = 0.0;
  double speed = 0.0;
  double moment = 0.0;
  double yaw_rate = 0.0;
  for (const DrivingLog& log : logs) {
    const double n = static_cast<double>(logs.size());
    const double left = rms(log.force_left);
    const double right = rms(log.force_right);
    thrust += 2.0 * (left + right) / n;
    speed += (log[LogChannel::kSpeed] ? rms(log[LogChannel::kSpeed]->value) : 1.0) / n;
    std::vector<double> difference;
    for (std::size_t i = 0; i < log.rows(); ++i) {
      difference.push_back(log.force_right[i] - log.force_left[i]);
    }
    const double steering = rms(log.steering_command_rad ? *log.steering_command_rad
                                                         : log[LogChannel::kSteering]->value);
    moment += (2.0 * vehicle.half_track_m * rms(difference) +
               vehicle.front_axle_m * (left + right) * steering) /
              n;
    yaw_rate += (log[LogChannel::kYawRate] ? rms(log[LogChannel::kYawRate]->value) : 0.2) / n;
  }
  const auto or_else = [](double value, double otherwise) {
    return value > 1e-6 && std::isfinite(value) ? value : otherwise;
  };
  constexpr double kTimeConstant_s = 0.3;
  constexpr double kBeta = 0.8;
  const double surge = or_else(thrust, 1.0) / std::pow(or_else(speed, 1.0), kBeta);
  const double yaw = or_else(moment, 0.05) / std::pow(or_else(yaw_rate, 0.2), kBeta);
  const double mass = kTimeConstant_s * surge;
  return {{ParameterId::kSurgeAlpha, surge},
          {ParameterId::kSurgeBeta, kBeta},
          {ParameterId::kYawAlpha, yaw},
          {ParameterId::kYawBeta, kBeta},
          {ParameterId::kSwayAlpha, mass / 0.1},
          {ParameterId::kMassNorm, mass},
          {ParameterId::kInertiaNorm, mass * vehicle.inertia_kgm2() / vehicle.mass_kg},
          {ParameterId::kSteeringTimeConstant, 0.05},
          {ParameterId::kSurgeCoulomb, 0.0},
          {ParameterId::kSurgeQuadratic, 0.0},
          {ParameterId::kYawCoulomb, 0.0},
          {ParameterId::kYawQuadratic, 0.0},
          {ParameterId::kWheelDeadZone, 0.0}};
}

/// The terms that the families asked for have, with their exponents.
void free_terms(Family surge_family, Family yaw_family, LogFitOptions& fit) {
  const auto drop = [&](ParameterId id) {
    std::erase(fit.free, id);
    fit.start[id] = 1.0;
  };
  const auto add = [&](ParameterId id, double start) {
    if (!contains(fit.free, id)) fit.free.push_back(id);
    if (!(fit.start[id] > 0.0)) fit.start[id] = start;
  };
  const FamilyTerms surge = terms_of(surge_family);
  const FamilyTerms yaw = terms_of(yaw_family);
  constexpr double kShare = 0.1;  // of the power law's value at 1
  if (!surge.beta) drop(ParameterId::kSurgeBeta);
  if (!yaw.beta) drop(ParameterId::kYawBeta);
  if (surge.coulomb) {
    add(ParameterId::kSurgeCoulomb, kShare * fit.start[ParameterId::kSurgeAlpha]);
  }
  if (surge.quadratic) add(ParameterId::kSurgeQuadratic, 0.0);
  if (surge.dead_zone) add(ParameterId::kWheelDeadZone, 0.05);
  if (yaw.coulomb) add(ParameterId::kYawCoulomb, kShare * fit.start[ParameterId::kYawAlpha]);
  if (yaw.quadratic) add(ParameterId::kYawQuadratic, 0.0);
}

/// Drops parameters that no channel or command of the logs could show, before the search: a
/// straight log says nothing of yaw.
std::string cannot_show(const std::vector<DrivingLog>& logs, ParameterId id) {
  const bool any_servo = std::any_of(logs.begin(), logs.end(), [](const DrivingLog& log) {
    return log.steering_command_rad.has_value();
  });
  if (id == ParameterId::kSteeringTimeConstant && !any_servo) {
    return "the logs hold the steering angle as it was, not its command";
  }
  return {};
}

class Stage {
 public:
  Stage(const Vehicle& vehicle, const std::vector<DrivingLog>& logs, const IdentifyOptions& options,
        const std::vector<ParameterId>& asked, const Model& model, bool overrule)
      : vehicle_(vehicle),
        logs_(logs),
        options_(options),
        asked_(asked),
        model_(model),
        overrule_(overrule) {}

  LogStage run() {
    prepare();
    const LogFit fit =
        options_.surge_family.family ? fit_family(*options_.surge_family.family) : best_family();
    report(fit);
    judge_model(fit);
    if (!fit.usable) {
      stage_.findings.push_back(
          {logs_.front().file, 0, Severity::kError, "not-converged",
           "the fit of the logs did not converge: " + fit.report.stop_reason});
      for (const ParameterId id : chosen_.free) {
        stage_.reasons[id] = "the fit of the logs did not converge";
      }
      return std::move(stage_);
    }
    take(fit);
    if (options_.cross_validate && logs_.size() > 1) leave_one_log_out();
    return std::move(stage_);
  }

 private:
  void prepare() {
    fit_.vehicle = vehicle_;
    fit_.delay = options_.fit_input_delay;
    fit_.biases = options_.biases;
    fit_.loss = options_.loss;
    fit_.seed = options_.seed;
    fit_.starts = options_.starts;
    fit_.bootstrap = options_.bootstrap;
    fit_.threads = options_.threads;
    fit_.start = guesses(logs_, vehicle_);
    for (const ParameterInfo& parameter : parameter_table()) {
      const Estimate& known = model_[parameter.id];
      if (known.value) fit_.start[parameter.id] = *known.value;
      const bool wanted = contains(asked_, parameter.id) || !known.value;
      if (parameter.term || !wanted) continue;
      const std::string why = cannot_show(logs_, parameter.id);
      if (!why.empty()) {
        stage_.reasons[parameter.id] = why;
        continue;
      }
      fit_.free.push_back(parameter.id);
      if (!known.value) fit_.guessed.push_back(parameter.id);
    }
  }

  LogFit fit_family(Family surge) {
    chosen_ = fit_;
    free_terms(surge, options_.yaw_family.family.value_or(Family::kPower), chosen_);
    LogFit result = fit_logs(logs_, chosen_);
    result.report.family = name_of(surge);
    if (std::isfinite(result.aic)) result.report.aicc = result.aic;
    stage_.surge_family = surge;
    return result;
  }

  /// Every family of surge resistance in turn; the least AIC of those that converged is taken, the
  /// others are reported.
  LogFit best_family() {
    std::optional<LogFit> best;
    LogFitOptions best_options;
    Family best_name = Family::kPower;
    double power_aic = 0.0;
    for (const Family family : kFamilies) {
      LogFit fit = fit_family(family);
      if (family == Family::kPower) power_aic = fit.aic;
      const bool better = !best || (fit.usable && (!best->usable || fit.aic < best->aic));
      if (!better) {
        stage_.reports.push_back(fit.report);
        continue;
      }
      if (best) stage_.reports.push_back(best->report);
      best = std::move(fit);
      best_options = chosen_;
      best_name = family;
    }
    chosen_ = best_options;
    stage_.surge_family = best_name;
    constexpr double kPlainlyBetter = 10.0;
    if (best_name != Family::kPower && power_aic - best->aic > kPlainlyBetter) {
      stage_.findings.push_back(
          {logs_.front().file, 0, Severity::kNote, "power-law-inadequate",
           fmt::format("a power law does not describe these logs: {} is better by {:.0f} of AIC",
                       name_of(best_name), power_aic - best->aic)});
    }
    return *best;
  }

  /// Where the errors are the model's own: is it the family?
  void judge_model(const LogFit& fit) {
    for (const auto& [channel, noise] : fit.noise) {
      if (!noise.of_the_model()) continue;
      std::string advice = "something that the model does not know acts on the vehicle";
      const bool power = options_.surge_family.family == Family::kPower && fit_rivals_;
      if (channel == LogChannel::kSpeed && power) {
        const LogFitOptions kept = chosen_;
        const Family family = stage_.surge_family;
        fit_rivals_ = false;
        const LogFit rival = best_family();
        if (stage_.surge_family != Family::kPower) {
          advice = fmt::format(
              "a power law does not describe these logs; --family surge={} does "
              "better by {:.0f} of AIC",
              name_of(stage_.surge_family), fit.aic - rival.aic);
        }
        stage_.reports.push_back(rival.report);
        chosen_ = kept;
        stage_.surge_family = family;
      }
      stage_.findings.push_back(
          {logs_.front().file, 0, Severity::kWarning, "model-inadequate",
           fmt::format(
               "the model misses {} by {:.3g} {} over {:.2g} s at a time, where the sensor's "
               "own noise is {:.2g}: {}. The intervals hold for the model as it is, not for "
               "the vehicle",
               info(channel).name, noise.std, info(channel).unit, noise.correlation_s,
               noise.sensor_std, advice)});
    }
  }

  void report(const LogFit& fit) {
    stage_.reports.push_back(fit.report);
    for (const Diagnostic& test : fit.report.diagnostics) {
      if (test.p_value >= 1e-3 || !test.name.starts_with("whiteness")) continue;
      stage_.findings.push_back(
          {logs_.front().file, 0, Severity::kNote, "coloured-residuals",
           fmt::format("{}: the residuals stay correlated (p = {:.2g}) beyond what a first-order "
                       "process explains: the model misses something, and the intervals are too "
                       "narrow by some factor; --bootstrap 1000 gives wider ones",
                       test.name, test.p_value)});
    }
  }

  void take(const LogFit& fit) {
    stage_.block = fit.covariance;
    for (std::size_t i = 0; i < fit.quantities.size(); ++i) {
      const FreeQuantity& q = fit.quantities[i];
      if (q.kind != FreeQuantity::Kind::kParameter) {
        if (!fit.identifiable[i]) {
          stage_.findings.push_back({logs_.front().file, 0, Severity::kWarning, "not-identifiable",
                                     fmt::format("{}: {}", q.name(), fit.why[i])});
        }
        continue;
      }
      if (!fit.identifiable[i]) {
        stage_.reasons[q.id] = fit.why[i];
        continue;
      }
      const auto at = static_cast<Eigen::Index>(i);
      const EstimatorParameter& parameter = fit.report.parameters[i];
      compare(q.id, fit.coordinates(at), fit.covariance(at, at), q);
      const Estimate& known = model_[q.id];
      const bool other_trial = known.value && known.source != Source::kGiven;
      if (other_trial && !overrule_) continue;
      stage_.main.push_back({q.id,
                             Estimate{parameter.value, parameter.std_error, parameter.ci95,
                                      Source::kFitted, "trajectory"},
                             at, q.jacobian(fit.coordinates(at))});
    }
  }

  /// The same parameter from other trials: do the two agree within their errors?
  void compare(ParameterId id, double coordinate, double variance, const FreeQuantity& q) {
    const Estimate& known = model_[id];
    if (!known.value || !known.std_error || !(*known.std_error > 0.0)) return;
    const double other = q.logarithmic ? std::log(*known.value) : *known.value;
    const double other_std = *known.std_error / (q.logarithmic ? *known.value : 1.0);
    const double z = std::abs(coordinate - other) / std::sqrt(variance + other_std * other_std);
    const double p = 2.0 * boost::math::cdf(boost::math::complement(boost::math::normal(), z));
    if (p >= kDisagreement) return;
    stage_.findings.push_back(
        {logs_.front().file, 0, Severity::kWarning, "estimates-disagree",
         fmt::format("{} is {:.4g} by the logs and {:.4g} by the {}: {:.1f} standard deviations "
                     "apart (p = {:.2g})",
                     info(id).name, q.value(coordinate), *known.value, known.method, z, p)});
  }

  /// Each log predicted by a model of the others.
  void leave_one_log_out() {
    for (std::size_t out = 0; out < logs_.size(); ++out) {
      std::vector<DrivingLog> others = logs_;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(out));
      LogFitOptions options = chosen_;
      options.bootstrap = 0;
      const LogFit fit = fit_logs(others, options);
      LeaveOneOut entry{logs_[out].file, 0, {}};
      for (const EstimatorParameter& p : fit.report.parameters) entry.values.push_back(p.value);
      stage_.reports.front().leave_one_out.push_back(entry);
      if (!fit.usable) continue;
      std::map<ParameterId, double> values = options.start;
      double delay_s = 0.0;
      for (std::size_t i = 0; i < fit.quantities.size(); ++i) {
        const double value = fit.report.parameters[i].value;
        if (fit.quantities[i].kind == FreeQuantity::Kind::kParameter) {
          values[fit.quantities[i].id] = value;
        } else if (fit.quantities[i].kind == FreeQuantity::Kind::kDelay) {
          delay_s = value;
        }
      }
      std::string errors;
      for (const auto& [channel, nrmse] :
           prediction_error(logs_[out], plant_at(vehicle_, values), delay_s)) {
        errors += fmt::format("{}{} {:.1f} %", errors.empty() ? "" : ", ", info(channel).name,
                              100.0 * nrmse);
      }
      stage_.findings.push_back(
          {logs_[out].file, 0, Severity::kNote, "held-out-log",
           fmt::format("predicted by the other logs over windows of 10 s, error over the signal's "
                       "own deviation: {}",
                       errors)});
    }
  }

  const Vehicle& vehicle_;
  const std::vector<DrivingLog>& logs_;
  const IdentifyOptions& options_;
  const std::vector<ParameterId>& asked_;
  const Model& model_;
  const bool overrule_;
  LogFitOptions fit_;     ///< of the power law, without a family's terms
  LogFitOptions chosen_;  ///< with them
  bool fit_rivals_ = true;
  LogStage stage_;
};

}  // namespace

LogStage run_log_stage(const Vehicle& vehicle, const std::vector<DrivingLog>& logs,
                       const IdentifyOptions& options, const std::vector<ParameterId>& asked,
                       const Model& model, bool overrule) {
  return Stage(vehicle, logs, options, asked, model, overrule).run();
}

}  // namespace awmr
