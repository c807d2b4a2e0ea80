/// A trial's file, of any format, as a table of its columns. Private to this folder.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "awmr/core/csv.h"
#include "awmr/trials/read_trials.h"
#include "signals.h"

namespace awmr {

/// The signals of a binary file; nothing where it is of no format with signals.
std::optional<Result<Signals>> read_signals(std::string_view bytes, const std::string& file,
                                            const Wanted& wanted);

/// The format is known by the first bytes: ULog, DataFlash, a bag of ROS 2 in SQLite,
/// the emitted firmware's own, SysId's JSON, else text. Of a
/// directory the files are joined by time. Errors: as read_csv(); those of the formats.
Result<CsvTable> read_table(const std::filesystem::path& path, std::span<const CsvColumn> columns,
                            const TrialOptions& options);
Result<CsvTable> read_table(const std::filesystem::path& path, TrialKind kind,
                            const TrialOptions& options);

}  // namespace awmr
