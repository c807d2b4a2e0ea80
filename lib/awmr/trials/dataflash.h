/// ArduPilot DataFlash logs (`.bin`): self-describing records. Private to this folder.
///
/// Every record begins with A3 95 and its type. An FMT record defines the length, the fields and
/// their names for a type. Signals are named `NAME.FIELD`, or `NAME[2].FIELD` if FMTU marks a field
/// as the instance number of similar sensors. Texts are omitted. c, C, e, E are in hundredths, L in
/// 1e-7 degrees, as the format defines.
#pragma once

#include <string>
#include <string_view>

#include "signals.h"

namespace awmr {

bool is_dataflash(std::string_view bytes);

/// Returns the header of the file and the values of the requested signals. Bytes between records (a
/// lost write) and a file that ends inside a record are skipped and noted. Errors: an FMT record
/// with a wrong length or number of names, an unknown field, or a definition that contradicts an
/// earlier one of its type; too many signals.
Result<Signals> read_dataflash(std::string_view bytes, const std::string& file,
                               const Wanted& wanted);

}  // namespace awmr
