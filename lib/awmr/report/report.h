/// Makes report.html (one page) and the data of print figures from a directory of results.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "awmr/core/file.h"
#include "awmr/core/result.h"
#include "awmr/model/record.h"

namespace awmr {

/// The page, and warnings about the results that it omits.
struct ReportPage {
  std::string html;
  /// A warning for each result that the page omits, because it was made from another model or other
  /// gains, or because its inputs are unknown.
  std::vector<Finding> left_out;
};
/// Returns the page for a directory of results. Reads model.json and, if present, gains.json,
/// validation.json, comparison.json and .csv, pil.json, suggest.json, awmr_emit.json (also in
/// `firmware`), the scenarios `scenario_<scenario>.json` and the runs
/// `run_<scenario>_<mode>_<tuned|paper>.csv` with their side files (.csv.json). Errors (input):
/// there is no model.json, or a file is invalid.
Result<ReportPage> report_page(const std::filesystem::path& directory);

/// Checks that the page may be written to `path`. Error (input): a file of this name exists, and
/// its title is not that of a page of awmr.
Status check_report_page(const std::filesystem::path& path);

/// File name of the Python program that draws the figures.
inline constexpr const char* kPlotName = "plot.py";

/// Print figures: their data as CSV files, figures.json, and plot.py, a Python program that draws
/// them with matplotlib.
struct FigureSet {
  std::vector<OutputFile> files = {};     ///< the files, with paths relative to an output directory
  std::vector<std::string> names = {};    ///< names of the figures: CSV file names, no extension
  std::vector<std::string> lacking = {};  ///< missing figures: names and reason in one text each
};

/// Makes all figures for which the directory has results. The same results give the same bytes.
/// Errors: those of report_page(); a figure has a number that is not finite.
Result<FigureSet> report_figures(const std::filesystem::path& directory);

/// JSON Schema of figures.json.
std::string figures_schema();

}  // namespace awmr
