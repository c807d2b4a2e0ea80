/// Test whether several logs, or the two halves of one log, agree on the fitted quantities. Private
/// to identify/.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "awmr/identify/logs/checks/held_out.h"
#include "awmr/identify/logs/choice/family_fit.h"

namespace awmr {

/// A quantity whose estimates from single logs differ significantly.
struct LogDisagreement {
  std::string name;
  double p_value = 1.0;  ///< p value of the hypothesis that the value is the same in all logs
  /// Files of the logs that determine the quantity, each on its own.
  std::vector<std::string> files;
  std::vector<double> values;  ///< estimate from each of these logs
  bool withdraws = false;      ///< true: all intervals of the common fit are invalid
  /// True: the quantity gets no value, because its widened interval is too wide.
  bool refuses = false;
  /// Part of the widened standard error (of a logarithm for m' and I'z) that comes from the variance
  /// between logs.
  double spread = 0.0;
  bool is_widened = false;  ///< false: the interval was withdrawn before
  /// I'z if the logs disagree on m' only, and the reverse: its interval is widened by `spread` too.
  std::optional<std::string> partner = {};
};

/// Result of compare_logs().
struct LogComparison {
  std::vector<LogDisagreement> disagreements;
  /// Test of a fit of the first half of a single log on its last fifth. Present only if the last
  /// fifth contradicts this fit, although the two halves of the log agree.
  std::optional<HeldOut> missed;
};

/// Fits every log on its own, starting at the optimum of `common`, the fit of all logs together.
/// Then compares the values of each quantity. x_l is the value (or its logarithm) from log l of L
/// logs, and w_l = 1/var(x_l) its weight. `mean` is the weighted mean:
///
///     Q = sum w_l (x_l - mean)^2,   chi-squared with L - 1 degrees of freedom if the logs agree,
///     tau^2 = (Q - (L - 1)) / (sum w - sum w^2 / sum w)                    (DerSimonian and Laird)
///
/// tau^2 is the variance between logs. The logs disagree on a quantity if p < 0.001 divided by the
/// number of quantities (Bonferroni). The standard error of the common fit is then raised to at
/// least that of the mean, which includes tau^2. The interval then covers the mean over such logs,
/// not an individual log. A quantity gets no value if its raised standard error exceeds kUnknown
/// (identifiability.h). Sensor biases are not compared, because they may differ between logs. A
/// change of the load or of F_max (battery) changes both m' and I'z. If the logs disagree on one of
/// them, tau^2 therefore also enters the interval of the other.
///
/// The common fit may lack a delay or command error that differs between the logs, for example
/// because someone changed the steering trim. A score test (score_test.h) therefore estimates each
/// missing term from every log, without a new fit. If the estimates of a term differ by more than
/// three standard errors, every log is fitted with this term (with the term that differs most, if
/// there are several).
///
/// A disagreement of several logs on one of these terms makes all intervals of the common fit
/// invalid, because the other quantities absorb the effect of the term:
///   - the term that was fitted in addition;
///   - errors of the commands in the common fit: trim, dead band, asymmetry, curve and scale of the
///     steering; imbalance, saturation and exponent of the forces, difference of the dead zones;
///   - forces of extra_forces.h in the common fit, except Stribeck friction.
///
/// A single log of 20 s or more is tested by its parts: a fit of its first half predicts its second
/// half and its last fifth (held_out.h). If the measurements agree with both predictions (p >
/// 0.05), there is no disagreement. If they contradict one, the halves are compared like two logs,
/// with two exceptions: there is no search for missing terms, and a disagreement on one quantity
/// makes the intervals of no further quantity invalid. The halves may agree although predict() and
/// likelihood_ratio_test() both find (p < 0.001) that the fit of the first half does not describe
/// the last fifth. `missed` then contains the result, with the p value of likelihood_ratio_test().
/// If that test is not possible, or the fit has a model error (LogFit::has_model_error()),
/// predict() alone decides.
LogComparison compare_logs(const std::vector<DrivingLog>& logs, FamilyFit& common);

}  // namespace awmr
