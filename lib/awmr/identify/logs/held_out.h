/// Test of a fit by its prediction of other rows of the log. Private to identify/.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "awmr/identify/logs/log_fit.h"
#include "awmr/identify/logs/score_test.h"

namespace awmr {

/// Part of a log.
struct LogPart {
  const std::vector<DrivingLog>& log;  ///< a single log
  Interval only_s;                     ///< time of the rows
  std::string name;                    ///< "the last fifth of log.csv"
};

/// Result of the test.
struct HeldOut {
  std::string rows;      ///< "the last fifth of log.csv"
  double p_value = 1.0;  ///< p of the hypothesis that the same values describe all rows
  std::string quantity;  ///< the quantity with the largest change in standard errors
  double by_fit = 0.0;   ///< its value
  double by_rows = 0.0;  ///< its value from these rows, by one Gauss-Newton step
};

/// Compares `rows` with the prediction of `fit`, which was fitted to other rows with these options:
///
///     d = -H^-1 S,   cov d = f^2 H^-1 + C,   X^2 = d^T (cov d)^-1 d,   chi-squared
///
/// with the information H and the score S of the rows at the fit's coordinates, after elimination
/// of the initial states and biases; the covariance C of the fit; and the largest factor f by which
/// its standard errors were widened. d is restricted to the directions that the rows determine
/// (identifiability.h). Quantities at an end of their range are fixed.
///
/// The noise is that of the fit, because noise estimated from the same rows would absorb a change
/// of the vehicle as sensor drift. Empty if the rows determine nothing or cannot be replayed.
std::optional<HeldOut> predict(const LogPart& rows, const LogFit& fit, LogFitOptions options);

/// Score-test estimates, from one log, of the delays and command errors that the fit does not free
/// (score_test.h), with all quantities of the fit free.
struct TermTest {
  FreeQuantity term;
  ScoreTest test;
};
std::vector<TermTest> test_further_terms(const std::vector<DrivingLog>& log, const LogFit& fit,
                                         const LogFitOptions& options);

}  // namespace awmr
