#include "awmr/trials/recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include "awmr/core/csv.h"
#include "awmr/core/csv/column_sources.h"
#include "awmr/core/csv/csv_cell.h"
#include "awmr/core/csv/csv_scanner.h"
#include "awmr/core/csv/decimal_comma.h"
#include "awmr/core/text.h"
#include "awmr/trials/trial_columns.h"

namespace awmr {
namespace {

/// True for comments and empty lines.
bool is_blank(std::string_view line) {
  const std::size_t first = line.find_first_not_of(" \t");
  return first == std::string_view::npos || line[first] == '#';
}

/// Returns the line without '#', blanks and tabs at its beginning: the text of a comment.
std::string_view without_marks(std::string_view line) {
  return line.substr(std::min(line.find_first_not_of("# \t"), line.size()));
}

bool is_control(char c) {
  return (static_cast<unsigned char>(c) < 0x20U && c != '\t') || c == '\x7f';
}

bool is_number(const CsvCell& cell, char delimiter) {
  DecimalCommas commas;
  return number_from_text(cell.text).has_value() ||
         (delimiter != ',' && number_with_comma(cell, commas).has_value());
}

/// Cells of one line; empty if its quotes are unbalanced.
std::vector<CsvCell> cells_of(std::string_view line, char delimiter) {
  CsvScanner scanner(line);
  scanner.set_delimiter(delimiter);
  std::vector<CsvCell> cells;
  if (scanner.next(cells) != CsvScanner::Outcome::kRecord) cells.clear();
  return cells;
}

/// Parses a line as a header; empty if it does not name a column of a log.
std::optional<CsvHead> header_of(std::string_view line, std::span<const ColumnMapping> mappings) {
  const std::span<const CsvColumn> columns = columns_of(TrialKind::kLog);
  auto head = csv_head(line, "", columns, mappings, 0);
  if (!head) return std::nullopt;
  const std::set<std::string> wanted = wanted_names(columns, mappings);
  const auto is_wanted = [&](const std::string& name) { return wanted.count(name) != 0; };
  if (std::none_of(head->names.begin(), head->names.end(), is_wanted)) return std::nullopt;
  return *std::move(head);
}

}  // namespace

Recording::Recording(std::vector<ColumnMapping> mappings, std::size_t most_bytes)
    : mappings_(std::move(mappings)), most_bytes_(most_bytes) {}

void Recording::add(std::string_view bytes) {
  while (!bytes.empty()) {
    // CR LF, CR and LF each end one line.
    if (bytes.front() == '\n' && after_return_) bytes.remove_prefix(1);
    const std::size_t end = std::min(bytes.find_first_of("\r\n"), bytes.size());
    const std::size_t room = kMaxRecordedLine - line_.size();
    line_too_long_ = line_too_long_ || end > room;
    line_.append(bytes.substr(0, std::min(end, room)));
    after_return_ = end < bytes.size() && bytes[end] == '\r';
    if (end < bytes.size()) end_line();
    bytes.remove_prefix(std::min(end + 1, bytes.size()));
  }
}

void Recording::finish() {
  if (line_.empty() || full_) return;
  put_aside(line_, "the stream ended within this line");
  line_.clear();
}

void Recording::end_line() {
  const std::string line = std::exchange(line_, {});
  const bool too_long = std::exchange(line_too_long_, false);
  full_ = full_ || text_.size() + line.size() > most_bytes_;
  if (full_) return;
  if (too_long) return put_aside(line, fmt::format("it is longer than {} bytes", kMaxRecordedLine));
  take(line);
}

void Recording::take(const std::string& line) {
  if (!has_header() && find_header(line)) return;
  if (!has_header() || is_blank(line)) return put(line);
  if (std::string why = damage_of(line); !why.empty()) return put_aside(line, std::move(why));
  ++rows_;
  put(line);
}

/// Looks for the header in `line`. Returns true if the line itself is the header. A comment with
/// column names becomes the header at the first row below it that has the same number of cells.
bool Recording::find_header(const std::string& line) {
  const std::optional<CsvHead> header = header_of(without_marks(line), mappings_);
  if (is_blank(line)) {
    if (header) commented_ = *header;
    return false;
  }
  if (header) {
    header_ = *header;
    put_before_aside();
    put(line);
    return true;
  }
  const std::size_t cells = cells_of(line, commented_.delimiter).size();
  if (!commented_.names.empty() && cells == commented_.names.size()) header_ = commented_;
  return false;
}

/// Sets aside the lines before the header, that is, turns them into comments.
void Recording::put_before_aside() {
  const std::string before = std::exchange(text_, {});
  lines_ = 0;
  for (std::size_t begin = 0; begin < before.size();) {
    const std::size_t end = before.find('\n', begin);
    const std::string_view old = std::string_view(before).substr(begin, end - begin);
    if (is_blank(old)) {
      put(old);
    } else {
      put_aside(old, "it comes before the header");
    }
    begin = end + 1;
  }
}

/// Reason why the line cannot be a row; empty for a row.
std::string Recording::damage_of(const std::string& line) {
  if (std::any_of(line.begin(), line.end(), is_control)) return "it has control characters";
  const std::vector<CsvCell> cells = cells_of(line, header_.delimiter);
  if (cells.size() != header_.names.size()) {
    return fmt::format("it has {} cells, but the header has {}", cells.size(),
                       header_.names.size());
  }
  const auto same = [](const CsvCell& cell, const std::string& name) { return cell.text == name; };
  if (std::equal(cells.begin(), cells.end(), header_.names.begin(), same)) {
    return "it repeats the header: the board may have restarted";
  }
  if (is_number_.empty()) {
    for (const CsvCell& cell : cells) is_number_.push_back(is_number(cell, header_.delimiter));
  }
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::string_view text = cells[i].text;
    if (!is_number_[i] || is_number(cells[i], header_.delimiter)) continue;
    // A cell without digits, such as "nan", is no sign of damage. The line stays a row, and the
    // reader of the log later reports the cell.
    if (std::any_of(text.begin(), text.end(), is_digit)) {
      return fmt::format("its cell {} is \"{}\", which is not a number", header_.names[i],
                         shortened(text, 40));
    }
  }
  return {};
}

void Recording::put(std::string_view line) {
  text_.append(line) += '\n';
  ++lines_;
}

void Recording::put_aside(std::string_view line, std::string why) {
  constexpr std::size_t kKept = 200;
  put("# " + printable(shortened(line, kKept)));
  if (set_aside_++ > 0) return;
  first_aside_ = lines_;
  first_why_ = std::move(why);
}

std::vector<Finding> Recording::findings(const std::string& file) const {
  if (set_aside_ == 0) return {};
  return {{file, first_aside_, Severity::kWarning, "lines-set-aside",
           fmt::format("{} of {} lines are damaged; they are kept as comments and not used. The "
                       "first damaged line: {}",
                       set_aside_, lines_, first_why_)}};
}

}  // namespace awmr
