/// Reads ArduPilot DataFlash logs in their text form (`.log`), as ground stations export them: one
/// record per line. Private to this folder.
///
///     FMT, 129, 31, ATT, QffBB, TimeUS,Roll,Yaw,NSats,I
///     ATT, 1000000, 0.5, 91.25, 8, 0
///
/// Signals have the same names as those of the binary format (dataflash.h). The values in the file
/// are already scaled.
#pragma once

#include <string>
#include <string_view>

#include "signals.h"

namespace awmr {

bool is_dataflash_text(std::string_view bytes);

/// Like read_dataflash(), but for the text form. Lines of an unknown type, lines with a wrong
/// number of values and an incomplete last line are skipped, with a note. Errors, with the line:
/// those of read_dataflash(); a value that is not a number.
Result<Signals> read_dataflash_text(std::string_view bytes, const std::string& file,
                                    const Wanted& wanted);

}  // namespace awmr
