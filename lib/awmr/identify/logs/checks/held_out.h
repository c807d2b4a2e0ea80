/// Test of a log fit by rows that the fit has not used. Private to identify/.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "awmr/identify/logs/log_fit.h"
#include "awmr/identify/logs/problem/score_test.h"

namespace awmr {

/// Rows of a log within a time interval.
struct LogPart {
  const std::vector<DrivingLog>& log;  ///< list with exactly one log
  Interval only_s;                     ///< time interval of the rows, s
  std::string name;  ///< name in messages, for example "the last fifth of log.csv"
};

/// Result of predict().
struct HeldOut {
  std::string rows;      ///< name of the tested rows, for example "the last fifth of log.csv"
  double p_value = 1.0;  ///< p value of the hypothesis that the fit describes these rows
  std::string quantity;  ///< the quantity that changes most, in standard errors
  double by_fit = 0.0;   ///< value of that quantity in the fit
  double by_rows = 0.0;  ///< value of that quantity estimated from the tested rows
};

/// Tests whether `rows` agree with `fit`, a fit of other rows with these options. The test follows
/// the change d of the fitted coordinates (values or logarithms) in one Gauss-Newton step towards a
/// fit of `rows`. X^2 is the test statistic:
///
///     d = -H^-1 S,   cov d = f^2 H^-1 + C,   X^2 = d^T (cov d)^-1 d,   chi-squared
///
/// H and S are the information and the score of the tested rows: curvature and gradient of -ln L
/// with respect to the coordinates, at the fit's coordinates, after elimination of the initial
/// states and biases. C is the covariance of the fit. f is the largest factor by which the scatter
/// between parts of the logs raised a standard error of the fit. The test compares only those
/// directions (combinations of coordinates) that the rows determine (identifiability.h). It keeps a
/// quantity fixed if its value in the fit is an end of its range.
///
/// The noise levels are those of the fit. (Noise levels estimated from the tested rows would absorb
/// a change of the vehicle as sensor drift.) Returns empty if the rows determine no direction or if
/// their simulation is not finite.
std::optional<HeldOut> predict(const LogPart& rows, const LogFit& fit, LogFitOptions options);

/// Likelihood-ratio test of the same hypothesis, without the linearisation of predict(). Far from
/// the optimum of the tested rows, one Gauss-Newton step can be wrong by any amount: a fit of rows
/// that hardly determine the friction of a turn may predict that the vehicle stands while it turns.
/// L_1, L_2 are the likelihoods of the rows of `fit` and of the tested rows, with coordinates of
/// their own or common ones, and the noise levels of `fit`:
///
///     X^2 = 2/f^2 (max ln L_1 + max ln L_2 - max ln (L_1 L_2)),   chi-squared
///
/// with one degree of freedom for each compared coordinate. `fitted`: the rows of `fit`. `common`:
/// coordinates of a fit of all rows, from which the searches start too. Returns the p value; empty
/// if the tested rows cannot be fitted.
std::optional<double> likelihood_ratio_test(const LogPart& fitted, const LogPart& rows,
                                            const LogFit& fit, const std::vector<double>& common,
                                            LogFitOptions options);

/// A delay or command error that a fit does not contain, with its score test (score_test.h).
struct TermTest {
  FreeQuantity term;
  ScoreTest test;
};
/// Score tests of all delays and command errors that `fit` does not contain, on the rows of one
/// log.
std::vector<TermTest> test_further_terms(const std::vector<DrivingLog>& log, const LogFit& fit,
                                         const LogFitOptions& options);

}  // namespace awmr
