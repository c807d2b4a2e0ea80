#include "awmr/identify/tables/subject_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "awmr/identify/uncertainty/diagnostics.h"

namespace awmr {
namespace {

/// Another family is plainly better from this difference of AICc on: the power law then has less
/// than e^-5 of its support.
constexpr double kPlainlyBetter = 10.0;
constexpr double kOutlierLevel = 0.05;  ///< for the whole table (Bonferroni)
/// A row is influential where leaving it out moves a parameter by this many standard errors.
constexpr double kInfluential = 1.0;

std::string noise_name(ErrorModel noise) {
  switch (noise) {
    case ErrorModel::kForce:
      return "force";
    case ErrorModel::kSpeed:
      return "speed";
    case ErrorModel::kTime:
      return "time";
    case ErrorModel::kLogForce:
      return "log force";
  }
  return {};
}

std::string loss_name(Loss loss) {
  switch (loss) {
    case Loss::kSquared:
      return "squares";
    case Loss::kHuber:
      return "Huber";
    case Loss::kCauchy:
      return "Cauchy";
    case Loss::kTukey:
      return "Tukey";
  }
  return {};
}

/// A curve needs two different forces: repeats of one show scatter, no shape.
bool has_two_forces(const std::vector<SteadyPoint>& points) {
  constexpr double kSame = 1e-9;
  return std::any_of(points.begin(), points.end(), [&](const SteadyPoint& p) {
    return std::abs(p.force - points.front().force) > kSame * points.front().force;
  });
}

bool all_timed(const std::vector<SteadyPoint>& points) {
  return std::all_of(points.begin(), points.end(),
                     [](const SteadyPoint& p) { return p.travel && p.elapsed_s; });
}

EstimatorReport report_of(const Subject& subject, const SteadyFit& fit, Family family,
                          Estimator estimator, const std::string& noise) {
  EstimatorReport report;
  report.subject = subject.name;
  report.estimator = estimator;
  report.noise = noise;
  report.family = name_of(family);
  for (const TransformedParameter c : coordinates_of(family)) {
    const Estimate estimate = estimate_of(fit, c, {}, std::string(name_in(kEstimatorNames, estimator)));
    report.parameters.push_back({std::string(info(parameter_of(subject, c)).name), *estimate.value,
                                 estimate.std_error, estimate.ci95});
  }
  report.residual_std = fit.residual_std;
  report.rows_used = static_cast<int>(subject.points.size());
  report.degrees_of_freedom = fit.degrees_of_freedom;
  report.rank = fit.rank;
  report.condition_number = fit.condition_number;
  report.stop_reason = fit.stop_reason;
  return report;
}

/// The coordinate's 95 % ends in the parameter's own scale.
Interval scaled(TransformedParameter c, const Interval& coordinate) {
  return {value_from(c, coordinate.lo), value_from(c, coordinate.hi)};
}

/// Works on one subject: fit_subject() in steps.
class SubjectFitter {
 public:
  SubjectFitter(const Subject& subject, const SubjectOptions& options)
      : subject_(subject), options_(options) {}

  SubjectFit run() {
    if (!has_two_forces(subject_.points)) return std::move(result_);
    const SteadyFit line = fit_log_linear(subject_.points);
    if (!line.usable) return std::move(result_);
    result_.reports.push_back(report_of(subject_, line, Family::kPower, Estimator::kLogLinear, "log force"));
    wanted_ = options_.noise.value_or(all_timed(subject_.points) ? ErrorModel::kTime : ErrorModel::kSpeed);
    if (options_.method != Method::kLogLinear && wanted_ == ErrorModel::kTime &&
        !all_timed(subject_.points)) {
      find(Severity::kError, 0, "not-timed",
           "--noise time needs a distance or turns and elapsed_s in every row");
      return std::move(result_);
    }
    fit_all(line);
    choose(line);
    if (!result_.chosen) return std::move(result_);
    check_bounds();
    if (!options_.side_by_side) return std::move(result_);
    judge_residuals();
    leave_one_out();
    judge_power_law();
    return std::move(result_);
  }

 private:
  /// A fit and where its report stands.
  struct Candidate {
    Family family;
    ErrorModel noise;
    SteadyFit fit;
    std::size_t report;
  };

  void find(Severity severity, int line, const std::string& code, std::string message) {
    result_.findings.push_back({subject_.file, line, severity, code, std::move(message)});
  }

  SteadyProblem problem(Family family, ErrorModel noise) const {
    return {subject_.points, family, noise, options_.loss, subject_.beta_range};
  }

  void add_candidate(Family family, ErrorModel noise, const SteadyFit& line) {
    const SteadyProblem p = problem(family, noise);
    if (subject_.points.size() < coordinates_of(family).size()) return;
    SteadyFit fit = family == Family::kPower ? fit_steady(p, line.theta) : fit_steady(p);
    EstimatorReport report = report_of(subject_, fit, family, Estimator::kNonlinear, noise_name(noise));
    if (options_.loss != Loss::kSquared) report.noise += ", " + loss_name(options_.loss);
    report.aicc = options_.loss == Loss::kSquared ? aicc(fit) : std::nullopt;
    if (noise == wanted_ && options_.loss == Loss::kSquared && fit.has_covariance() && fit.usable) {
      for (std::size_t i = 0; i < report.parameters.size(); ++i) {
        const TransformedParameter c = coordinates_of(family)[i];
        if (!fit.std_error(c)) continue;
        report.parameters[i].profile95 = scaled(c, profile_interval(p, fit, c));
      }
    }
    candidates_.push_back({family, noise, std::move(fit), result_.reports.size()});
    result_.reports.push_back(std::move(report));
  }

  /// The power law under every noise model, the other families under the wanted one.
  void fit_all(const SteadyFit& line) {
    if (!options_.side_by_side) {
      if (options_.method == Method::kLogLinear) return;
      if (options_.family.family) {
        add_candidate(*options_.family.family, wanted_, line);
      } else {
        for (const Family family : subject_.families) add_candidate(family, wanted_, line);
      }
      return;
    }
    for (const ErrorModel noise : {ErrorModel::kForce, ErrorModel::kSpeed, ErrorModel::kTime}) {
      if (noise == ErrorModel::kTime && !all_timed(subject_.points)) continue;
      add_candidate(Family::kPower, noise, line);
    }
    for (const Family family : subject_.families) {
      if (family != Family::kPower) add_candidate(family, wanted_, line);
    }
  }

  const Candidate* candidate(Family family) const {
    for (const Candidate& c : candidates_) {
      if (c.family == family && c.noise == wanted_) return &c;
    }
    return nullptr;
  }

  /// Least AICc among the fits that converged; the family with fewer terms where two are equal.
  const Candidate* best() const {
    const Candidate* best = nullptr;
    for (const Candidate& c : candidates_) {
      if (c.noise != wanted_ || !c.fit.usable || !aicc(c.fit)) continue;
      if (!best || *aicc(c.fit) < *aicc(best->fit)) best = &c;
    }
    return best;
  }

  void choose(const SteadyFit& line) {
    if (options_.method == Method::kLogLinear) {
      result_.chosen = line;
      result_.problem = problem(Family::kPower, ErrorModel::kLogForce);
      result_.log_linear = true;
      result_.method = "log-linear";
      chosen_report_ = 0;
      if (all_timed(subject_.points)) {
        find(Severity::kNote, 0, "noise-model",
             "the runs were timed, but log-linear least squares puts the error on the force: its "
             "intervals do not hold for errors of timing; --method nonlinear --noise time does");
      }
      return;
    }
    const Candidate* chosen = options_.family.family ? candidate(*options_.family.family) : best();
    if (!chosen) {
      find(Severity::kError, 0, "too-few-rows",
           fmt::format("{} rows are too few for the family asked for", subject_.points.size()));
      return;
    }
    result_.method = fmt::format("nonlinear, noise on {}", noise_name(wanted_));
    if (chosen->family != Family::kPower) {
      result_.method += fmt::format(", {}", name_of(chosen->family));
    }
    if (options_.loss != Loss::kSquared) result_.method += ", " + loss_name(options_.loss);
    if (!chosen->fit.usable) {
      find(Severity::kError, 0, "not-converged",
           fmt::format("the {} fit of {} did not converge: {}", result_.method, name_in(kFitSubjectNames, subject_.name),
                       chosen->fit.stop_reason));
      return;
    }
    result_.chosen = chosen->fit;
    result_.problem = problem(chosen->family, wanted_);
    chosen_report_ = chosen->report;
  }

  void check_bounds() {
    const SteadyFit& fit = *result_.chosen;
    if (fit.degrees_of_freedom == 0) {
      find(
          Severity::kWarning, 0, "no-degrees-of-freedom",
          fmt::format("{} rows fix the {} parameters of {} exactly and leave nothing to judge them "
                      "by: no standard error; record another run",
                      subject_.points.size(), fit.free.size(), name_in(kFitSubjectNames, subject_.name)));
    }
    const Interval& range = subject_.beta_range;
    const double beta = fit[TransformedParameter::kBeta];
    const bool fitted = terms_of(result_.problem.family).beta;
    const bool held = fit.held_by_bound(TransformedParameter::kBeta);
    if (fitted && (held || !range.contains(beta))) {
      find(
          Severity::kWarning, 0, "exponent-at-bound",
          fmt::format("the exponent {} = {:.4g} is {} the accepted range [{:g}, {:g}]: a power law "
                      "of this range may not describe these runs",
                      info(subject_.beta).name, beta, held ? "at the end of" : "outside", range.lo,
                      range.hi));
    }
    for (const TransformedParameter c : fit.at_bound) {
      if (c == TransformedParameter::kBeta) continue;
      find(Severity::kNote, 0, "term-at-zero",
           fmt::format("{} came out as 0, the end of its range: these runs do not need this term",
                       info(parameter_of(subject_, c)).name));
    }
  }

  void judge_residuals() {
    const SteadyFit& fit = *result_.chosen;
    if (fit.degrees_of_freedom < 1) return;
    EstimatorReport& report = result_.reports[chosen_report_];
    const std::span<const double> residuals(fit.residuals.data(),
                                            static_cast<std::size_t>(fit.residuals.size()));
    for (const auto& test :
         {normality(residuals), curvature(subject_.points, fit.residuals),
          lack_of_fit(subject_.points, fit.residuals, static_cast<int>(fit.free.size()))}) {
      if (test) report.diagnostics.push_back(*test);
    }
    const Eigen::VectorXd t = studentised(fit);
    for (Eigen::Index i = 0; i < t.size(); ++i) {
      const boost::math::students_t distribution(fit.degrees_of_freedom - 1);
      const double p = 2.0 *
                       boost::math::cdf(boost::math::complement(distribution, std::abs(t(i)))) *
                       static_cast<double>(t.size());
      if (p > kOutlierLevel) continue;
      const SteadyPoint& point = subject_.points[static_cast<std::size_t>(i)];
      find(Severity::kWarning, point.line, "outlier",
           fmt::format(
               "this run lies {:.1f} standard deviations off the curve of the others (chance "
               "of one such run in {}: {:.2g}); check it, or use a robust loss (--loss huber)",
               std::abs(t(i)), t.size(), p));
    }
  }

  SteadyFit refit_without(std::size_t row) const {
    std::vector<SteadyPoint> points = subject_.points;
    points.erase(points.begin() + static_cast<std::ptrdiff_t>(row));
    if (!has_two_forces(points)) return {};
    if (result_.log_linear) return fit_log_linear(points);
    SteadyProblem p = result_.problem;
    p.points = std::move(points);
    return fit_steady(p, result_.chosen->theta);
  }

  void leave_one_out() {
    const SteadyFit& fit = *result_.chosen;
    if (fit.degrees_of_freedom < 2) return;
    for (std::size_t i = 0; i < subject_.points.size(); ++i) {
      const SteadyFit without = refit_without(i);
      if (!without.usable) continue;
      LeaveOneOut entry{subject_.file, subject_.points[i].line, {}};
      std::string moved;
      for (const TransformedParameter c : coordinates_of(result_.problem.family)) {
        entry.values.push_back(value_from(c, without[c]));
        const auto error = fit.std_error(c);
        if (!error || std::abs(without[c] - fit[c]) <= kInfluential * *error) continue;
        moved += fmt::format("{}{} becomes {:.4g} (from {:.4g})", moved.empty() ? "" : ", ",
                             info(parameter_of(subject_, c)).name, entry.values.back(),
                             value_from(c, fit[c]));
      }
      if (!moved.empty()) {
        find(Severity::kNote, entry.line, "influential-row", "without this run, " + moved);
      }
      result_.reports[chosen_report_].leave_one_out.push_back(std::move(entry));
    }
  }

  void judge_power_law() {
    if (options_.loss != Loss::kSquared) return;
    const Candidate* power = candidate(Family::kPower);
    const Candidate* least = best();
    if (!power || !least || !aicc(power->fit) || least->family == Family::kPower) return;
    const double difference = *aicc(power->fit) - *aicc(least->fit);
    if (difference < kPlainlyBetter) return;
    const bool used = result_.problem.family == Family::kPower;
    find(used ? Severity::kWarning : Severity::kNote, 0, "power-law-inadequate",
         fmt::format(
             "a power law does not describe these runs: {} is better by {:.1f} of AICc "
             "(residuals of {:.3g} against {:.3g}){}",
             name_of(least->family), difference, least->fit.residual_std, power->fit.residual_std,
             used ? fmt::format("; use --family {}", name_of(least->family)) : std::string()));
  }

  const Subject& subject_;
  const SubjectOptions& options_;
  ErrorModel wanted_ = ErrorModel::kSpeed;
  SubjectFit result_;
  std::vector<Candidate> candidates_;
  std::size_t chosen_report_ = 0;
};

}  // namespace

SubjectFit fit_subject(const Subject& subject, const SubjectOptions& options) {
  return SubjectFitter(subject, options).run();
}

ParameterId parameter_of(const Subject& subject, TransformedParameter c) {
  switch (c) {
    case TransformedParameter::kLogAlpha:
      return subject.alpha;
    case TransformedParameter::kBeta:
      return subject.beta;
    case TransformedParameter::kCoulomb:
      return subject.coulomb;
    case TransformedParameter::kQuadratic:
      return subject.quadratic;
    case TransformedParameter::kDeadZone:
      return ParameterId::kWheelDeadZone;
  }
  return subject.alpha;
}

double value_from(TransformedParameter c, double coordinate) {
  if (c == TransformedParameter::kLogAlpha) return std::exp(coordinate);
  if (c == TransformedParameter::kDeadZone) return coordinate / 4.0;
  return coordinate;
}

double jacobian_of(TransformedParameter c, double coordinate) {
  if (c == TransformedParameter::kLogAlpha) return std::exp(coordinate);
  return c == TransformedParameter::kDeadZone ? 0.25 : 1.0;
}

Estimate estimate_of(const SteadyFit& fit, TransformedParameter c, const std::optional<Interval>& interval,
                     const std::string& method) {
  Estimate estimate{value_from(c, fit[c]), {}, {}, Source::kFitted, method};
  const auto error = fit.std_error(c);
  if (!error) return estimate;
  estimate.std_error = jacobian_of(c, fit[c]) * *error;
  const double half = t_quantile_95(fit.degrees_of_freedom) * *error;
  estimate.ci95 = interval ? *interval : scaled(c, {fit[c] - half, fit[c] + half});
  return estimate;
}

}  // namespace awmr
