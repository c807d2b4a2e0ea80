/// Tests whether several logs agree on the vehicle's parameters. Private to identify/.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "awmr/identify/logs/family_choice.h"
#include "awmr/identify/logs/held_out.h"

namespace awmr {

/// A quantity that differs significantly between logs.
struct LogDisagreement {
  std::string name;
  double p_value = 1.0;            ///< p of the hypothesis that all logs have one value
  std::vector<std::string> files;  ///< logs that determine the quantity on their own
  std::vector<double> values;      ///< by file
  bool withdraws = false;          ///< the intervals of the common fit are invalid
  bool refuses = false;            ///< the widened interval is too wide: refused in LogFit::why_not
};

/// Differences between fits of single logs, or of the halves of a single one.
struct LogComparison {
  std::vector<LogDisagreement> disagreements;
  /// Set if the first half of a single log does not predict its last fifth although the halves
  /// agree.
  std::optional<HeldOut> missed;
};

/// Fits every log on its own from the common optimum and compares the results. With x_l, w_l =
/// 1/var(x_l) of a coordinate in each of L logs that determine it,
///
///     Q = sum w_l (x_l - mean)^2,   chi-squared with L - 1 degrees of freedom for one vehicle,
///     tau^2 = (Q - (L - 1)) / (sum w - sum w^2 / sum w)                    (DerSimonian and Laird)
///
/// If p < 0.001 over all quantities, the standard error of the common fit is widened at least to
/// that of the mean over such logs, and the interval covers that mean. A quantity whose standard
/// error then exceeds kUnknown is refused. Biases may differ between logs. A delay or command error
/// that the common fit lacks (for example a trim that was changed between two logs) is freed if its
/// score tests differ most between the logs. If the logs disagree on it, or on a trim or imbalance
/// of the common fit, the intervals of the common fit are invalid, because the other quantities
/// absorb the effect in each log.
///
/// For a single log of 20 s or more, a fit of the first half predicts the second half and the last
/// fifth (held_out.h). If it predicts both (p > 0.05), there is no difference; otherwise the halves
/// are compared as two logs. A last fifth that is not predicted (p < 0.001) is reported if the
/// halves agree.
LogComparison compare_logs(const std::vector<DrivingLog>& logs, FamilyFit& common);

}  // namespace awmr
