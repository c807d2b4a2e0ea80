#include "awmr/core/csv_block.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "awmr/core/csv_scanner.h"
#include "awmr/core/exact_number.h"

namespace awmr {
namespace {

bool ends_cell(char c, char delimiter) { return c == delimiter || c == '\n' || c == '\r'; }

/// Sets the top bit of each byte of `word` that equals `c`. Bytes above the first match can be set,
/// too.
std::uint64_t bytes_like(std::uint64_t word, char c) {
  constexpr std::uint64_t kOnes = 0x0101010101010101U;
  const std::uint64_t zero = word ^ (kOnes * static_cast<unsigned char>(c));
  return (zero - kOnes) & ~zero & (kOnes << 7U);
}

/// The first delimiter, line end or quote.
const char* cell_end(const char* text, char delimiter) {
  if constexpr (std::endian::native == std::endian::little) {
    while (true) {
      std::uint64_t word = 0;
      std::memcpy(&word, text, sizeof(word));
      const std::uint64_t found = bytes_like(word, delimiter) | bytes_like(word, '\n') |
                                  bytes_like(word, '\r') | bytes_like(word, '"');
      if (found != 0) return text + std::countr_zero(found) / 8;
      text += sizeof(word);
    }
  } else {
    while (!ends_cell(*text, delimiter) && *text != '"') ++text;
    return text;
  }
}

/// Blank lines, comments and quoted cells begin with one of these, or with blanks followed by one.
bool begins_oddly(char first, char delimiter) {
  return first == '#' || first == '"' || first == '\n' || first == '\r' || first == ' ' ||
         (first == '\t' && delimiter != '\t');
}

}  // namespace

/// A row has at least one byte per cell: its delimiter or line end.
void CsvBlock::make_room(std::size_t bytes, const CsvShape& shape) {
  capacity_ = bytes / shape.cells + 1;
  if (size_ < capacity_ * shape.used.size()) {
    size_ = capacity_ * shape.used.size();
    values_ = std::make_unique_for_overwrite<double[]>(size_);
  }
  slots_.assign(shape.cells, {});
  for (std::size_t place = 0; place < shape.used.size(); ++place) {
    const CsvUsedColumn& column = shape.used[place];
    slots_[column.index] = {.column = &column, .values = values_.get() + place * capacity_};
  }
}

bool CsvBlock::read(std::string_view lines, const CsvShape& shape) {
  make_room(lines.size(), shape);
  rows_ = lines_ = 0;
  has_empty_ = false;
  without_row_.clear();
  // Text has no NUL byte; checked here once for all cells.
  if (lines.find('\0') != std::string_view::npos) return false;
  const char* const end = lines.data() + lines.size();
  for (const char* line = lines.data(); line != end; ++lines_) {
    const char* next = read_row(line, shape.delimiter);
    if (next != nullptr) {
      ++rows_;
    } else {
      const auto left = static_cast<std::size_t>(end - line);
      next = static_cast<const char*>(std::memchr(line, '\n', left)) + 1;
      const std::string_view whole(line, static_cast<std::size_t>(next - line));
      if (!read_odd_line(whole, shape.delimiter)) return false;
    }
    line = next;
  }
  return true;
}

/// Reads an ordinary row. Returns the start of the next line, or null if the line is not one.
const char* CsvBlock::read_row(const char* text, char delimiter) {
  if (begins_oddly(*text, delimiter)) return nullptr;
  const Slot* const last = &slots_.back();
  for (const Slot* slot = slots_.data();; ++slot) {
    text = slot->column != nullptr ? read_cell(text, delimiter, *slot) : cell_end(text, delimiter);
    if (text == nullptr) return nullptr;
    if (slot == last) break;
    if (*text++ != delimiter) return nullptr;
  }
  if (*text == '\r') ++text;
  return *text == '\n' ? text + 1 : nullptr;
}

/// Returns the end of the cell, or null if it is invalid or quoted.
inline const char* CsvBlock::read_cell(const char* text, char delimiter, const Slot& slot) {
  if (!slot.column->is_date) {
    const char* const end = take_exact_number(text, slot.values[rows_]);
    if (end != nullptr && ends_cell(*end, delimiter)) return end;
  }
  const char* const end = cell_end(text, delimiter);
  if (*end == '"') return nullptr;
  return put({text, static_cast<std::size_t>(end - text)}, slot) ? end : nullptr;
}

/// Parses the text of a cell like the whole-text reader; false if it is invalid.
bool CsvBlock::put(std::string_view text, const Slot& slot) {
  const auto value = csv_value(text, *slot.column);
  if (!value) return false;
  slot.values[rows_] = *value;
  has_empty_ = has_empty_ || std::isnan(*value);
  return true;
}

/// Parses a line that is not an ordinary row, with the whole-text reader's rules.
bool CsvBlock::read_odd_line(std::string_view line, char delimiter) {
  CsvScanner scanner(line);
  scanner.set_delimiter(delimiter);
  std::vector<CsvCell> cells;
  const CsvScanner::Outcome outcome = scanner.next(cells);
  if (scanner.left() > 0 || scanner.line() != 2) return false;
  if (outcome == CsvScanner::Outcome::kEnd) {
    without_row_.push_back(lines_);
    return true;
  }
  if (outcome != CsvScanner::Outcome::kRecord || cells.size() != slots_.size()) return false;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (slots_[i].column != nullptr && !put(cells[i].text, slots_[i])) return false;
  }
  ++rows_;
  return true;
}

}  // namespace awmr
