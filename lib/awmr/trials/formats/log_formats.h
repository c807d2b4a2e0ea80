/// Readers of other programs' logs. FORMATS.md lists the formats and the names of their signals.
/// Private to trials/.
///
/// A reader of signals returns the names of all signals of the file, and the values of the
/// requested ones. In ULog and DataFlash, more than kMaxSignals signals are an error.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "signals.h"

namespace awmr {

/// Reads a PX4 log in ULog format, version 1. A file that ends inside a message (power loss) is
/// read up to this message, with a note. Errors: unknown flags; a format that is malformed,
/// unknown, nested too deeply or larger than a message; a message that is shorter than its format
/// or has no topic; a time that is too large; two topics with the same id.
Result<Signals> read_ulog(std::string_view bytes, const std::string& file, const Wanted& wanted);
bool is_ulog(std::string_view bytes);

/// Reads an ArduPilot DataFlash log. Bytes between records (from a lost write) and an incomplete
/// last record are skipped, with a note. Errors: an FMT record with a wrong length, a wrong number
/// of names or an unknown format character; two different FMT records of one type; a record with an
/// invalid time.
Result<Signals> read_dataflash(std::string_view bytes, const std::string& file,
                               const Wanted& wanted);
bool is_dataflash(std::string_view bytes);

/// Like read_dataflash(), but for the text form, which ground stations export. Lines of an unknown
/// type, lines with a wrong number of values and an incomplete last line are skipped, with a note.
/// Errors, with the line: those of read_dataflash(); a value that is not a number.
Result<Signals> read_dataflash_text(std::string_view bytes, const std::string& file,
                                    const Wanted& wanted);
bool is_dataflash_text(std::string_view bytes);

/// Reads a ROS 2 bag in SQLite. The time of a message is the time at which the recorder received
/// it, because all topics share the recorder's clock. Topics of unsupported types, or not
/// serialised in CDR (the format of ROS 2), are skipped and noted. Errors: not a bag; more than
/// 10000 topics; a message whose bytes do not match its type.
Result<Signals> read_rosbag(std::string_view bytes, const std::string& file, const Wanted& wanted);
bool is_rosbag(std::string_view bytes);

/// Signals of several CSV files.
struct CsvTopics {
  Signals signals = {};
  /// Indices in `mappings` of the mappings to t_s that were used.
  std::vector<std::size_t> mapped = {};
};

/// Reads a directory of CSV files, one topic per file. A signal has the name `FILE.COLUMN` (FILE
/// without extension). If only one file has the column, the signal also has the name `COLUMN`. Each
/// file needs a time column: t_s, the source of a mapping to t_s, or one that find_time()
/// recognises. All files must use the same clock. Errors: those of read_csv(); files that do not
/// overlap in time; a time of more than 9e9 s.
Result<CsvTopics> read_csv_topics(std::span<const std::filesystem::path> paths,
                                  std::span<const ColumnMapping> mappings, const Wanted& wanted);

/// Columns of a log whose rows are not lines of text (`.awl`, JSON of SysId).
struct ColumnLog {
  std::vector<std::string> header = {};           ///< column names
  std::vector<std::vector<double>> columns = {};  ///< by column, then by row
  std::vector<CsvNote> notes = {};

  std::size_t rows() const { return columns.empty() ? 0 : columns.front().size(); }
};

/// Reads the JSON that WPILib's SysId records. The result has the rows of all tests, one test after
/// the other. Each test is a run whose `t_s` begins at 0. Some programs record voltages without
/// sign. If the wheels of a side turned backward in a test although none of its voltages is
/// negative, the function makes these voltages negative. Errors: JSON that is not a SysId record; a
/// mechanism that does not drive the robot (elevator, arm); units that are not lengths; no rows;
/// rows with a wrong number of values; times that do not rise.
Result<ColumnLog> read_sysid(std::string_view bytes, const std::string& file);
/// True if the text begins with a JSON object that has the key "sysid" or the name of a test in its
/// first 4 KiB.
bool is_sysid(std::string_view bytes);

}  // namespace awmr
