/// Parses the options of `identify`, which come from the command line or the project file, and
/// describes them as text.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "awmr/core/result.h"
#include "awmr/identify/identify.h"
#include "awmr/trials/load.h"

namespace awmr::cli {

/// Parses a choice of the resistance family: `NAME` (for surge and yaw), `surge=NAME` or
/// `yaw=NAME`, where NAME is a family or `auto`. Errors: an unknown name (the message lists the
/// known ones); surge or yaw given twice; `yaw=` with a dead zone.
Status add_family(std::string_view text, IdentifyOptions& options);

/// Adds a parameter that is to be fitted: the name of a parameter, `all`, `input_delay_s`, or
/// `bias.CHANNEL` for the bias of a sensor channel (`bias.yaw_rate_radps`). Errors (input): an
/// unknown name; the message lists the known ones.
Status add_requested(std::string_view name, IdentifyOptions& options);

/// Largest absolute value of a time in a log (column t_s), s.
inline constexpr double kMaxTime_s = 1e12;

/// Adds a span of time that is left out of each log: `A:B` in s, with A before B. Errors (input):
/// the text is not of this form.
Status add_excluded(std::string_view text, TrialOptions& trials);

/// Checks the limits --from and --until of the part of the logs that is used. Errors (input):
/// `--until` is not after `--from`.
Status check_used(const TrialOptions& trials);
/// Calls check_used(), then add_excluded() for each text of `excluded`; returns their errors.
Status use_parts(const std::vector<std::string>& excluded, TrialOptions& trials);

/// Returns the options as pairs of name and value, for the record of the model's origin.
NamedOptions described(const IdentifyOptions& options);

/// Appends the options `--from`, `--until` and `--exclude`, as pairs of name and value, to `words`.
/// Appends nothing if the logs are used completely.
void describe_parts(const TrialOptions& trials, NamedOptions& words);

/// Appends the options with which the trials were read, as pairs of name and value, to `words`.
void describe_reading(const TrialFiles& trials, NamedOptions& words);

}  // namespace awmr::cli
