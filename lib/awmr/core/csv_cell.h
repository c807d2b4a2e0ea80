/// The text of a CSV cell: a number in, a text out and in again.
#pragma once

#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

namespace awmr {

/// Without the spaces and tabs at both ends.
std::string_view trimmed(std::string_view text);

/// A finite decimal number, a leading '+' allowed. Otherwise what was found and what to do instead:
/// for an empty cell, NaN, infinity, a hexadecimal number, a decimal comma, a unit behind the
/// number, a number out of range, any other text.
tl::expected<double, std::string> number_from_text(std::string_view text);

/// A text as a cell: quoted where it has to be. A text that a spreadsheet would run as a formula
/// (it begins with = + - @, a tab or a carriage return) gets a leading ', and so does one that
/// begins with '.
std::string cell_of_text(std::string_view text);

/// Takes the first record off `csv`, its cells as they were before cell_of_text; a quoted cell may
/// hold line ends. Only for what this program wrote: nothing is checked.
std::vector<std::string> take_text_record(std::string_view& csv);

}  // namespace awmr
