#include "awmr/identify/identify.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "awmr/identify/uncertainty/joint_covariance.h"
#include "awmr/identify/logs/log_stage.h"
#include "awmr/identify/coastdown/mass.h"
#include "awmr/identify/tables/subject_fit.h"
#include "awmr/model/steady.h"

namespace awmr {
namespace {

std::vector<SteadyPoint> points_of(const std::vector<SurgeRow>& rows) {
  std::vector<SteadyPoint> points;
  for (const SurgeRow& row : rows) {
    points.push_back({row.tau_speed, row.speed_mps, row.distance_m, row.elapsed_s, row.line});
  }
  return points;
}

/// Of each F' the dead zone takes F'0, and with it the same share of tau_turn. Rows within it are
/// left out: they turned nothing.
std::vector<SteadyPoint> points_of(const std::vector<TurningRow>& rows, double dead_zone) {
  std::vector<SteadyPoint> points;
  for (const TurningRow& row : rows) {
    if (!(row.wheel_force > dead_zone)) continue;
    const double share = dead_zone > 0.0 ? 1.0 - dead_zone / row.wheel_force : 1.0;
    SteadyPoint point{share * row.tau_turn_m, row.yaw_rate_radps, {}, row.elapsed_s, row.line};
    if (row.turns) point.travel = 2.0 * std::numbers::pi * *row.turns;
    points.push_back(point);
  }
  return points;
}

/// exp(value) with the standard error of its logarithm, the interval symmetric in the logarithm.
Estimate from_log(double log_value, std::optional<double> variance, double degrees_of_freedom,
                  Source source, std::string method) {
  Estimate estimate{std::exp(log_value), {}, {}, source, std::move(method)};
  if (variance) {
    const double error = std::sqrt(*variance);
    const double half = t_quantile_95(degrees_of_freedom) * error;
    estimate.std_error = *estimate.value * error;
    estimate.ci95 = Interval{std::exp(log_value - half), std::exp(log_value + half)};
  }
  return estimate;
}

/// Collects what identify() returns, one source of evidence after the other.
class Identifier {
 public:
  Identifier(const Vehicle& vehicle, const TrialData& data, const IdentifyOptions& options,
             Method method, std::vector<Finding> findings)
      : vehicle_(vehicle), data_(data), options_(options), method_(method) {
    result_.model.vehicle = vehicle;
    result_.model.record.findings = std::move(findings);
  }

  Identification run() {
    set_given();
    fit_surge();
    fit_yaw();
    find_mass();
    fit_logs();
    result_.model.covariance = covariance_.covariance();
    keep_trials();
    refuse_what_is_missing();
    return std::move(result_);
  }

 private:
  void find(Severity severity, const std::string& file, const std::string& code,
            std::string message) {
    result_.model.record.findings.push_back({file, 0, severity, code, std::move(message)});
  }

  void take(std::vector<EstimatorReport>& reports, std::vector<Finding>& findings) {
    Model& model = result_.model;
    std::move(reports.begin(), reports.end(), std::back_inserter(model.record.reports));
    std::move(findings.begin(), findings.end(), std::back_inserter(model.record.findings));
  }

  void set_given() {
    if (vehicle_.sway_alpha) {
      result_.model[ParameterId::kSwayAlpha] = {
          vehicle_.sway_alpha, {}, {}, Source::kGiven, "vehicle"};
    }
    result_.model[ParameterId::kSteeringTimeConstant] = {
        vehicle_.steering_time_constant_s, {}, {}, Source::kGiven, "vehicle"};
    check_inertia(vehicle_, result_.model.record.findings);
  }

  SubjectOptions subject_options(const FamilyChoice& family) const {
    // Tables go by the nonlinear fit where the logs have the last word.
    const Method method = method_ == Method::kTrajectory ? table_method() : method_;
    return {method, options_.noise, family, options_.loss, options_.side_by_side};
  }

  Method table_method() const {
    const auto plain = [](const FamilyChoice& choice) { return choice.family == Family::kPower; };
    const bool log_linear_does =
        plain(options_.surge_family) && plain(options_.yaw_family) && options_.loss == Loss::kSquared;
    return log_linear_does ? Method::kLogLinear : Method::kNonlinear;
  }

  /// A fitted law becomes the main values, with its block of the covariance.
  void set_law(const Subject& subject, const SubjectFit& fit) {
    const SteadyFit& law = *fit.chosen;
    Model& model = result_.model;
    const EstimatorReport* report = nullptr;
    for (const EstimatorReport& r : fit.reports) {
      if (!fit.log_linear && r.family == name_of(fit.problem.family) && !r.parameters.empty() &&
          r.parameters.front().profile95) {
        report = &r;
      }
    }
    const std::vector<TransformedParameter> coordinates = coordinates_of(fit.problem.family);
    for (std::size_t i = 0; i < coordinates.size(); ++i) {
      std::optional<Interval> profile;
      if (report) profile = report->parameters[i].profile95;
      model[parameter_of(subject, coordinates[i])] =
          estimate_of(law, coordinates[i], profile, fit.method);
    }
    if (!terms_of(fit.problem.family).beta) {
      model[subject.beta] = {
          1.0, {}, {}, Source::kGiven, "family " + std::string(name_of(fit.problem.family))};
    }
    if (!law.has_covariance()) return;
    const Eigen::Index first = covariance_.add_block(law.covariance);
    for (std::size_t i = 0; i < law.free.size(); ++i) {
      const TransformedParameter c = law.free[i];
      covariance_.set(parameter_of(subject, c),
                      {{first + static_cast<Eigen::Index>(i), jacobian_of(c, law[c])}});
    }
    if (subject.name == FitSubject::kSurge) surge_block_ = first;
  }

  void fit_surge() {
    if (!data_.surge) return;
    Subject subject{.name = FitSubject::kSurge,
                    .families = {kFamilies.begin(), kFamilies.end()},
                    .beta_range = vehicle_.surge_beta_range,
                    .file = data_.surge->file,
                    .points = points_of(data_.surge->rows)};
    surge_ = fit_subject(subject, subject_options(options_.surge_family));
    take(surge_.reports, surge_.findings);
    if (!surge_.chosen) return;
    result_.model.surge_family = surge_.problem.family;
    set_law(subject, surge_);
  }

  void fit_yaw() {
    if (!data_.turning) return;
    const double dead_zone = *result_.model[ParameterId::kWheelDeadZone].value;
    Subject subject{.name = FitSubject::kYaw,
                    .alpha = ParameterId::kYawAlpha,
                    .beta = ParameterId::kYawBeta,
                    .coulomb = ParameterId::kYawCoulomb,
                    .quadratic = ParameterId::kYawQuadratic,
                    .families = {Family::kPower, Family::kCoulombLinear,
                                 Family::kCoulombLinearQuadratic, Family::kCoulombPower},
                    .beta_range = vehicle_.yaw_beta_range,
                    .file = data_.turning->file,
                    .points = points_of(data_.turning->rows, dead_zone)};
    FamilyChoice family = options_.yaw_family;
    // A dead zone belongs to the wheels: the surge runs show it, and the turning runs are freed of
    // it.
    if (family.family == Family::kDeadZone) family.family = Family::kPower;
    yaw_ = fit_subject(subject, subject_options(family));
    take(yaw_.reports, yaw_.findings);
    if (!yaw_.chosen) return;
    result_.model.yaw_family = yaw_.problem.family;
    set_law(subject, yaw_);
  }

  bool has_coastdown() const {
    return (data_.coastdown && !data_.coastdown->rows.empty()) || !data_.curves.empty();
  }

  void find_mass() {
    if (!has_coastdown()) return;
    mass_ = estimate_mass(surge_.chosen ? &surge_ : nullptr, data_.coastdown, data_.curves,
                          vehicle_, options_.joint);
    take(mass_.reports, mass_.findings);
    if (mass_.alone && mass_.alone->beta_variance > 0.0) set_beta_of_curve(*mass_.alone);
    if (mass_.joint) {
      set_joint(*mass_.joint);
    } else if (mass_.estimate) {
      set_mass(*mass_.estimate);
    }
  }

  void set_beta_of_curve(const CoastFit& curve) {
    const double error = std::sqrt(curve.beta_variance);
    const double half = t_quantile_95(curve.dof) * error;
    result_.model[ParameterId::kSurgeBeta] = {curve.beta, error,
                                              Interval{curve.beta - half, curve.beta + half},
                                              Source::kFitted, "coast-down curve"};
  }

  /// I'z = m' Iz / m                                                                 [paper (68)]
  void set_inertia(double log_mass, std::optional<double> variance, double dof) {
    result_.model[ParameterId::kInertiaNorm] =
        from_log(log_mass + std::log(vehicle_.inertia_kgm2() / vehicle_.mass_kg), variance, dof,
                 Source::kDerived,
                 vehicle_.yaw_inertia_kgm2 ? "m' and the given inertia" : "m' and the box formula");
  }

  void set_mass(const MassEstimate& mass) {
    const SteadyFit& surge = *surge_.chosen;
    const auto variance = mass.variance(surge);
    const double dof = variance ? mass.dof(surge) : 0.0;
    result_.model[ParameterId::kMassNorm] =
        from_log(mass.log_mass_norm, variance, dof, Source::kDerived, mass.method);
    set_inertia(mass.log_mass_norm, variance, dof);
    if (!variance) return;
    const Eigen::Index own =
        covariance_.add_block(Eigen::MatrixXd::Constant(1, 1, mass.own_variance));
    for (const ParameterId id : {ParameterId::kMassNorm, ParameterId::kInertiaNorm}) {
      const double value = *result_.model[id].value;
      JointCovariance::Gradient gradient{{own, value}};
      for (Eigen::Index i = 0; i < mass.by_surge.size(); ++i) {
        gradient[*surge_block_ + i] = value * mass.by_surge(i);
      }
      covariance_.set(id, std::move(gradient));
    }
  }

  void set_joint(const JointFit& joint) {
    Model& model = result_.model;
    const Eigen::Index first = covariance_.add_block(joint.covariance);
    const Subject surge{};  // the ids of surge
    for (std::size_t i = 0; i < joint.surge.free.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      const TransformedParameter c = joint.surge.free[i];
      const double x = joint.surge[c];
      const double error = std::sqrt(joint.covariance(at, at));
      const double half = t_quantile_95(joint.dof(at)) * error;
      model[parameter_of(surge, c)] = {value_from(c, x), jacobian_of(c, x) * error,
                                       Interval{value_from(c, x - half), value_from(c, x + half)},
                                       Source::kFitted, "joint with the coast-down curves"};
      covariance_.set(parameter_of(surge, c), {{first + at, jacobian_of(c, x)}});
    }
    const Eigen::Index last = joint.covariance.rows() - 1;
    const double variance = joint.covariance(last, last);
    model[ParameterId::kMassNorm] = from_log(joint.log_mass_norm, variance, joint.dof(last),
                                             Source::kFitted, "joint with the surge runs");
    set_inertia(joint.log_mass_norm, variance, joint.dof(last));
    for (const ParameterId id : {ParameterId::kMassNorm, ParameterId::kInertiaNorm}) {
      covariance_.set(id, {{first + last, *model[id].value}});
    }
    surge_.chosen = joint.surge;
  }

  void fit_logs() {
    if (data_.logs.empty()) return;
    LogStage stage = run_log_stage(vehicle_, data_.logs, options_, asked(), result_.model,
                                   method_ == Method::kTrajectory);
    log_reasons_ = std::move(stage.reasons);
    take(stage.reports, stage.findings);
    if (stage.block.size() == 0) return;
    const Eigen::Index first = covariance_.add_block(stage.block);
    const bool fills_surge =
        std::any_of(stage.main.begin(), stage.main.end(),
                    [](const LogStage::Main& main) { return main.id == ParameterId::kSurgeAlpha; });
    if (fills_surge) set_family_of_logs(stage.surge_family);
    for (const LogStage::Main& main : stage.main) {
      result_.model[main.id] = main.estimate;
      covariance_.set(main.id, {{first + main.place, main.jacobian}});
    }
  }

  /// Terms that the logs' family does not have are gone, whatever the tables' had.
  void set_family_of_logs(Family family) {
    Model& model = result_.model;
    model.surge_family = family;
    model.yaw_family = options_.yaw_family.family.value_or(Family::kPower);
    const Estimate none{0.0, {}, {}, Source::kGiven, "not in the family"};
    const FamilyTerms terms = terms_of(family);
    if (!terms.coulomb) model[ParameterId::kSurgeCoulomb] = none;
    if (!terms.quadratic) model[ParameterId::kSurgeQuadratic] = none;
    if (!terms.dead_zone) model[ParameterId::kWheelDeadZone] = none;
    if (!terms.beta) {
      model[ParameterId::kSurgeBeta] = {
          1.0, {}, {}, Source::kGiven, fmt::format("family {}", name_of(family))};
    }
  }

  /// u or r by the law that is in the model, and the stop time.
  std::optional<double> predicted(TrialKind kind, double input) const {
    const Model& model = result_.model;
    const auto law = [&](ParameterId alpha, ParameterId beta, ParameterId c, ParameterId q) {
      std::optional<Resistance<double>> known;
      if (model[alpha].value && model[beta].value) {
        known = Resistance<double>{.alpha = *model[alpha].value,
                                   .beta = *model[beta].value,
                                   .coulomb = *model[c].value,
                                   .quadratic = *model[q].value};
      }
      return known;
    };
    const auto surge = law(ParameterId::kSurgeAlpha, ParameterId::kSurgeBeta,
                           ParameterId::kSurgeCoulomb, ParameterId::kSurgeQuadratic);
    const auto yaw = law(ParameterId::kYawAlpha, ParameterId::kYawBeta, ParameterId::kYawCoulomb,
                         ParameterId::kYawQuadratic);
    if (kind == TrialKind::kSurge && surge) {
      return steady_rate(*surge, input - 4.0 * *model[ParameterId::kWheelDeadZone].value);
    }
    if (kind == TrialKind::kTurning && yaw) return steady_rate(*yaw, input);
    if (kind == TrialKind::kCoastdown && surge && model[ParameterId::kMassNorm].value) {
      return stop_time_s(*surge, *model[ParameterId::kMassNorm].value, input);
    }
    return std::nullopt;
  }

  void keep_trials() {
    std::vector<TrialPoint>& trials = result_.model.record.trials;
    const auto keep = [&](TrialKind kind, const std::string& file, int line, double input,
                          double measured) {
      trials.push_back({kind, file, line, input, measured, predicted(kind, input)});
    };
    if (data_.surge) {
      for (const SurgeRow& row : data_.surge->rows) {
        keep(TrialKind::kSurge, data_.surge->file, row.line, row.tau_speed, row.speed_mps);
      }
    }
    if (data_.turning) {
      const double dead_zone = *result_.model[ParameterId::kWheelDeadZone].value;
      for (const SteadyPoint& point : points_of(data_.turning->rows, dead_zone)) {
        keep(TrialKind::kTurning, data_.turning->file, point.line, point.force, point.rate);
      }
    }
    if (data_.coastdown) {
      for (const StopTimeRow& row : data_.coastdown->rows) {
        keep(TrialKind::kCoastdown, data_.coastdown->file, row.line, row.initial_speed_mps, row.stop_time_s);
      }
    }
  }

  std::vector<ParameterId> asked() const {
    if (!options_.asked.empty()) return options_.asked;
    std::vector<ParameterId> ids;
    if (data_.surge) ids.insert(ids.end(), {ParameterId::kSurgeAlpha, ParameterId::kSurgeBeta});
    if (data_.turning) ids.insert(ids.end(), {ParameterId::kYawAlpha, ParameterId::kYawBeta});
    if (data_.coastdown || !data_.curves.empty()) {
      ids.insert(ids.end(), {ParameterId::kMassNorm, ParameterId::kInertiaNorm});
    }
    if (!data_.logs.empty()) {
      for (const ParameterInfo& parameter : parameter_table()) {
        if (!parameter.term) ids.push_back(parameter.id);
      }
    }
    return ids;
  }

  std::string table_reason(ParameterId id) const {
    switch (id) {
      case ParameterId::kSurgeAlpha:
      case ParameterId::kSurgeBeta:
        if (!data_.surge) {
          return mass_.alone ? mass_.reason : std::string("there is no surge trial");
        }
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
        return has_coastdown() ? mass_.reason : std::string("there is no coast-down trial");
      case ParameterId::kSwayAlpha:
        return "sway_alpha is not in vehicle.json";
      default:
        return "it is not in vehicle.json";
    }
  }

  void refuse_what_is_missing() {
    const std::vector<ParameterId> ids = asked();
    for (const ParameterInfo& parameter : parameter_table()) {
      Estimate& estimate = result_.model[parameter.id];
      const bool wanted = std::find(ids.begin(), ids.end(), parameter.id) != ids.end();
      const auto logged = log_reasons_.find(parameter.id);
      // A given value stands, but where a log was to show it, that it does not is said.
      const bool held = estimate.value && logged != log_reasons_.end() && wanted &&
                        estimate.source == Source::kGiven;
      if (estimate.value && !held) continue;
      if (!estimate.value) {
        estimate.source = Source::kFitted;
        estimate.method = "none";
      }
      if (wanted) result_.refused.push_back(parameter.id);
      const std::string why =
          logged != log_reasons_.end() ? logged->second : table_reason(parameter.id);
      find(wanted ? Severity::kError : Severity::kNote, "", "not-identifiable",
           fmt::format(
               "{} ({}) cannot be identified: {}; {}{}", parameter.name, parameter.meaning, why,
               parameter.trial,
               held ? fmt::format(" (the given {:.4g} is kept)", *estimate.value) : std::string()));
    }
  }

  const Vehicle& vehicle_;
  const TrialData& data_;
  const IdentifyOptions& options_;
  const Method method_;
  Identification result_;
  SubjectFit surge_;
  SubjectFit yaw_;
  MassResult mass_;
  std::map<ParameterId, std::string> log_reasons_;
  JointCovariance covariance_;
  std::optional<Eigen::Index> surge_block_;
};

}  // namespace

Result<Identification> identify(const Vehicle& vehicle, const TrialData& data,
                                const IdentifyOptions& options, std::vector<Finding> findings) {
  const bool other_family =
      options.surge_family.family != Family::kPower || options.yaw_family.family != Family::kPower;
  const bool robust = options.loss != Loss::kSquared;
  if (options.method == Method::kLogLinear && (other_family || robust)) {
    return input_error("--method", fmt::format("log-linear knows the power law and squares only; "
                                               "with {} use nonlinear",
                                               other_family ? "--family" : "--loss"));
  }
  if (options.method == Method::kTrajectory && data.logs.empty()) {
    return input_error("--method", "trajectory needs a driving log (--log)");
  }
  if (options.joint && (!data.surge || data.curves.empty())) {
    return input_error("--joint", "needs a surge trial and a coast-down curve");
  }
  const Method method = options.method.value_or(!data.logs.empty()       ? Method::kTrajectory
                                                : other_family || robust ? Method::kNonlinear
                                                                         : Method::kLogLinear);
  return Identifier(vehicle, data, options, method, std::move(findings)).run();
}

}  // namespace awmr
