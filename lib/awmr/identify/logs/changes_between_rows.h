/// Logs whose commands change between two rows, at a time that the log does not show. Private to
/// identify/.
#pragma once

#include <string>
#include <vector>

#include "awmr/identify/logs/log_problem.h"
#include "awmr/identify/options.h"

namespace awmr {

/// True if the commands probably change between rows: with an uncertain time for every change
/// (changes_before_rows()), -2 ln L is lower by more than 20 plus 2 per change than with changes at the rows. -2 ln L
/// is that of the marginal likelihood. The likeliest times also have to be between the rows
/// (are_times_between_rows()). In both cases, all quantities of the fit and all terms of
/// further_terms() are free, so that delays and lags do not count. `point`: solution of `problem`.
/// `candidate_terms`: further free parameters (LogFitOptions::candidate_terms).
bool has_changes_between_rows(const LogProblem& problem, const SearchPoint& point,
                              const std::vector<ParameterId>& candidate_terms);

/// True if the likeliest times of the changes scatter as times between two rows do. `times`: less
/// their mean, in standard deviations (LogFit::change_times). A larger scatter is the effect of
/// another error of the model. Likeliest times scatter less than true ones.
bool are_times_between_rows(const std::vector<double>& times);

/// The note `changes-between-rows`.
Finding changes_between_rows_finding(const std::string& file);

}  // namespace awmr
