/// Guesses for the columns of an unknown file, each with its reason. The user must confirm them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "awmr/core/name_table.h"
#include "awmr/core/result.h"
#include "awmr/trials/trials.h"

namespace awmr {

/// First rows of a file in any supported log format.
struct FileSample {
  std::vector<std::string> names;
  std::vector<std::vector<double>> values;  ///< by name: the first numbers, at most kSampleRows
  std::vector<std::string> texts;           ///< by name: the first cell; empty in binary files
};
inline constexpr std::size_t kSampleRows = 1000;

/// Errors: as the reader of the file's format; a directory without a log.
Result<FileSample> sample_of(const std::filesystem::path& path);

/// Confidence of a guess.
enum class Confidence {
  kSure,    ///< the name is the required one
  kLikely,  ///< name and unit fit, by the name or by the values
  kUnsure,  ///< the unit is unknown, or another column fits too: needs confirmation
};
inline constexpr NameTable<Confidence, 3> kConfidenceNames{{{"sure", Confidence::kSure},
                                                            {"likely", Confidence::kLikely},
                                                            {"unsure", Confidence::kUnsure}}};

struct ColumnGuess {
  std::string column;      ///< of the trial: "speed_mps"
  std::string expression;  ///< as parse_column() takes it
  Confidence confidence = Confidence::kUnsure;
  std::string why;
  std::vector<double> samples = {};  ///< first few values of the source column
};

/// Guesses the columns of a trial in the order of columns_of(kind), the most confident one first.
/// Words and units are taken from the names: column_words.h.
std::vector<ColumnGuess> guess_columns(const FileSample& sample, TrialKind kind);

/// The guesses usable without confirmation: the first one of each column, unless it is unsure.
std::vector<ColumnGuess> likely_columns(const std::vector<ColumnGuess>& guesses);

}  // namespace awmr
