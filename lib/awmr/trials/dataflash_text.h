/// ArduPilot DataFlash logs as text (`.log`), a record to a line, as ground stations write them out of the
/// binary ones. Private to this folder.
///
///     FMT, 129, 31, ATT, QffBB, TimeUS,Roll,Yaw,NSats,I
///     ATT, 1000000, 0.5, 91.25, 8, 0
///
/// Signals are called as in the binary form (dataflash.h); values stand there as they are meant, already
/// divided by what the format says.
#pragma once

#include <string>
#include <string_view>

#include "signals.h"

namespace awmr {

bool is_dataflash_text(std::string_view bytes);

/// Lines of an unknown type or with another number of values than their format are passed over and noted;
/// so is a last line that was cut off. Errors, with the line: as read_dataflash(); a value that is no number.
Result<Signals> read_dataflash_text(std::string_view bytes, const std::string& file,
                                    const Wanted& wanted);

}  // namespace awmr
