/// Reads a trial file of any format as a table of columns. Private to trials/.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "awmr/core/csv.h"
#include "awmr/trials/read_trials.h"
#include "log_formats.h"

namespace awmr {

/// Reads a log of a flight controller (ULog, DataFlash) or a ROS 2 bag as signals. `file`: path,
/// for errors. `wanted`: selects the signals whose values are read. Empty if `bytes` are in another
/// format.
std::optional<Result<Signals>> read_signals(std::string_view bytes, const std::string& file,
                                            const Wanted& wanted);

/// Reads a log of the emitted firmware or a SysId record. Empty if `bytes` are in another format.
std::optional<Result<ColumnLog>> read_columns(std::string_view bytes, const std::string& file);

/// Reads the requested columns of a file. The first bytes of the file determine the format: ULog,
/// DataFlash, ROS 2 bag in SQLite, log of the emitted firmware (`.awl`), JSON of WPILib's SysId,
/// otherwise CSV. The files of a directory are joined by time. Errors: those of read_csv() and of
/// the readers of these formats.
Result<CsvTable> read_table(const std::filesystem::path& path, std::span<const CsvColumn> columns,
                            const TrialOptions& options);

}  // namespace awmr
