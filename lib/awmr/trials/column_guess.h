/// What the columns of an unknown file may be: guesses, each with its reason, to be confirmed by who
/// knows the vehicle.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "awmr/core/name_table.h"
#include "awmr/core/result.h"
#include "awmr/trials/trials.h"

namespace awmr {

/// The first rows of a file of any format that logs are read from.
struct FileSample {
  std::vector<std::string> names;
  std::vector<std::vector<double>> values;  ///< by name: the first numbers, at most kSampleRows
  std::vector<std::string> texts;           ///< by name: the first cell; empty in binary files
};
inline constexpr std::size_t kSampleRows = 1000;

/// Errors: as the reader of the file's format; a directory that has no log.
Result<FileSample> sample_of(const std::filesystem::path& path);

/// How far a guess goes.
enum class Confidence {
  kSure,    ///< the name is the one that is asked for
  kLikely,  ///< name and unit, by the name or by what the values can be
  kUnsure,  ///< the unit is open, or another column fits as well: not to be used unseen
};
inline constexpr NameTable<Confidence, 3> kConfidenceNames{{{"sure", Confidence::kSure},
                                                            {"likely", Confidence::kLikely},
                                                            {"unsure", Confidence::kUnsure}}};

struct ColumnGuess {
  std::string column;      ///< of the trial: "speed_mps"
  std::string expression;  ///< as parse_column() takes it
  Confidence confidence = Confidence::kUnsure;
  std::string why;
  std::vector<double> samples = {};  ///< the first few values of what it is made from
};

/// The guesses for the columns of a trial, in the order of columns_of(kind), the surest of a column
/// first. Names are read for words and units: column_words.h.
std::vector<ColumnGuess> guess_columns(const FileSample& sample, TrialKind kind);

/// Of these, what may be used unseen: the first guess of each column that is not unsure.
std::vector<ColumnGuess> likely_columns(const std::vector<ColumnGuess>& guesses);

}  // namespace awmr
