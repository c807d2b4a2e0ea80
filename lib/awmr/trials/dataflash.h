/// ArduPilot DataFlash logs (`.bin`): self-describing records. Private to this folder.
///
/// Every record begins with A3 95 and its type; an FMT record says the length, the fields and their
/// names of a type. Signals are called `NAME.FIELD`, and `NAME[2].FIELD` where FMTU marks a field as
/// the number of one of several alike sensors. Texts are left out; c, C, e, E count in hundredths, L
/// in 1e-7 degrees, as the format says.
#pragma once

#include <string>
#include <string_view>

#include "signals.h"

namespace awmr {

bool is_dataflash(std::string_view bytes);

/// The header of the file, and the values of what is wanted. Bytes between records (a write that was
/// lost) and a file that ends inside one are passed over and noted. Errors: an FMT record whose
/// length is not that of its fields, whose names are not as many, that has an unknown field, or that
/// says another thing of a known type; too many signals.
Result<Signals> read_dataflash(std::string_view bytes, const std::string& file,
                               const Wanted& wanted);

}  // namespace awmr
