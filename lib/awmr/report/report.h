/// Makes report.html, one self-contained page, and the data of print figures from a directory of
/// results.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "awmr/core/file.h"
#include "awmr/core/result.h"
#include "awmr/model/record.h"

namespace awmr {

/// Returns the page for a directory of results. Reads model.json and, if present, gains.json,
/// validation.json, comparison.json and .csv, pil.json, suggest.json, awmr_emit.json (also in
/// `firmware`), the scenarios `scenario_<scenario>.json` and the runs
/// `run_<scenario>_<mode>_<tuned|paper>.csv` with their side files. Errors (input): there is no
/// model.json, or a file is invalid.
Result<std::string> report_html(const std::filesystem::path& directory);

/// The page, and warnings about the results that it omits.
struct ReportPage {
  std::string html;
  /// Results omitted because they do not belong to this directory's model, each with its reason.
  std::vector<Finding> left_out;
};
/// Returns the page as report_html(), and the warnings.
Result<ReportPage> report_page(const std::filesystem::path& directory);

/// Checks that the page may be written. Error (input): a file of this name exists, and awmr did not
/// write it.
Status check_report_page(const std::filesystem::path& path);

/// Name of the program that draws the figures.
inline constexpr const char* kPlotName = "plot.py";

/// Print figures: their data as CSV files, figures.json, and plot.py, a Python program that draws them
/// with matplotlib.
struct FigureSet {
  std::vector<OutputFile> files = {};     ///< the files, with paths relative to an output directory
  std::vector<std::string> names = {};    ///< names of the figures: CSV file names, no extension
  std::vector<std::string> lacking = {};  ///< missing figures and the reasons, one sentence each
};

/// Makes the figures that the results in the directory permit. The same files give the same bytes.
/// Errors: as report_html(); a figure has a number that is not finite.
Result<FigureSet> report_figures(const std::filesystem::path& directory);

/// JSON Schema of figures.json.
std::string figures_schema();

}  // namespace awmr
