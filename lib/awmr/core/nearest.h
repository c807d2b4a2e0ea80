/// "did you mean": the candidate nearest to a misspelt name.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace awmr {

/// The candidate with the smallest edit distance, or empty where none is near (distance above a
/// third of the word's length, at least 1). Names above 100 bytes are near to none.
std::string nearest(std::string_view word, std::span<const std::string> candidates);

}  // namespace awmr
