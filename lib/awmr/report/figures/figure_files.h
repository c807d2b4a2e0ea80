/// The files of print figures: one CSV per figure, figures.json and plot.py. Private to this
/// folder.
#pragma once

#include <string>
#include <vector>

#include "awmr/core/result.h"
#include "awmr/report/figures/figure.h"

namespace awmr {

/// Columns panel, series (both counted from 0), name, x, y, low, high; one row per point. Errors
/// (input): a number that is not finite; the message names the series and the figure.
Result<std::string> figure_csv(const Figure& figure);

/// figures.json: names, axes, panels, series with their shapes and roles; no numbers of the CSV
/// files.
std::string figures_text(const std::vector<Figure>& figures);

}  // namespace awmr
