/// PX4 ULog (`.ulg`): self-describing messages of uORB topics. Private to this folder.
///
/// Read after the public description of the format, version 1: header, definitions (flags, formats),
/// subscriptions and data. Signals are called `TOPIC.FIELD`, `TOPIC[2].FIELD` for further instances,
/// `TOPIC.FIELD[3]` for arrays, `TOPIC.PART.FIELD` for nested types; texts are left out.
#pragma once

#include <string>
#include <string_view>

#include "signals.h"

namespace awmr {

bool is_ulog(std::string_view bytes);

/// The header of the file, and the values of what is wanted. A file that ends inside a message (the
/// power went) is read up to there, and that is noted. Errors: flags of an unknown kind; a format
/// that is malformed, unknown, endless or larger than a message; a message that is shorter than its
/// format or of no topic; too many signals.
Result<Signals> read_ulog(std::string_view bytes, const std::string& file, const Wanted& wanted);

}  // namespace awmr
