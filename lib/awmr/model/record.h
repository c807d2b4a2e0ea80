/// Record of an identification: the findings, the result of each estimator and the trials used.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "awmr/core/interval.h"
#include "awmr/core/name_table.h"
#include "awmr/core/provenance.h"

namespace awmr {

/// Severity of a finding.
enum class Severity {
  kNote,     ///< information, for example about excluded rows or a choice that was made
  kWarning,  ///< doubtful: the result can be wrong
  kError,    ///< a request could not be fulfilled
};
inline constexpr NameTable<Severity, 3> kSeverityNames{
    {{"note", Severity::kNote}, {"warning", Severity::kWarning}, {"error", Severity::kError}}};

/// A message to the user about the data or the result.
struct Finding {
  std::string file;  ///< empty if it does not refer to a file
  int line = 0;      ///< 0 if it does not refer to a line
  Severity severity = Severity::kWarning;
  std::string code;  ///< "speed-mismatch", "not-identifiable", ...: stable, for scripts
  std::string message;
};

/// Kinds of trial; the first three are tables, the last is a time series.
enum class TrialKind { kSurge, kTurning, kCoastdown, kLog };
inline constexpr NameTable<TrialKind, 4> kTrialKindNames{{{"surge", TrialKind::kSurge},
                                                          {"turning", TrialKind::kTurning},
                                                          {"coastdown", TrialKind::kCoastdown},
                                                          {"log", TrialKind::kLog}}};

/// The quantity that a fit estimates: surge resistance g1, yaw resistance g3, mass m', or, from
/// logs, the whole model.
enum class FitSubject { kSurge, kYaw, kMass, kLog };
inline constexpr NameTable<FitSubject, 4> kFitSubjectNames{{{"surge", FitSubject::kSurge},
                                                            {"yaw", FitSubject::kYaw},
                                                            {"mass", FitSubject::kMass},
                                                            {"log", FitSubject::kLog}}};

/// Estimation methods. Several methods are applied to the same trials, so that the user can compare
/// their results.
enum class Estimator {
  kLogLinear,   ///< tables: a line through log force over log speed, as in the paper
  kNonlinear,   ///< tables: nonlinear least squares
  kStopTime,    ///< mass: from the stop times of coast-downs
  kCurve,       ///< mass: from whole coast-down curves
  kCombined,    ///< mass: weighted mean of stop time and curve
  kJoint,       ///< surge law and mass together
  kTrajectory,  ///< logs: the simulated model, driven by the logged commands
};
inline constexpr NameTable<Estimator, 7> kEstimatorNames{{{"log-linear", Estimator::kLogLinear},
                                                          {"nonlinear", Estimator::kNonlinear},
                                                          {"stop-time", Estimator::kStopTime},
                                                          {"curve", Estimator::kCurve},
                                                          {"combined", Estimator::kCombined},
                                                          {"joint", Estimator::kJoint},
                                                          {"trajectory", Estimator::kTrajectory}}};

/// A parameter as estimated by one estimator.
struct EstimatorParameter {
  std::string name;  ///< "surge.alpha"
  double value = 0.0;
  std::optional<double> std_error;  ///< > 0; absent if there are too few data
  std::optional<Interval> ci95;     ///< 95 % interval from the curvature of the cost at its minimum
  /// 95 % interval from the profile likelihood: the cost as a function of this parameter, minimised
  /// over the other parameters. The interval can be asymmetric about the value. If the data do not
  /// limit the parameter on one side, the end of the interval on this side is the bound of the
  /// parameter's range.
  std::optional<Interval> profile95 = {};
};

/// A statistical test of an assumption that a fit makes about its residuals.
struct Diagnostic {
  std::string name;  ///< "normality", "whiteness of yaw_rate_radps", "lack of fit"
  double statistic = 0.0;
  double p_value = 1.0;  ///< in [0, 1]: small if the assumption is doubtful
  std::string meaning;   ///< what a small p-value means for the fit, in one sentence
};

/// The estimates of a fit without one row of its table.
struct LeaveOneOut {
  std::string file;
  int line = 0;                ///< 0 (only in files of older versions): a whole log was left out
  std::vector<double> values;  ///< in the order of EstimatorReport::parameters
};

/// One initial guess of a multistart search, and how the search from it ended.
struct SearchStart {
  std::vector<double> values;  ///< the guess, in the order of EstimatorReport::parameters
  /// Cost at the end of the search: half the sum of squared standardised residuals.
  double cost = 0.0;
  bool chosen = false;  ///< true: the estimates are the end of this search
  std::string stop_reason;
};

/// The result of one estimator for one set of trials: an entry of /estimates.
struct EstimatorReport {
  FitSubject subject = FitSubject::kSurge;
  Estimator estimator = Estimator::kLogLinear;
  std::string noise;  ///< noisy quantity: "log force", "force", "speed", "time", ...
  std::vector<EstimatorParameter> parameters;
  double residual_std = 0.0;      ///< of the residuals, in the unit of the noisy quantity; logs: 1
  int rows_used = 0;              ///< number of rows; logs: of measurements of all channels
  int degrees_of_freedom = 0;     ///< rows_used minus unknowns; 0: not computed
  int rank = 0;                   ///< number of parameter combinations that the data determine
  double condition_number = 0.0;  ///< of the Jacobian, >= 1 or infinite; 0: not computed
  std::string stop_reason;        ///< reason why the solver stopped
  std::string family = {};        ///< family of resistance; empty: the paper's power law
  /// Weight, in (0, 1], of this report in the average over noise models: the probability that
  /// `noise` is the quantity with the noise. Absent: the estimates were not averaged.
  std::optional<double> weight = {};
  /// Akaike information criterion: misfit plus a penalty for each parameter, lower is better. AICc,
  /// corrected for few data, for tables and coast-downs; AIC for logs, with the noise model of the
  /// chosen fit. Compare only reports of the same subject and `noise`.
  std::optional<double> aicc = {};
  std::vector<Diagnostic> diagnostics = {};
  std::vector<LeaveOneOut> leave_one_out = {};
  std::vector<SearchStart> starts = {};
};

/// One row of a trial table as the fit used it. Stored in the model, so that `validate` and other
/// later steps do not need the CSV file.
struct TrialPoint {
  TrialKind kind = TrialKind::kSurge;  ///< not kLog
  std::string file;
  int line = 0;
  /// Input of the run. Surge: the force tau_speed; turning: the yaw moment tau_turn, divided by
  /// F_max, in m; coastdown: initial speed in m/s.
  double input = 0.0;
  /// Result of the run. Surge: speed in m/s; turning: yaw rate in rad/s; coastdown: stop time in s.
  double measured = 0.0;
  std::optional<double> predicted;  ///< by the model's values, in the unit of `measured`
};

/// Record of an identification: results of all estimators, findings, and the provenance.
struct IdentificationRecord {
  std::vector<EstimatorReport> reports;
  std::vector<Finding> findings;
  std::vector<TrialPoint> trials;
  /// The largest yaw rate in the logs to which g3 was fitted, rad/s, > 0; absent if g3 was not
  /// fitted to logs.
  std::optional<double> logged_yaw_rate_radps;
  Provenance provenance;
};

}  // namespace awmr
