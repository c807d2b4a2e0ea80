/// Suggests the candidate nearest to a misspelt name ("did you mean").
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace awmr {

/// The candidate with the smallest edit distance, or empty if the distance exceeds a third of the
/// word's length (at least 1). Names above 100 bytes never match.
std::string nearest(std::string_view word, std::span<const std::string> candidates);

}  // namespace awmr
