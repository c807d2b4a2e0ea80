/// Reads PX4 logs in ULog format (`.ulg`), version 1. Private to this folder.
///
/// Signals are named `TOPIC.FIELD`, `TOPIC[2].FIELD` for further instances of a topic,
/// `TOPIC.FIELD[3]` for arrays, `TOPIC.PART.FIELD` for nested types. Text fields are omitted.
#pragma once

#include <string>
#include <string_view>

#include "signals.h"

namespace awmr {

bool is_ulog(std::string_view bytes);

/// Returns the names of all signals, and the values of the requested ones. A file that ends inside
/// a message (power loss) is read up to this message, with a note. Errors: unknown flags; a format
/// that is malformed, unknown, nested too deeply or larger than a message; a message that is
/// shorter than its format or has no topic; a time that is too large; two topics with the same id;
/// more than kMaxSignals signals.
Result<Signals> read_ulog(std::string_view bytes, const std::string& file, const Wanted& wanted);

}  // namespace awmr
