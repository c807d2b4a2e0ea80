/// Creates all figures that the results permit. Private to this folder.
#pragma once

#include <string>
#include <vector>

#include "awmr/report/figures/figure.h"
#include "awmr/report/report_data.h"

namespace awmr {

struct FiguresOfResults {
  std::vector<Figure> figures = {};       ///< names are unique
  std::vector<std::string> lacking = {};  ///< missing figures and the reasons, one sentence each
};

/// Identification, logs, tuning, runs, comparison, as far as the data have them. Errors (input):
/// validation.json, gains.json or comparison.json does not have awmr's format.
Result<FiguresOfResults> figures_of(const ReportData& data);

// Each function appends figures of one kind.
void add_identification_figures(const Model& model, FiguresOfResults& all);
/// Throws Json::exception if validation.json does not have awmr's format.
void add_log_figures(const Json& data, FiguresOfResults& all);
/// Throws Json::exception if gains.json does not have awmr's format.
void add_tuning_figures(const Json& data, FiguresOfResults& all);
void add_run_figures(const Json& data, FiguresOfResults& all);
/// Throws Json::exception if comparison.json does not have awmr's format.
void add_comparison_figures(const Json& data, FiguresOfResults& all);

/// KIND_NAME, reduced to characters that are valid in file names on every system: letters, digits,
/// - and _; at most 100 bytes.
std::string figure_name(const std::string& kind, const std::string& name);

}  // namespace awmr
