/// Option names in messages. The command line and Python spell options differently. So the library
/// marks option names in its messages, and the command line or Python replaces each mark by its own
/// spelling.
///
///     option_text("loss huber");                          // a marked name, for a message
///     spell_options("use " + option_text("loss huber"), "--");  // "use --loss huber"
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/core/result.h"

namespace awmr {

/// Marks an option in a message. `name`: the option's name as in the provenance of model.json
/// ("time_limit"), followed by its value if necessary.
std::string option_text(std::string_view name);

/// Replaces each marked name by `prefix` and the name. With the prefix "--", '_' becomes '-'.
std::string spell_options(std::string_view message, std::string_view prefix);

/// Replaces each marked option in a message by the text that `spelling` returns for it: for a name,
/// possibly followed by its value.
std::string replace_options(std::string_view message,
                            const std::function<std::string(std::string_view option)>& spelling);

/// The faults to show to a user. If more than three faults in a file have the same cause, only the
/// first fault is kept; its message gives the number of the omitted faults. The first 20 faults of
/// the result are returned, followed by a fault (`more-faults`) with the number of the rest.
std::vector<Fault> shown_faults(const std::vector<Fault>& faults);

/// One printable line, `PLACE: MESSAGE [CODE]`. Option names are spelt as by spell_options().
std::string to_text(const Fault& fault, std::string_view prefix);

}  // namespace awmr
