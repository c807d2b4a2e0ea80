/// PX4 ULog (`.ulg`): self-describing messages of uORB topics. Private to this folder.
///
/// Follows the public description of the format, version 1: header, definitions (flags, formats),
/// subscriptions and data. Signals are named `TOPIC.FIELD`, `TOPIC[2].FIELD` for further instances,
/// `TOPIC.FIELD[3]` for arrays, `TOPIC.PART.FIELD` for nested types. Texts are omitted.
#pragma once

#include <string>
#include <string_view>

#include "signals.h"

namespace awmr {

bool is_ulog(std::string_view bytes);

/// Returns the header of the file and the values of the requested signals. A file that ends inside
/// a message (power loss) is read up to there, with a note. Errors: unknown flags; a format that is
/// malformed, unknown, endless or larger than a message; a message that is shorter than its format
/// or has no topic; too many signals.
Result<Signals> read_ulog(std::string_view bytes, const std::string& file, const Wanted& wanted);

}  // namespace awmr
