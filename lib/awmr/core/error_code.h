/// Codes of errors. A code stays the same in later versions; the text of its message may change.
#pragma once

#include "awmr/core/name_table.h"

namespace awmr {

/// The cause of an error. `awmr explain CODE` prints its meaning and remedy
/// (apps/awmr/FINDINGS.md).
enum class ErrorCode {
  // Wrong names, values and options.
  kMissing,
  kUnknownName,
  kGivenTwice,
  kWrongType,
  kOutOfRange,
  kWrongOrder,
  kTooLarge,
  kConflict,
  kAmbiguous,
  kBadName,
  kBadFormula,
  kUnusedMapping,
  kUsage,
  kContradiction,
  kImplausible,
  // Files and programs that cannot be used.
  kCannotRead,
  kCannotWrite,
  kWouldOverwrite,
  kWrongFile,
  kBrokenFile,
  kStaleResult,
  kNotInstalled,
  // Vehicles, models and trials for which a command is not possible.
  kUnsupported,
  kTooFewData,
  kNotIdentified,
  kDiverges,
  // Negative results of commands that ran.
  kNoGains,
  kSlowReaching,
  kNoTable,
  kNotRecovered,
  kCompassUnusable,
  kNoAnswer,
  // Faults left out of a long list, and internal errors of the program.
  kMoreFaults,
  kInternal,
};

inline constexpr NameTable<ErrorCode, 34> kErrorCodeNames{
    {{"missing", ErrorCode::kMissing},
     {"unknown-name", ErrorCode::kUnknownName},
     {"given-twice", ErrorCode::kGivenTwice},
     {"wrong-type", ErrorCode::kWrongType},
     {"out-of-range", ErrorCode::kOutOfRange},
     {"wrong-order", ErrorCode::kWrongOrder},
     {"too-large", ErrorCode::kTooLarge},
     {"conflict", ErrorCode::kConflict},
     {"ambiguous", ErrorCode::kAmbiguous},
     {"bad-name", ErrorCode::kBadName},
     {"bad-formula", ErrorCode::kBadFormula},
     {"unused-mapping", ErrorCode::kUnusedMapping},
     {"usage", ErrorCode::kUsage},
     {"contradiction", ErrorCode::kContradiction},
     {"implausible", ErrorCode::kImplausible},
     {"cannot-read", ErrorCode::kCannotRead},
     {"cannot-write", ErrorCode::kCannotWrite},
     {"would-overwrite", ErrorCode::kWouldOverwrite},
     {"wrong-file", ErrorCode::kWrongFile},
     {"broken-file", ErrorCode::kBrokenFile},
     {"stale-result", ErrorCode::kStaleResult},
     {"not-installed", ErrorCode::kNotInstalled},
     {"unsupported", ErrorCode::kUnsupported},
     {"too-few-data", ErrorCode::kTooFewData},
     {"not-identified", ErrorCode::kNotIdentified},
     {"diverges", ErrorCode::kDiverges},
     {"no-gains", ErrorCode::kNoGains},
     {"slow-reaching", ErrorCode::kSlowReaching},
     {"no-table", ErrorCode::kNoTable},
     {"not-recovered", ErrorCode::kNotRecovered},
     {"compass-unusable", ErrorCode::kCompassUnusable},
     {"no-answer", ErrorCode::kNoAnswer},
     {"more-faults", ErrorCode::kMoreFaults},
     {"internal", ErrorCode::kInternal}}};

}  // namespace awmr
