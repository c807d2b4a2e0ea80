/// Whether several logs show the same vehicle. Private to identify/.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "awmr/identify/logs/family_choice.h"
#include "awmr/identify/logs/held_out.h"

namespace awmr {

/// A quantity that differs between logs by more than its errors explain.
struct LogDisagreement {
  std::string name;
  double p_value = 1.0;            ///< of all logs having one value
  std::vector<std::string> files;  ///< those that show the quantity on their own
  std::vector<double> values;      ///< by file
  bool withdraws = false;          ///< no interval of the common fit holds
  bool refuses = false;            ///< widened, it is not known: LogFit::why_not has it
};

/// Differences between fits of single logs, or of the halves of a single one.
struct LogComparison {
  std::vector<LogDisagreement> disagreements;
  /// The last fifth of a single log, if its first half does not predict it and the halves agree.
  std::optional<HeldOut> missed;
};

/// Fits every log on its own from the common optimum and compares: with x_l, w_l = 1/var(x_l) of the
/// coordinate of a quantity in each of L logs that show it,
///
///     Q = sum w_l (x_l - mean)^2,   chi-squared with L - 1 degrees of freedom for one vehicle,
///     tau^2 = (Q - (L - 1)) / (sum w - sum w^2 / sum w)                    (DerSimonian and Laird)
///
/// Where p < 0.001 over all quantities, the standard error and the interval of the common fit are
/// at least those of the mean of such logs: they then hold for the mean of vehicles like these; a quantity whose standard error
/// then exceeds kUnknown is refused. A bias may differ. A delay
/// or an error of the commands that the common fit does not have, as a trim that was set anew
/// between two logs, is freed where the score tests of the logs differ most. If the logs disagree
/// on it, or on a trim or an imbalance that the common fit has, no interval of the common fit
/// holds: what such a term does in each log is in the other quantities.
///
/// Of a single log of 20 s and more, the first half is fitted and predicts the second half and the last
/// fifth (held_out.h). Where it predicts both (p > 0.05), nothing differs; else the halves are compared
/// as logs are. A last fifth that is missed with p < 0.001 is reported where the halves do not disagree.
LogComparison compare_logs(const std::vector<DrivingLog>& logs, FamilyFit& common);

}  // namespace awmr
