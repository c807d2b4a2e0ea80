/// Selection of the model that is fitted to the logs: resistance families (forms of the resistance
/// law), back-EMF, and whether the logged steering commands are measured angles. Private to
/// identify/.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "awmr/identify/logs/family_choice.h"
#include "awmr/identify/options.h"

namespace awmr {

/// Calls options.doing, if it is set, with the name of the step that begins.
void show_step(const IdentifyOptions& options, std::string_view what);

/// Fits the resistance families that the options name, by default power laws. If the errors after
/// the first round are far above the sensor noise, selects other families, and perhaps back-EMF, by
/// likely_families() and fits those instead. A family that the user selected does not change.
FamilyFit fit_first_family(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                           const IdentifyOptions& options);

/// Returns the logs with their column of steering commands used as the measured steering angle.
std::vector<DrivingLog> with_measured_steering(std::vector<DrivingLog> logs);

/// True if the column of steering commands seems to contain measured angles. All of these
/// conditions must hold:
///   - Every log has steering commands, but no measured angles.
///   - In the fit `first`, the servo has hardly any lag: its time constant is at most half of the
///     row spacing. If the time stamps of the steering are late in `first`, the time by which they
///     are late is first subtracted from the time constant.
///   - A fit that uses the column as the measured angle is significantly better than `first`. If
///     the time stamps of the steering are late in `first`, any lower AIC suffices.
bool is_steering_measured(const std::vector<DrivingLog>& logs, LogFitOptions power_law,
                          const FamilyFit& first);

/// The finding `steering-measured` for logs for which is_steering_measured() is true.
Finding measured_steering_finding(const std::string& file);

/// Selects the resistance families, and back-EMF if it is significant. `power_law`: result of
/// log_setup(). If back-EMF is selected, this function makes it a free parameter of `power_law`.
/// `first`: result of fit_first_family().
BestFamily choose_model(const std::vector<DrivingLog>& logs, LogFitOptions& power_law,
                        const IdentifyOptions& options, FamilyFit first);

}  // namespace awmr
