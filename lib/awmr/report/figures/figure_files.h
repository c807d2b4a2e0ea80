/// Text of the files of print figures: one CSV file per figure, and figures.json. Private to
/// report/.
#pragma once

#include <string>
#include <vector>

#include "awmr/core/result.h"
#include "awmr/report/figures/figure.h"

namespace awmr {

/// Text of the CSV file of a figure: one row per point with the columns panel, series (indices from
/// 0), name (of the series), x, y, low, high. Error (input): a number is not finite; the message
/// names series and figure.
Result<std::string> figure_csv(const Figure& figure);

/// Text of figures.json: names, axes, panels, and series with their shapes and roles, without the
/// numbers of the CSV files.
std::string figures_text(const std::vector<Figure>& figures);

}  // namespace awmr
