/// Guesses which columns of an unknown file correspond to awmr's columns (`awmr map`), each guess
/// with its reason. The user must confirm the guesses.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "awmr/core/name_table.h"
#include "awmr/core/result.h"
#include "awmr/trials/trials.h"

namespace awmr {

/// First rows of a file in any supported format.
struct FileSample {
  std::vector<std::string> names;
  /// The first numbers of each column, at most kSampleRows.
  std::vector<std::vector<double>> values;
  /// The first non-empty cell of each column; empty for binary files.
  std::vector<std::string> texts;
};
inline constexpr std::size_t kSampleRows = 1000;

/// Reads the first rows of a file or a directory of files. Errors: those of the reader of the
/// file's format; a directory without a log.
Result<FileSample> sample_of(const std::filesystem::path& path);

/// Confidence of a guess.
enum class Confidence {
  kSure,    ///< the name equals awmr's column name
  kLikely,  ///< the name fits, and the unit follows from the name or the values
  kUnsure,  ///< the unit is unknown, or another column fits as well: the user must choose
};
inline constexpr NameTable<Confidence, 3> kConfidenceNames{{{"sure", Confidence::kSure},
                                                            {"likely", Confidence::kLikely},
                                                            {"unsure", Confidence::kUnsure}}};

struct ColumnGuess {
  std::string column;  ///< name of awmr's column, such as "speed_mps"
  /// Formula of the file's columns in the syntax of `--column`. Empty if no column of the file can
  /// be used; `why` then gives the reason.
  std::string expression;
  Confidence confidence = Confidence::kUnsure;
  std::string why;                   ///< reason of the guess, as text for the user
  std::vector<double> samples = {};  ///< first few values of the file's column that the guess uses
};

/// Returns the guesses for each column that this kind of trial can have, in the order of
/// columns_of(kind). If a column has several guesses, the most confident one comes first. The
/// guesses use the words and units in the names of the file's columns (column_words.h). If no
/// column fits the speed or the yaw rate of a log, they are computed from the speeds of a left and
/// a right wheel. `track_m`: distance of the left from the right wheels, m, which the yaw rate
/// needs.
std::vector<ColumnGuess> guess_columns(const FileSample& sample, TrialKind kind,
                                       std::optional<double> track_m = std::nullopt);

/// Returns the first guess for each of awmr's columns; omits columns whose first guess is kUnsure.
std::vector<ColumnGuess> likely_columns(const std::vector<ColumnGuess>& guesses);

/// Returns the columns of the file that no guess uses, in the file's order.
std::vector<std::string> unused_columns(const FileSample& sample,
                                        const std::vector<ColumnGuess>& guesses);

}  // namespace awmr
