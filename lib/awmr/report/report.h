/// From what lies in a directory of results: report.html, one self-contained file, and figures for
/// print.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "awmr/core/file.h"
#include "awmr/core/result.h"
#include "awmr/model/record.h"

namespace awmr {

/// Reads model.json and, where present, gains.json, validation.json, comparison.json and .csv,
/// pil.json, suggest.json, the scenarios `scenario_<scenario>.json` and the runs
/// `run_<scenario>_<mode>_<tuned|paper>.csv` with their side files. Errors (input): no model.json, or a
/// file is broken.
Result<std::string> report_html(const std::filesystem::path& directory);

/// The page, with what it leaves out.
struct ReportPage {
  std::string html;
  /// Results that were left out, as they are not of this directory's model, each with its reason.
  std::vector<Finding> left_out;
};
Result<ReportPage> report_page(const std::filesystem::path& directory);

/// Errors (input): a file of this name is there that is no page of this program.
Status check_report_page(const std::filesystem::path& path);

/// The figures of a directory of results, each as SVG and as PDF.
struct FigureSet {
  std::vector<OutputFile> files = {};  ///< NAME.svg, NAME.pdf, ...: to be written below a directory
  std::vector<std::string> names = {};    ///< without extension, in order
  std::vector<std::string> lacking = {};  ///< what is not drawn and why, a sentence each
};

/// The same bytes from the same files. Errors: as report_html(); a figure would hold a number that is
/// not finite or beyond 1e100.
Result<FigureSet> report_figures(const std::filesystem::path& directory);

}  // namespace awmr
