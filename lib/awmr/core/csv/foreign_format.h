/// Recognises files that are not CSV. The user then gets one error with the format of the file,
/// instead of a fault for each row. Private to the library.
#pragma once

#include <set>
#include <string>
#include <string_view>

#include "awmr/core/csv/csv_scanner.h"
#include "awmr/core/result.h"

namespace awmr {

/// The text of a file, without its byte order mark. Errors: the file is empty, of a known binary
/// format, or has NUL bytes, as UTF-16 has.
Result<std::string_view> text_of(std::string_view bytes, const std::string& file);

/// Checks the scanner's next line. Errors: it is the beginning of JSON, HTML or XML.
Status check_format(CsvScanner scanner, const std::string& file);

/// Checks the scanner's next line, which should be a header. Errors: spaces separate its cells.
/// `wanted`: names of the requested columns, which identify a header.
Status check_spaces(CsvScanner scanner, const std::string& file,
                    const std::set<std::string>& wanted);

}  // namespace awmr
