/// Makes all print figures for which the results have data. Private to report/.
#pragma once

#include <string>
#include <vector>

#include "awmr/report/figures/figure.h"
#include "awmr/report/report_data.h"

namespace awmr {

/// The figures for which there are data, and the reasons why others are missing.
struct FiguresOfResults {
  std::vector<Figure> figures = {};       ///< names are unique
  std::vector<std::string> lacking = {};  ///< missing figures: names and reason in one text each
};

/// Makes the figures of identification, logs, tuning, runs and comparison, as far as there are
/// data. Errors (input): validation.json, gains.json or comparison.json does not have awmr's
/// format.
Result<FiguresOfResults> figures_of(const ReportData& data);

// Each function adds the figures of one kind to `all` or, without data, the reason to all.lacking.
void add_identification_figures(const Model& model, FiguresOfResults& all);
/// Throws Json::exception if validation.json does not have awmr's format.
void add_log_figures(const Json& data, FiguresOfResults& all);
/// Throws Json::exception if gains.json does not have awmr's format.
void add_tuning_figures(const Json& data, FiguresOfResults& all);
void add_run_figures(const Json& data, FiguresOfResults& all);
/// Throws Json::exception if comparison.json does not have awmr's format.
void add_comparison_figures(const Json& data, FiguresOfResults& all);

/// Returns "KIND_NAME" with NAME limited to 100 bytes. All characters except letters, digits, - and
/// _ are replaced by _, so that the name is valid in file names on every system.
std::string figure_name(const std::string& kind, const std::string& name);

}  // namespace awmr
