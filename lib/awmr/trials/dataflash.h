/// Reads ArduPilot DataFlash logs (`.bin`). Private to this folder.
///
/// Every record begins with the bytes A3 95 and its type. An FMT record defines the length and the
/// fields of one type. Signals are named `NAME.FIELD`. If an FMTU record marks a field as the
/// instance number of similar sensors, signals are named `NAME[2].FIELD`. Texts, arrays and 16-bit
/// floats are omitted. Numbers are scaled by their format character: c, C, e, E are hundredths, L
/// is 1e-7 degrees.
#pragma once

#include <string>
#include <string_view>

#include "signals.h"

namespace awmr {

bool is_dataflash(std::string_view bytes);

/// Returns the names of all signals, and the values of the requested ones. Bytes between records
/// (from a lost write) and an incomplete last record are skipped, with a note. Errors: an FMT
/// record with a wrong length, a wrong number of names or an unknown format character; two
/// different FMT records of one type; a record with an invalid time; more than kMaxSignals signals.
Result<Signals> read_dataflash(std::string_view bytes, const std::string& file,
                               const Wanted& wanted);

}  // namespace awmr
