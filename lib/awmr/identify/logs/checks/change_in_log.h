/// Search for a change of the vehicle or its surroundings within a single log, such as a payload
/// that was added during the drive. Private to identify/.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "awmr/identify/logs/choice/family_fit.h"

namespace awmr {

/// A quantity with its values before and after the change.
struct ChangedQuantity {
  std::string name;
  double before = 0.0;
  double after = 0.0;
};

/// A change at one time of a log.
struct ChangeInLog {
  double t_s = 0.0;  ///< time of the change, s; uncertain by kChangeWidth_s
  /// Quantities that differ significantly, the most significant first; never empty.
  std::vector<ChangedQuantity> quantities;
};

/// Largest error of the time of a change, s. Rows nearer to it are not fitted.
inline constexpr double kChangeWidth_s = 1.0;

/// Searches a time at which the vehicle changed. `chosen`: a fit of the whole log that has a model
/// error (ChannelNoise::of_the_model()), or in which the wheel forces saturate (saturates_much()).
/// The rows before and those after a time are fitted separately, without the terms of the forces
/// that `chosen` has (a change of mass, for example, resembles a saturation). The time with the
/// smallest errors is searched on a grid, which is then refined. There is a change if neither of
/// the two fits has a model error and at least one quantity differs between them significantly (p <
/// 0.001, Bonferroni over all quantities).
///
/// Empty without a change, with several logs, for a log of less than 20 s, or if the limit of the
/// work (Effort) is reached.
std::optional<ChangeInLog> find_change(const std::vector<DrivingLog>& logs,
                                       const LogFitOptions& power_law, const FamilyFit& chosen);

/// The finding `changed-in-log`.
Finding change_finding(const ChangeInLog& change, const std::string& file);

}  // namespace awmr
