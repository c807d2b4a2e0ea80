/// The text of a number, as it stands in a CSV cell.
#pragma once

#include <string>
#include <string_view>
#include <tl/expected.hpp>

namespace awmr {

/// Without the spaces and tabs at both ends.
std::string_view trimmed(std::string_view text);

/// A finite decimal number, a leading '+' allowed. Otherwise what was found and what to do instead:
/// for an empty cell, NaN, infinity, a hexadecimal number, a decimal comma, a unit behind the
/// number, a number out of range, any other text.
tl::expected<double, std::string> number_from_text(std::string_view text);

}  // namespace awmr
