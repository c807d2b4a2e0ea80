/// Prediction of rows of a log by a fit of other rows. Private to identify/.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "awmr/identify/logs/log_fit.h"
#include "awmr/identify/logs/score_test.h"

namespace awmr {

/// Rows of a log.
struct LogPart {
  const std::vector<DrivingLog>& log;  ///< one
  Interval only_s;                     ///< their time
  std::string name;                    ///< "the last fifth of log.csv"
};

/// Rows that a fit has not seen, compared with its prediction.
struct HeldOut {
  std::string rows;      ///< "the last fifth of log.csv"
  double p_value = 1.0;  ///< of a change this large if one set of values made all rows
  std::string quantity;  ///< the one that changes by most of its standard errors
  double by_fit = 0.0;   ///< its value
  double by_rows = 0.0;  ///< its value in these rows, by one Gauss-Newton step
};

/// Compares rows with the prediction of `fit`, a fit of other rows with these options:
///
///     d = -H^-1 S,   cov d = f^2 H^-1 + C,   X^2 = d^T (cov d)^-1 d,   chi-squared
///
/// with information H and score S of the rows at the fit's coordinates, the initial state of each
/// window and each bias eliminated from both, the fit's covariance C and the largest factor f by which
/// its standard errors are widened. d has the directions that the rows show (identifiability.h);
/// quantities at an end of their range are held.
///
/// The noise is the fit's: noise that is estimated from the same rows takes a change of the vehicle for
/// a drift of the sensor. None where the rows show nothing or cannot be replayed.
std::optional<HeldOut> predict(const LogPart& rows, const LogFit& fit, LogFitOptions options);

/// Where one log would put the delays and errors that the fit does not free (score_test.h), with
/// all quantities of the fit free.
struct TermTest {
  FreeQuantity term;
  ScoreTest test;
};
std::vector<TermTest> test_further_terms(const std::vector<DrivingLog>& log, const LogFit& fit,
                                         const LogFitOptions& options);

}  // namespace awmr
