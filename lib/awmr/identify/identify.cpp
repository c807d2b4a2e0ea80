#include "awmr/identify/identify.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "awmr/identify/derived.h"
#include "awmr/identify/power_law_fit.h"

namespace awmr {
namespace {

/// One resistance to identify: surge or yaw.
struct Subject {
  std::string name;
  ParameterId alpha;
  ParameterId beta;
  Interval beta_range;
  std::string file;
  std::vector<PowerLawPoint> points;
};

std::vector<PowerLawPoint> points_of(const std::vector<SurgeRow>& rows) {
  std::vector<PowerLawPoint> points;
  for (const SurgeRow& row : rows) {
    points.push_back({row.tau_speed, row.speed_mps, row.distance_m, row.elapsed_s});
  }
  return points;
}

std::vector<PowerLawPoint> points_of(const std::vector<TurningRow>& rows) {
  std::vector<PowerLawPoint> points;
  for (const TurningRow& row : rows) {
    PowerLawPoint point{row.tau_turn_m, row.yaw_rate_radps, {}, row.elapsed_s};
    if (row.turns) point.travel = 2.0 * std::numbers::pi * *row.turns;
    points.push_back(point);
  }
  return points;
}

/// A power law needs two different forces: repeats of one show scatter, no exponent.
bool has_two_forces(const std::vector<PowerLawPoint>& points) {
  constexpr double kSame = 1e-9;
  return std::any_of(points.begin(), points.end(), [&](const PowerLawPoint& p) {
    return std::abs(p.force - points.front().force) > kSame * points.front().force;
  });
}

bool all_timed(const std::vector<PowerLawPoint>& points) {
  return std::all_of(points.begin(), points.end(),
                     [](const PowerLawPoint& p) { return p.travel && p.elapsed_s; });
}

std::string noise_name(Noise noise) {
  switch (noise) {
    case Noise::kForce:
      return "force";
    case Noise::kSpeed:
      return "speed";
    case Noise::kTime:
      return "time";
  }
  return {};
}

/// exp(value) with the standard error of its logarithm, the interval symmetric in the logarithm.
Estimate from_log(double log_value, std::optional<double> log_std_error, int degrees_of_freedom,
                  Source source, std::string method) {
  Estimate estimate{std::exp(log_value), {}, {}, source, std::move(method)};
  if (log_std_error) {
    const double half = t_quantile_95(degrees_of_freedom) * *log_std_error;
    estimate.std_error = *estimate.value * *log_std_error;
    estimate.ci95 = Interval{std::exp(log_value - half), std::exp(log_value + half)};
  }
  return estimate;
}

std::optional<double> log_alpha_std_error(const PowerLawFit& fit) {
  if (!fit.covariance) return std::nullopt;
  return std::sqrt((*fit.covariance)(0, 0));
}

std::optional<double> beta_std_error(const PowerLawFit& fit) {
  if (!fit.covariance || fit.beta_at_bound) return std::nullopt;
  return std::sqrt((*fit.covariance)(1, 1));
}

Estimate beta_estimate(const PowerLawFit& fit, const std::string& method) {
  Estimate estimate{fit.beta, beta_std_error(fit), {}, Source::kFitted, method};
  if (estimate.std_error) {
    const double half = t_quantile_95(fit.degrees_of_freedom) * *estimate.std_error;
    estimate.ci95 = Interval{fit.beta - half, fit.beta + half};
  }
  return estimate;
}

/// Collects what identify() returns.
class Identifier {
 public:
  Identifier(const Vehicle& vehicle, const TrialData& data, const IdentifyOptions& options,
             std::vector<Finding> findings)
      : vehicle_(vehicle), data_(data), options_(options) {
    result_.model.vehicle = vehicle;
    result_.model.findings = std::move(findings);
  }

  Identification run() {
    set_given();
    if (data_.surge) {
      surge_ = fit({"surge", ParameterId::kSurgeAlpha, ParameterId::kSurgeBeta,
                    vehicle_.surge_beta_range, data_.surge->file, points_of(data_.surge->rows)});
    }
    if (data_.turning) {
      yaw_ = fit({"yaw", ParameterId::kYawAlpha, ParameterId::kYawBeta, vehicle_.yaw_beta_range,
                  data_.turning->file, points_of(data_.turning->rows)});
    }
    derive_mass();
    set_covariance();
    keep_trials();
    refuse_what_is_missing();
    return std::move(result_);
  }

 private:
  void find(Severity severity, const std::string& file, const std::string& code,
            std::string message) {
    result_.model.findings.push_back({file, 0, severity, code, std::move(message)});
  }

  void set_given() {
    if (vehicle_.sway_alpha) {
      result_.model[ParameterId::kSwayAlpha] = {
          vehicle_.sway_alpha, {}, {}, Source::kGiven, "vehicle"};
    }
    result_.model[ParameterId::kSteeringTimeConstant] = {
        vehicle_.steering_time_constant_s, {}, {}, Source::kGiven, "vehicle"};
    check_inertia(vehicle_, result_.model.findings);
  }

  void report(const Subject& subject, const std::string& estimator, const std::string& noise,
              const PowerLawFit& fit) {
    EstimatorReport report;
    report.subject = subject.name;
    report.estimator = estimator;
    report.noise = noise;
    const Estimate alpha = from_log(fit.log_alpha, log_alpha_std_error(fit), fit.degrees_of_freedom,
                                    Source::kFitted, estimator);
    const Estimate beta = beta_estimate(fit, estimator);
    report.parameters = {
        {std::string(info(subject.alpha).name), *alpha.value, alpha.std_error, alpha.ci95},
        {std::string(info(subject.beta).name), *beta.value, beta.std_error, beta.ci95}};
    report.residual_std = fit.residual_std;
    report.rows_used = static_cast<int>(subject.points.size());
    report.degrees_of_freedom = fit.degrees_of_freedom;
    report.rank = fit.rank;
    report.condition_number = fit.condition_number;
    report.stop_reason = fit.stop_reason;
    result_.model.reports.push_back(std::move(report));
  }

  /// All estimators on one subject; the chosen one fills the main values. Empty where the rows
  /// cannot show the law.
  std::optional<PowerLawFit> fit(const Subject& subject) {
    if (!has_two_forces(subject.points)) return std::nullopt;
    const PowerLawFit log_linear = fit_log_linear(subject.points);
    if (!log_linear.usable) return std::nullopt;
    report(subject, "log-linear", "log force", log_linear);
    PowerLawFit chosen = log_linear;
    const Noise wanted =
        options_.noise.value_or(all_timed(subject.points) ? Noise::kTime : Noise::kSpeed);
    for (const Noise noise : {Noise::kForce, Noise::kSpeed, Noise::kTime}) {
      if (noise == Noise::kTime && !all_timed(subject.points)) {
        if (options_.method == Method::kNonlinear && wanted == noise) {
          find(Severity::kError, subject.file, "not-timed",
               "--noise time needs a distance or turns and elapsed_s in every row");
          return std::nullopt;
        }
        continue;
      }
      const PowerLawFit candidate =
          fit_nonlinear(subject.points, noise, subject.beta_range, log_linear);
      report(subject, "nonlinear", noise_name(noise), candidate);
      if (options_.method == Method::kNonlinear && noise == wanted) chosen = candidate;
    }
    const std::string method = options_.method == Method::kLogLinear
                                   ? std::string("log-linear")
                                   : "nonlinear, noise on " + noise_name(wanted);
    if (!chosen.usable) {
      find(Severity::kError, subject.file, "not-converged",
           fmt::format("the {} fit of {} did not converge: {}", method, subject.name,
                       chosen.stop_reason));
      return std::nullopt;
    }
    result_.model[subject.alpha] = from_log(chosen.log_alpha, log_alpha_std_error(chosen),
                                            chosen.degrees_of_freedom, Source::kFitted, method);
    result_.model[subject.beta] = beta_estimate(chosen, method);
    check_fit(subject, chosen);
    return chosen;
  }

  void check_fit(const Subject& subject, const PowerLawFit& fit) {
    if (fit.degrees_of_freedom == 0) {
      find(Severity::kWarning, subject.file, "no-degrees-of-freedom",
           fmt::format(
               "two rows fix the two parameters of {} exactly and leave nothing to judge them "
               "by: no standard error; record a third run",
               subject.name));
    }
    const Interval& range = subject.beta_range;
    if (fit.beta_at_bound || !range.contains(fit.beta)) {
      find(Severity::kWarning, subject.file, "exponent-at-bound",
           fmt::format(
               "the exponent {} = {:.4g} is {} the accepted range [{:g}, {:g}]: a power law of "
               "this range may not describe these runs",
               info(subject.beta).name, fit.beta, fit.beta_at_bound ? "at the end of" : "outside",
               range.lo, range.hi));
    }
  }

  void derive_mass() {
    if (!data_.coastdown || data_.coastdown->rows.empty() || !surge_ || surge_->beta >= 1.0) return;
    mass_ = mass_from_stop_time(*surge_, data_.coastdown->rows);
    std::optional<double> std_error;
    if (surge_->covariance) {
      const Eigen::Vector2d by(1.0, mass_->by_beta);
      std_error = std::sqrt(by.dot(*surge_->covariance * by) + mass_->timing_variance);
    }
    const double log_inertia =
        mass_->log_mass_norm + std::log(vehicle_.inertia_kgm2() / vehicle_.mass_kg);
    const int dof = surge_->degrees_of_freedom;
    result_.model[ParameterId::kMassNorm] =
        from_log(mass_->log_mass_norm, std_error, dof, Source::kDerived, "stop time");
    // I'z = m' Iz / m                                                              [paper (68)]
    result_.model[ParameterId::kInertiaNorm] =
        from_log(log_inertia, std_error, dof, Source::kDerived,
                 vehicle_.yaw_inertia_kgm2 ? "m' and the given inertia" : "m' and the box formula");
    check_mass(*surge_, *data_.coastdown, vehicle_.mass_kg, std::exp(mass_->log_mass_norm),
               std_error, result_.model.findings);
  }

  /// Over (a1, b1, a3, b3, m', I'z), as far as they are known: J C J^T with C over
  /// (ln a1, b1, ln a3, b3, timing) and J the derivatives of the parameters.
  void set_covariance() {
    Eigen::Matrix<double, 5, 5> base = Eigen::Matrix<double, 5, 5>::Zero();
    Eigen::Matrix<double, 6, 5> by = Eigen::Matrix<double, 6, 5>::Zero();
    std::vector<std::pair<Eigen::Index, ParameterId>> known;
    const Model& model = result_.model;
    const auto add_law = [&](const std::optional<PowerLawFit>& law, Eigen::Index at,
                             ParameterId alpha, ParameterId beta) {
      if (!law || !law->covariance) return;
      base.block<2, 2>(at, at) = *law->covariance;
      by(at, at) = *model[alpha].value;
      by(at + 1, at + 1) = 1.0;
      known.emplace_back(at, alpha);
      if (!law->beta_at_bound) known.emplace_back(at + 1, beta);
    };
    add_law(surge_, 0, ParameterId::kSurgeAlpha, ParameterId::kSurgeBeta);
    add_law(yaw_, 2, ParameterId::kYawAlpha, ParameterId::kYawBeta);
    if (mass_ && surge_->covariance) {
      base(4, 4) = mass_->timing_variance;
      for (const auto& [row, id] : {std::pair(Eigen::Index{4}, ParameterId::kMassNorm),
                                    std::pair(Eigen::Index{5}, ParameterId::kInertiaNorm)}) {
        const double value = *model[id].value;
        by(row, 0) = value;
        by(row, 1) = value * mass_->by_beta;
        by(row, 4) = value;
        known.emplace_back(row, id);
      }
    }
    const Eigen::Matrix<double, 6, 6> full = by * base * by.transpose();
    Covariance& covariance = result_.model.covariance;
    for (const auto& [row, row_id] : known) {
      covariance.parameters.push_back(row_id);
      std::vector<double>& line = covariance.matrix.emplace_back();
      // The mean of the two halves: symmetric to the last bit.
      for (const auto& [column, column_id] : known) {
        line.push_back(0.5 * (full(row, column) + full(column, row)));
      }
    }
  }

  void keep_trials() {
    std::vector<TrialPoint>& trials = result_.model.trials;
    const auto predict = [](const std::optional<PowerLawFit>& law, double force) {
      std::optional<double> rate;
      if (law) rate = std::exp((std::log(force) - law->log_alpha) / law->beta);
      return rate;
    };
    if (data_.surge) {
      for (const SurgeRow& row : data_.surge->rows) {
        trials.push_back({"surge", data_.surge->file, row.line, row.tau_speed, row.speed_mps,
                          predict(surge_, row.tau_speed)});
      }
    }
    if (data_.turning) {
      for (const TurningRow& row : data_.turning->rows) {
        trials.push_back({"turning", data_.turning->file, row.line, row.tau_turn_m,
                          row.yaw_rate_radps, predict(yaw_, row.tau_turn_m)});
      }
    }
    if (data_.coastdown) {
      for (const StopTimeRow& row : data_.coastdown->rows) {
        std::optional<double> stop_s;
        if (mass_) {  // t_a = m' u^(1-b1)/((1-b1) a1)                               [paper (59)]
          stop_s = std::exp(mass_->log_mass_norm - surge_->log_alpha) *
                   std::pow(row.initial_speed_mps, 1.0 - surge_->beta) / (1.0 - surge_->beta);
        }
        trials.push_back({"coastdown", data_.coastdown->file, row.line, row.initial_speed_mps,
                          row.stop_time_s, stop_s});
      }
    }
  }

  std::vector<ParameterId> asked() const {
    if (!options_.asked.empty()) return options_.asked;
    std::vector<ParameterId> ids;
    if (data_.surge) ids.insert(ids.end(), {ParameterId::kSurgeAlpha, ParameterId::kSurgeBeta});
    if (data_.turning) ids.insert(ids.end(), {ParameterId::kYawAlpha, ParameterId::kYawBeta});
    if (data_.coastdown) ids.insert(ids.end(), {ParameterId::kMassNorm, ParameterId::kInertiaNorm});
    return ids;
  }

  std::string reason(ParameterId id) const {
    switch (id) {
      case ParameterId::kSurgeAlpha:
      case ParameterId::kSurgeBeta:
        if (!data_.surge) return "there is no surge trial";
        return fmt::format(
            "the usable surge rows ({}) do not hold two different tau_speed with different speeds",
            data_.surge->rows.size());
      case ParameterId::kYawAlpha:
      case ParameterId::kYawBeta:
        if (!data_.turning) return "there is no turning trial";
        return fmt::format(
            "the usable turning rows ({}) do not hold two different tau_turn with different yaw "
            "rates",
            data_.turning->rows.size());
      case ParameterId::kMassNorm:
      case ParameterId::kInertiaNorm:
        if (!data_.coastdown || data_.coastdown->rows.empty())
          return "there is no coast-down trial";
        if (!surge_)
          return "a stop time shows m' only together with a1 and b1, which are not identified";
        return fmt::format(
            "the surge exponent {:.4g} is 1 or more: with it the vehicle never stops, and "
            "a stop time says nothing",
            surge_->beta);
      case ParameterId::kSwayAlpha:
        return "sway_alpha is not in vehicle.json";
      case ParameterId::kSteeringTimeConstant:
        return "it is not in vehicle.json";
    }
    return {};
  }

  void refuse_what_is_missing() {
    const std::vector<ParameterId> ids = asked();
    for (const ParameterInfo& parameter : parameter_table()) {
      Estimate& estimate = result_.model[parameter.id];
      if (estimate.value) continue;
      estimate.source = Source::kFitted;
      estimate.method = "none";
      const bool wanted = std::find(ids.begin(), ids.end(), parameter.id) != ids.end();
      if (wanted) result_.refused.push_back(parameter.id);
      find(wanted ? Severity::kError : Severity::kNote, "", "not-identifiable",
           fmt::format("{} ({}) cannot be identified: {}; {}", parameter.name, parameter.meaning,
                       reason(parameter.id), parameter.trial));
    }
  }

  const Vehicle& vehicle_;
  const TrialData& data_;
  const IdentifyOptions& options_;
  Identification result_;
  std::optional<PowerLawFit> surge_;
  std::optional<PowerLawFit> yaw_;
  std::optional<MassFromStopTime> mass_;
};

}  // namespace

Result<Identification> identify(const Vehicle& vehicle, const TrialData& data,
                                const IdentifyOptions& options, std::vector<Finding> findings) {
  return Identifier(vehicle, data, options, std::move(findings)).run();
}

}  // namespace awmr
