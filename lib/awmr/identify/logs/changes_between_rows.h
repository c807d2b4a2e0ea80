/// Logs whose commands change between two rows, at a time that the log does not show. Private to
/// identify/.
#pragma once

#include <string>
#include <vector>

#include "awmr/identify/logs/family_fit.h"
#include "awmr/identify/logs/log_problem.h"
#include "awmr/identify/options.h"

namespace awmr {

/// True if the commands probably change between rows. Compares -2 ln L of the marginal likelihood
/// with an uncertain time for every change (changes_before_rows()) and with changes at the rows:
/// the first has to be lower by more than 20 plus 2 per change. The likeliest times also have to be
/// between the rows (are_times_between_rows()). All quantities of the fit and all terms of
/// further_terms() are free, so that delays and lags do not count. `point`: solution of `problem`.
/// `candidate_terms`: further free parameters (LogFitOptions::candidate_terms).
bool has_changes_between_rows(const LogProblem& problem, const SearchPoint& point,
                              const std::vector<ParameterId>& candidate_terms);

/// True if the likeliest times of the changes scatter no more than times between two rows do; a
/// larger scatter is the effect of another error of the model. `times`: differences from their
/// expected values, in standard deviations (LogFit::change_times).
bool are_times_between_rows(const std::vector<double>& times);

/// First fit of the logs. In `logs`, the commands are as in this fit: they change at the rows, or
/// at uncertain times between the rows.
struct FirstFit {
  std::vector<DrivingLog> logs;
  FamilyFit fit;
  std::vector<Finding> findings;
};

/// Makes the first fit. If the commands probably change between the rows, first fits the logs with
/// uncertain times of the changes. This fit is used if the times are between the rows
/// (are_times_between_rows()) and its AIC is lower by more than kFamilyAicThreshold than that of a
/// fit of the same terms with changes at the rows.
FirstFit first_fit(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                   const IdentifyOptions& options);

}  // namespace awmr
