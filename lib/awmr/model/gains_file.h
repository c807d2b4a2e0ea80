/// gains.json (`awmr.gains/1`): the gains used by later commands. tune/ adds the tuning results.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "awmr/core/result.h"
#include "awmr/model/certificate.h"
#include "awmr/model/gains.h"
#include "awmr/model/paper_gains.h"

namespace awmr {

/// Reads `/heading`, `/speed` and, if present, `/observer`; other keys of the format are allowed
/// and ignored. Errors: as read_json_file; gains that are missing or not above 0.
Result<Gains<double>> read_gains(const std::filesystem::path& path);

/// Reads `/certificate`; absent in files that were not tuned, and in older files. Errors: as
/// read_gains; a certificate in another form.
Result<std::optional<CertifiedGains>> read_certificate(const std::filesystem::path& path);

/// Read-back of gains.json (core/file.h).
Status check_gains_text(std::string_view text, const std::string& file);

/// As above, for a controller with this sample time. Errors also: as check_observer_rate.
Result<Gains<double>> read_gains_for(const std::filesystem::path& path, double sample_time_s);

/// Writes gains that were not tuned here; gains_text() in tune/tune.h makes the complete file.
/// Errors: as write_file.
Status write_gains(const Gains<double>& gains, const std::filesystem::path& path);

}  // namespace awmr
