/// Reads and writes the gains in gains.json (`awmr.gains/1`). gains.json also has the results of
/// tuning; tune/ writes them.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "awmr/core/result.h"
#include "awmr/model/certificate.h"
#include "awmr/model/gains.h"
#include "awmr/model/mode_gains.h"
#include "awmr/model/paper_gains.h"

namespace awmr {

/// Reads `/heading`, `/speed` and, if present, `/observer`: the gains of all modes that have no
/// gains of their own. Errors: those of read_json_file(); unknown keys; gains that are missing or
/// out of range (ranges.h), also in `/modes`.
Result<Gains<double>> read_gains(const std::filesystem::path& path);

/// Reads `/certificate`, the worst cases of the closed loop; absent if the file has no such key.
/// Errors: as read_json_file(); a certificate in another form.
Result<std::optional<CertifiedGains>> read_certificate(const std::filesystem::path& path);

/// As read_gains(), and also reads the gains that belong to one mode only (`/modes`). A mode with
/// gains of its own does not get the observer of `/observer`, only an observer within its own
/// gains.
Result<ModeGains> read_mode_gains(const std::filesystem::path& path);

/// JSON pointer of the gains of a mode in gains.json: "/modes/steering", or "" if the mode has no
/// gains of its own.
std::string pointer_of(const ModeGains& gains, YawMode mode);

/// Checks that a text of gains.json can be read, before it is written (ReadBack in core/file.h).
/// Errors: those of read_gains().
Status check_gains_text(std::string_view text, const std::string& file);

/// As read_mode_gains(), and also checks that the observer suits a controller with this sample
/// time. Errors: as read_mode_gains(); the bandwidth is too large (check_observer_rate()).
Result<ModeGains> read_gains_for(const std::filesystem::path& path, double sample_time_s);

/// Writes a file with gains only. Tuned gains are written by gains_text() in tune/tune.h.
/// Errors: those of write_file().
Status write_gains(const Gains<double>& gains, const std::filesystem::path& path);

}  // namespace awmr
