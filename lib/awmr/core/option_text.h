/// Option names in messages. The library does not know how its caller spells options: messages mark
/// option names, and the caller formats them for its users.
///
///     option_text("loss huber");                          // a marked name, for a message
///     plain_text("use " + option_text("loss huber"));     // "use loss huber"
///     spell_options("use " + option_text("loss huber"), "--");  // "use --loss huber"
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "awmr/core/result.h"

namespace awmr {

/// `name` is the option's name as in model.json's provenance, with its value if necessary.
std::string option_text(std::string_view name);

/// The message with `prefix` before every option name; with prefix "--", names have hyphens.
std::string spell_options(std::string_view message, std::string_view prefix);

/// The message with the option names unchanged.
std::string plain_text(std::string_view message);

/// The first 20 faults; if there are more, a last one with the number omitted.
std::vector<Fault> shown_faults(const std::vector<Fault>& faults);

/// `PLACE: MESSAGE [CODE]` in one printable line, with `prefix` before every option name.
std::string to_text(const Fault& fault, std::string_view prefix);

/// to_text(error) with `prefix` before every option name; to_text() leaves the names unchanged.
std::string to_text(const Error& error, std::string_view prefix);

}  // namespace awmr
