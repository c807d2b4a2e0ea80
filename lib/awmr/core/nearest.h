/// Suggests the candidate nearest to a misspelt name ("did you mean").
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace awmr {

/// Returns the candidate with the smallest edit distance from `word`; empty if this distance
/// exceeds both 1 and a third of the length of `word`. Texts of more than 100 bytes are ignored.
std::string nearest(std::string_view word, std::span<const std::string> candidates);

/// Returns "; did you mean 'NAME'?" with the nearest candidate; empty if there is none.
std::string did_you_mean(std::string_view word, std::span<const std::string> candidates);

}  // namespace awmr
