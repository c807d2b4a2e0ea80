/// Selection of the model that is fitted to the logs: resistance families (forms of the resistance
/// law), back-EMF, and whether the logged steering commands are measured angles. Private to
/// identify/.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "awmr/identify/logs/choice/family_choice.h"
#include "awmr/identify/options.h"

namespace awmr {

/// Calls options.doing, if it is set, with the name of the step that begins.
void show_step(const IdentifyOptions& options, std::string_view what);

/// Sets LogFitOptions::optional_coulomb for a first fit of the families `surge` and `yaw`.
LogFitOptions with_optional_coulomb(LogFitOptions power_law, const IdentifyOptions& options,
                                    Family surge, Family yaw);

/// Fits the resistance families that the user requested, else those of `begin`. If the errors after
/// the first round are far above the sensor noise, selects likelier families, and perhaps back-EMF
/// (likely_families()), and fits those instead. Never changes a family that the user selected.
FamilyFit fit_first_family(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                           const IdentifyOptions& options, const Families& begin = {});

std::vector<DrivingLog> with_measured_steering(std::vector<DrivingLog> logs);

/// True if the column of steering commands seems to contain measured angles. All of these
/// conditions must hold:
///   - Every log has steering commands, but no measured angles.
///   - In the fit `first`, the time constant of the servo is at most half of the row spacing. (If
///     the fit has found that the time stamps of the steering are late, this condition is for the
///     time constant minus the lateness.)
///   - The AIC of a fit that uses the column as the measured angle is lower than that of `first` by
///     more than kFamilyAicThreshold. (If `first` has late time stamps of the steering, any lower
///     AIC suffices.)
bool is_steering_measured(const std::vector<DrivingLog>& logs, LogFitOptions power_law,
                          const FamilyFit& first);

Finding measured_steering_finding(const std::string& file);

/// Selects the resistance families, and back-EMF if it is significant. `power_law`: result of
/// log_setup(); if back-EMF is selected, it becomes a free parameter of `power_law`. `first`:
/// result of fit_first_family().
BestFamily choose_model(const std::vector<DrivingLog>& logs, LogFitOptions& power_law,
                        const IdentifyOptions& options, FamilyFit first);

}  // namespace awmr
