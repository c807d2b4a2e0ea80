/// Options in messages. The library does not know how its caller spells options: a message marks
/// where it names one, and the caller writes it out for its own users.
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

/// `name` is the option's, as in model.json's provenance, with its value where one is meant.
std::string option_text(std::string_view name);

/// The message with every option's name after `prefix`; after "--" with hyphens, as a command line has it.
std::string spell_options(std::string_view message, std::string_view prefix);

/// The message with the options' names as they are.
std::string plain_text(std::string_view message);

/// The first 20 and, where there are more, a last one with the number left out: what a person sees.
std::vector<Fault> shown_faults(const std::vector<Fault>& faults);

/// to_text(error) with every option's name after `prefix`; to_text() itself gives them as they are.
std::string to_text(const Error& error, std::string_view prefix);

}  // namespace awmr
