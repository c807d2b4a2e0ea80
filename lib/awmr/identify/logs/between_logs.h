/// Whether several logs show the same vehicle. Private to identify/.
#pragma once

#include <string>
#include <vector>

#include "awmr/identify/logs/identifiability.h"

namespace awmr {

/// A quantity that differs between logs by more than its errors explain.
struct LogDisagreement {
  std::size_t quantity = 0;
  double p_value = 1.0;             ///< of all logs having one value
  std::vector<std::string> files;   ///< those that show the quantity
  std::vector<double> coordinates;  ///< what each would have on its own, by one step
  double between_std = 0.0;         ///< tau, of the coordinate from log to log
  double widening = 1.0;            ///< of the standard error, if it shall hold for their mean
};

/// Each log on its own, by one step of Gauss-Newton from the common solution, x_l = x - C_l g_l with
/// its own information and scores. With weights w_l = 1/C_l,ii (errors widened as `found` says),
///
///     Q = sum w_l (x_l - mean)^2,   chi-squared with L - 1 degrees of freedom for one vehicle,
///     tau^2 = (Q - (L - 1)) / (sum w - sum w^2 / sum w)                    (DerSimonian and Laird)
///
/// Said where p < 0.001 over all quantities.
std::vector<LogDisagreement> log_disagreements(const LogProblem& problem,
                                               const std::vector<WindowResiduals>& residuals,
                                               const std::vector<double>& coordinates,
                                               const Identifiability& found);

/// Standard errors that hold for the mean of vehicles like those in the logs.
Identifiability with_disagreements(Identifiability found,
                                   const std::vector<LogDisagreement>& disagreements);

}  // namespace awmr
