/// How a model was identified: findings, what each estimator made of the data, the trials as used.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "awmr/core/interval.h"
#include "awmr/core/name_table.h"
#include "awmr/core/provenance.h"

namespace awmr {

/// How much a finding matters.
enum class Severity {
  kNote,     ///< worth knowing: rows set aside, a choice that was made
  kWarning,  ///< doubtful: the result may be off
  kError,    ///< something that was asked for could not be done
};
inline constexpr NameTable<Severity, 3> kSeverityNames{
    {{"note", Severity::kNote}, {"warning", Severity::kWarning}, {"error", Severity::kError}}};

/// Something the user should know about the data or the result.
struct Finding {
  std::string file;  ///< empty where it is about no file
  int line = 0;      ///< 0 where it is about no line
  Severity severity = Severity::kWarning;
  std::string code;  ///< "speed-mismatch", "not-identifiable", ...: stable, for scripts
  std::string message;
};

/// What a trial records; the first three as tables, the last as a time series.
enum class TrialKind { kSurge, kTurning, kCoastdown, kLog };
inline constexpr NameTable<TrialKind, 4> kTrialKindNames{{{"surge", TrialKind::kSurge},
                                                          {"turning", TrialKind::kTurning},
                                                          {"coastdown", TrialKind::kCoastdown},
                                                          {"log", TrialKind::kLog}}};

/// What a fit is of: a resistance, the mass, or the whole model at once.
enum class FitSubject { kSurge, kYaw, kMass, kLog };
inline constexpr NameTable<FitSubject, 4> kFitSubjectNames{{{"surge", FitSubject::kSurge},
                                                            {"yaw", FitSubject::kYaw},
                                                            {"mass", FitSubject::kMass},
                                                            {"log", FitSubject::kLog}}};

/// The estimators that are set side by side.
enum class Estimator {
  kLogLinear,   ///< tables: a line through the logarithms, the paper's
  kNonlinear,   ///< tables: nonlinear least squares
  kStopTime,    ///< mass: the time to rest
  kCurve,       ///< mass: a whole coast-down curve
  kCombined,    ///< mass: both, weighted
  kJoint,       ///< surge law and mass together
  kTrajectory,  ///< logs: the whole model driven by the logged commands
};
inline constexpr NameTable<Estimator, 7> kEstimatorNames{{{"log-linear", Estimator::kLogLinear},
                                                          {"nonlinear", Estimator::kNonlinear},
                                                          {"stop-time", Estimator::kStopTime},
                                                          {"curve", Estimator::kCurve},
                                                          {"combined", Estimator::kCombined},
                                                          {"joint", Estimator::kJoint},
                                                          {"trajectory", Estimator::kTrajectory}}};

/// A parameter as one estimator saw it.
struct EstimatorParameter {
  std::string name;  ///< "surge.alpha"
  double value = 0.0;
  std::optional<double> std_error;  ///< > 0; absent where there are too few data
  std::optional<Interval> ci95;     ///< 95 % interval from the curvature of the cost at its minimum
  /// 95 % interval from the profile of the cost. It need not be symmetric; an end that the data
  /// leave open is the parameter's bound.
  std::optional<Interval> profile95 = {};
};

/// A test of what a fit assumes of its residuals.
struct Diagnostic {
  std::string name;  ///< "normality", "whiteness of yaw_rate_radps", "lack of fit"
  double statistic = 0.0;
  double p_value = 1.0;  ///< in [0, 1]: small where the assumption is doubtful
  std::string meaning;   ///< what follows from it, in one sentence
};

/// The estimates from all data but one row of a table, or one log.
struct LeaveOneOut {
  std::string file;
  int line = 0;                ///< 0: the whole file
  std::vector<double> values;  ///< as EstimatorReport::parameters
};

/// One initial guess of a multistart search, and where the search from it ended.
struct SearchStart {
  std::vector<double> values;  ///< as EstimatorReport::parameters
  double cost = 0.0;           ///< after the search, half the sum of squared standardised residuals
  bool chosen = false;
  std::string stop_reason;
};

/// What one estimator made of one set of trials: an entry of /estimates.
struct EstimatorReport {
  FitSubject subject = FitSubject::kSurge;
  Estimator estimator = Estimator::kLogLinear;
  std::string noise;  ///< where the error is put: "log force", "force", "speed", "time", ...
  std::vector<EstimatorParameter> parameters;
  double residual_std = 0.0;      ///< in the unit of the noise
  int rows_used = 0;              ///< of the tables or logs
  int degrees_of_freedom = 0;     ///< of the residuals: rows less parameters
  int rank = 0;                   ///< of the problem: how many combinations the data show
  double condition_number = 0.0;  ///< of the problem, >= 1; infinite where the rank is lacking
  std::string stop_reason;        ///< why the solver ended
  std::string family = {};        ///< of resistance; empty: the paper's power law
  /// Probability that the errors lie where this estimator puts them, (0, 1]; absent: not averaged.
  std::optional<double> weight = {};
  std::optional<double> aicc = {};  ///< corrected Akaike criterion; less is better, same noise only
  std::vector<Diagnostic> diagnostics = {};
  std::vector<LeaveOneOut> leave_one_out = {};
  std::vector<SearchStart> starts = {};
};

/// One row of a trial as it was used. The model keeps it so that later steps need no CSV.
struct TrialPoint {
  TrialKind kind = TrialKind::kSurge;  ///< of a table
  std::string file;
  int line = 0;
  /// surge: tau_speed; turning: tau_turn in m; coastdown: initial speed in m/s
  double input = 0.0;
  /// surge: speed in m/s; turning: yaw rate in rad/s; coastdown: stop time in s
  double measured = 0.0;
  std::optional<double> predicted;  ///< by the main model, in the unit of `measured`
};

/// How a model was identified: what every estimator made of the data, what is doubtful, and where
/// it all comes from.
struct IdentificationRecord {
  std::vector<EstimatorReport> reports;
  std::vector<Finding> findings;
  std::vector<TrialPoint> trials;
  /// The fastest turn in the logs that g3 was fitted to, rad/s, > 0; absent where it was not fitted to
  /// logs.
  std::optional<double> logged_yaw_rate_radps;
  Provenance provenance;
};

}  // namespace awmr
