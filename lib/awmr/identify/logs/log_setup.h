/// Options of the first fit of the logs: free parameters, initial guesses, limits of the work.
/// Private to identify/.
#pragma once

#include <initializer_list>
#include <map>
#include <string>
#include <vector>

#include "awmr/identify/logs/log_fit_options.h"
#include "awmr/identify/options.h"
#include "awmr/model/model.h"

namespace awmr {

/// True if one of the logs has one of the channels.
bool is_logged(const std::vector<DrivingLog>& logs, std::initializer_list<LogChannel> channels);

/// Returns the options of a fit with power laws. The parameters in `requested` and those without a
/// value in `model` are free, with initial guesses from the logs. If the channels and commands of
/// the logs cannot identify a parameter, adds the reason to `reasons`.
LogFitOptions log_setup(const Vehicle& vehicle, const std::vector<DrivingLog>& logs,
                        const IdentifyOptions& options, const std::vector<ParameterId>& requested,
                        const Model& model, std::map<ParameterId, std::string>& reasons);

}  // namespace awmr
