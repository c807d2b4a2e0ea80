/// Corrects the times of evenly spaced rows that are rounded in the file, such as 0.00, 0.03, 0.07,
/// 0.10 s for rows at 30 Hz. Private to trials/.
///
/// The resolution q is the greatest common divisor of the time steps. Row k of an evenly logged
/// file has the time
///
///     t_k = t_0 + n_k h
///
/// with n_k = k if no row is missing; each missing row increases n_k of all later rows by 1. A
/// least-squares fit gives the spacing h and t_0. If the remaining errors are those of rounding,
/// t_0 + n_k h is closer to the true time than the rounded time.
#pragma once

#include <string>
#include <vector>

#include "awmr/model/record.h"

namespace awmr {

/// Replaces rounded times of evenly spaced rows by t_0 + n_k h (note `rounded-times`). If the rows
/// are not evenly spaced, leaves the times unchanged, and adds the warning `rounded-times` if the
/// resolution q is at least 20 % of the usual step and at least 5 ms. `t_s` must increase strictly.
/// `file`, `line`: location of the first row.
void replace_rounded_times(std::vector<double>& t_s, const std::string& file, int line,
                           std::vector<Finding>& findings);

}  // namespace awmr
