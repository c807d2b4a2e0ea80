/// The names of identify's options, one table for the command line and the project file.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "awmr/core/result.h"
#include "awmr/identify/identify.h"
#include "awmr/trials/read_trials.h"

namespace awmr::cli {

/// `NAME` for surge and yaw, `surge=NAME` or `yaw=NAME` for one; NAME is a family or `auto`.
/// Errors: an unknown name, with those there are; dead-zone for yaw alone.
Status add_family(std::string_view text, IdentifyOptions& options);

/// A parameter's name, `all`, `input_delay_s` or `bias.CHANNEL` (`bias.yaw_rate_radps`, ...).
Status add_asked(std::string_view name, IdentifyOptions& options);

/// The options in words, for the model's provenance.
std::vector<std::pair<std::string, std::string>> described(const IdentifyOptions& options);

/// How the trials were read, behind them.
void describe_reading(const TrialOptions& trials, bool steady_from_logs,
                      std::vector<std::pair<std::string, std::string>>& words);

}  // namespace awmr::cli
