/// Recognises files that are not CSV, so that one error names the format instead of a fault per
/// row. Private to the library.
#pragma once

#include <set>
#include <string>
#include <string_view>

#include "awmr/core/csv_scanner.h"
#include "awmr/core/result.h"

namespace awmr {

/// The text of a file, without its byte order mark. Errors: it is empty, of a known binary format
/// or not UTF-8.
Result<std::string_view> text_of(std::string_view bytes, const std::string& file);

/// Errors: the next line begins JSON, HTML or XML.
Status check_format(CsvScanner scanner, const std::string& file);

/// Errors: the cells of the header are separated by spaces. `wanted`: names that it can hold.
Status check_spaces(CsvScanner scanner, const std::string& file,
                    const std::set<std::string>& wanted);

}  // namespace awmr
