/// Creates report.html, one self-contained file, and the data of print figures from a directory of
/// results.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "awmr/core/file.h"
#include "awmr/core/result.h"
#include "awmr/model/record.h"

namespace awmr {

/// Reads model.json and, if present, gains.json, validation.json, comparison.json and .csv,
/// pil.json, suggest.json, the scenarios `scenario_<scenario>.json` and the runs
/// `run_<scenario>_<mode>_<tuned|paper>.csv` with their side files. Errors (input): no model.json,
/// or an invalid file.
Result<std::string> report_html(const std::filesystem::path& directory);

/// The page, and the results that it omits.
struct ReportPage {
  std::string html;
  /// Results omitted because they do not belong to this directory's model, each with its reason.
  std::vector<Finding> left_out;
};
Result<ReportPage> report_page(const std::filesystem::path& directory);

/// Errors (input): a file of this name exists and is not a page of this program.
Status check_report_page(const std::filesystem::path& path);

/// Name of the program that draws the figures.
inline constexpr const char* kPlotName = "plot.py";

/// The figures of a directory of results as CSV files, with figures.json and plot.py, a Python program
/// that draws them by matplotlib.
struct FigureSet {
  std::vector<OutputFile> files = {};     ///< to be written below a directory
  std::vector<std::string> names = {};    ///< of the CSV files, without extension, in order
  std::vector<std::string> lacking = {};  ///< missing figures and the reasons, one sentence each
};

/// The same files give the same bytes. Errors: as report_html(); a figure would have a number that
/// is not finite.
Result<FigureSet> report_figures(const std::filesystem::path& directory);

/// JSON Schema of figures.json.
std::string figures_schema();

}  // namespace awmr
