/// The figures that results allow. Private to this folder.
#pragma once

#include <string>
#include <vector>

#include "awmr/report/figures/figure.h"
#include "awmr/report/report_data.h"

namespace awmr {

struct FiguresOfResults {
  std::vector<Figure> figures = {};       ///< no two have the same name
  std::vector<std::string> lacking = {};  ///< what is not drawn and why, a sentence each
};

/// Identification, logs, tuning, runs, comparison: what the data have of them.
/// Errors (input): validation.json, gains.json or comparison.json is not as awmr writes it.
Result<FiguresOfResults> figures_of(const ReportData& data);

// The parts of it; each adds to what is there.
void add_identification_figures(const Model& model, FiguresOfResults& all);
/// Throws Json::exception where validation.json is not as awmr writes it.
void add_log_figures(const Json& data, FiguresOfResults& all);
/// Throws Json::exception where gains.json is not as awmr writes it.
void add_tuning_figures(const Json& data, FiguresOfResults& all);
void add_run_figures(const Json& data, FiguresOfResults& all);
/// Throws Json::exception where comparison.json is not as awmr writes it.
void add_comparison_figures(const Json& data, FiguresOfResults& all);

/// KIND_NAME with what a file name on every system may hold: letters, digits, - and _; at most 100
/// bytes of it.
std::string figure_name(const std::string& kind, const std::string& name);

}  // namespace awmr
