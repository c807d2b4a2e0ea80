/// Whether several logs show the same vehicle. Private to identify/.
#pragma once

#include <string>
#include <vector>

#include "awmr/identify/logs/family_choice.h"

namespace awmr {

/// A quantity that differs between logs by more than its errors explain.
struct LogDisagreement {
  std::string name;
  double p_value = 1.0;            ///< of all logs having one value
  std::vector<std::string> files;  ///< those that show the quantity on their own
  std::vector<double> values;      ///< by file
};

/// Fits every log on its own, or the halves of a single one of 20 s and more, from the common optimum and compares: with x_l, w_l = 1/var(x_l) of the
/// coordinate of a quantity in each of L logs that show it,
///
///     Q = sum w_l (x_l - mean)^2,   chi-squared with L - 1 degrees of freedom for one vehicle,
///     tau^2 = (Q - (L - 1)) / (sum w - sum w^2 / sum w)                    (DerSimonian and Laird)
///
/// Where p < 0.001 over all quantities, the standard error and the interval of the common fit are
/// widened by tau: they then hold for the mean of vehicles like these. A bias may differ.
std::vector<LogDisagreement> hold_against_each_other(const std::vector<DrivingLog>& all,
                                                     FamilyFit& common);

}  // namespace awmr
