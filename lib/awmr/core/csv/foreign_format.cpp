#include "awmr/core/csv/foreign_format.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "awmr/core/csv/csv_cell.h"

namespace awmr {
namespace {

/// UTF-8 byte order mark, which some programs write at the beginning of a file.
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/// A binary file format, recognised by its first bytes.
struct KnownFile {
  std::string_view begin;
  std::string_view words;
};
constexpr std::array<KnownFile, 5> kKnownFiles{
    {{"PK\x03\x04", "a ZIP archive or an Excel workbook; export the sheet as CSV"},
     {"\xD0\xCF\x11\xE0", "an old Excel workbook; export the sheet as CSV"},
     {"\x1F\x8B", "compressed by gzip; unpack it"},
     {"%PDF-", "a PDF; export the table as CSV"},
     {"\x89MCAP", "an MCAP bag; convert it to sqlite3 with ros2 bag convert"}}};

/// Name of the text format (JSON, HTML or XML) if its files begin with a line such as this one.
/// Empty if the line may be the header of a CSV file.
std::string_view format_of(std::string_view line) {
  const std::string_view text = trimmed(line);
  const std::string_view next = trimmed(text.substr(std::min<std::size_t>(1, text.size())));
  const char after = next.empty() ? '"' : next[0];
  if (text.starts_with('{') && (after == '"' || after == '}')) return "JSON";
  const bool is_value = after == '"' || after == '{' || after == '[' || after == ']';
  if (text.starts_with('[') && is_value) return "JSON";
  const bool is_tag = after == '!' || after == '?' || (after >= 'a' && after <= 'z') ||
                      (after >= 'A' && after <= 'Z');
  if (text.starts_with('<') && is_tag && !next.empty()) return "HTML or XML";
  return {};
}

std::vector<std::string_view> words_in(std::string_view line) {
  std::vector<std::string_view> words;
  for (std::size_t begin = 0; (begin = line.find_first_not_of(" \t", begin)) != line.npos;) {
    const std::size_t end = std::min(line.find_first_of(" \t", begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    begin = end;
  }
  return words;
}

/// True if the scanner's next line is a header whose names are separated by spaces: one of its
/// words is the name of a requested column, or the line below has as many words, and all of these
/// are numbers.
bool is_between_spaces(CsvScanner scanner, const std::set<std::string>& wanted) {
  const std::vector<std::string_view> words = words_in(scanner.peek_line());
  if (words.size() < 2) return false;
  const auto is_wanted = [&](std::string_view word) { return wanted.count(std::string(word)) > 0; };
  if (std::any_of(words.begin(), words.end(), is_wanted)) return true;
  scanner.skip_line();
  const std::vector<std::string_view> row = words_in(scanner.peek_line());
  return row.size() == words.size() &&
         std::all_of(row.begin(), row.end(),
                     [](std::string_view word) { return number_from_text(word).has_value(); });
}

}  // namespace

Result<std::string_view> text_of(std::string_view bytes, const std::string& file) {
  if (bytes.empty()) {
    return input_error(ErrorCode::kBrokenFile, file,
                       "the file is empty; expected a header row and rows");
  }
  for (const KnownFile& known : kKnownFiles) {
    if (bytes.starts_with(known.begin)) {
      return input_error(ErrorCode::kWrongFile, file,
                         fmt::format("this file is not a CSV but {}", known.words));
    }
  }
  if (bytes.find('\0') != std::string_view::npos) {
    return input_error(ErrorCode::kWrongFile, file,
                       "this is not UTF-8 text (UTF-16?); save it as UTF-8");
  }
  if (bytes.starts_with(kByteOrderMark)) bytes.remove_prefix(kByteOrderMark.size());
  return bytes;
}

Status check_format(CsvScanner scanner, const std::string& file) {
  const std::string_view format = format_of(scanner.peek_line());
  if (format.empty()) return {};
  return input_error(ErrorCode::kWrongFile, fmt::format("{}:{}:1", file, scanner.line()),
                     fmt::format("this file is {}, expected CSV; export it as CSV: a row of names, "
                                 "then rows of numbers",
                                 format));
}

Status check_spaces(CsvScanner scanner, const std::string& file,
                    const std::set<std::string>& wanted) {
  scanner.peek_line();
  for (const char delimiter : {',', ';', '\t', '|'}) {
    if (scanner.peek_cells(delimiter).size() != 1) return {};
  }
  if (!is_between_spaces(scanner, wanted)) return {};
  return input_error(ErrorCode::kWrongFile, fmt::format("{}:{}:1", file, scanner.line()),
                     "the cells are separated by spaces; separate them by commas, semicolons or "
                     "tabs");
}

}  // namespace awmr
