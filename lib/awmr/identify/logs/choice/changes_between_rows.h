/// Logs whose commands change between two rows, at a time that the log does not show. Private to
/// identify/.
#pragma once

#include <vector>

#include "awmr/identify/logs/choice/family_fit.h"
#include "awmr/identify/logs/problem/log_problem.h"
#include "awmr/identify/options.h"

namespace awmr {

/// True if the commands possibly change between rows. Compares two assumptions: every change
/// happened at an unknown time before its row (changes_before_rows()), or exactly at its row. AIC
/// (integrated over the times) has to be lower with unknown times: by more than 6 if only the
/// delays are free in addition, and at all if each assumption also has those further terms, except
/// ramps, that lower its AIC by more than kTermAicThreshold. (A delay or lag can look like such
/// changes.) The likeliest times also have to pass are_times_between_rows(). `point`: solution of
/// `problem`. `candidate_terms`: further free parameters (LogFitOptions::candidate_terms).
bool has_changes_between_rows(const LogProblem& problem, const SearchPoint& point,
                              const std::vector<ParameterId>& candidate_terms);

/// True if the likeliest times of the changes scatter no more than times between two rows do. A
/// larger scatter means that another error of the model moves them. `times`: likeliest minus
/// expected times, in standard deviations (LogFit::change_times).
bool are_times_between_rows(const std::vector<double>& times);

/// First fit, and the logs as this fit used them: with commands that change at the rows, or at
/// uncertain times between the rows.
struct FirstFit {
  std::vector<DrivingLog> logs;
  FamilyFit fit;
  std::vector<Finding> findings;
};

/// Makes the first fit. If the commands probably change between the rows, first fits the logs with
/// unknown times of the changes. Uses this fit if its times pass are_times_between_rows() and its
/// AIC is lower by more than 6 than with changes at the rows and the same terms.
FirstFit first_fit(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                   const IdentifyOptions& options);

}  // namespace awmr
