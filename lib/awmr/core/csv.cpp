#include "awmr/core/csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "awmr/core/csv_cell.h"
#include "awmr/core/csv_scanner.h"
#include "awmr/core/csv_text.h"
#include "awmr/core/input_file.h"
#include "awmr/core/nearest.h"
#include "awmr/core/option_text.h"
#include "awmr/core/text.h"

namespace awmr {
namespace {

constexpr std::size_t kMaxFaults = 100;
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/// The text of a cell with its doubled quotes made single.
std::string name_of(const CsvCell& cell) {
  std::string name;
  for (std::size_t i = 0; i < cell.text.size(); ++i) {
    name += cell.text[i];
    if (cell.is_quoted && cell.text.substr(i, 2) == "\"\"") ++i;
  }
  return name;
}

/// The header's names, as many as can be read at a glance.
std::string listed(std::span<const std::string> names) {
  constexpr std::size_t kMost = 20;
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kMost); ++i) {
    text += (i == 0 ? "" : ", ") + shortened(names[i], 60);
  }
  if (names.size() > kMost) text += fmt::format(" and {} more", names.size() - kMost);
  return text;
}

}  // namespace

/// Header, then rows, gathering faults until there are too many to be of use.
class CsvParser {
 public:
  CsvParser(std::string file, std::string_view bytes, std::span<const CsvColumn> columns,
            std::span<const ColumnMapping> mappings)
      : scanner_(bytes), columns_(columns), mappings_(mappings) {
    table_.file_ = std::move(file);
  }

  Result<CsvTable> parse() {
    if (read_header()) {
      while (faults_.size() < kMaxFaults && read_row()) {
      }
      if (faults_.empty() && table_.rows() == 0) {
        fault(table_.header_line_, 1, "there are no rows below the header");
      }
    }
    if (!faults_.empty()) return input_errors(std::move(faults_));
    return std::move(table_);
  }

 private:
  /// A column of the file that is read.
  struct Used {
    std::string name;
    std::size_t index;
    const ColumnMapping* mapping;  ///< null: taken as it is
    CsvTable::Column* values;
  };

  void fault(int line, int character, std::string message) {
    faults_.push_back({fmt::format("{}:{}:{}", table_.file_, line, character), std::move(message)});
  }

  bool read_header();
  void choose_delimiter();
  int score(char delimiter);
  bool scan(CsvScanner& scanner);
  void find_column(const CsvColumn& column);
  void use(const CsvColumn& column, const std::string& source, const ColumnMapping* mapping);
  void report_missing(const std::string& name, const std::string& source);
  bool read_row();
  void report_ragged();
  void read_cells();

  CsvScanner scanner_;
  std::span<const CsvColumn> columns_;
  std::span<const ColumnMapping> mappings_;
  std::vector<CsvCell> cells_;
  std::vector<CsvCell> header_cells_;
  std::vector<std::string> header_;
  std::vector<Used> used_;
  std::vector<Fault> faults_;
  CsvTable table_;
};

/// Fills `cells_` with the next record; false at the end and after a quote that is never closed.
/// After another fault in a record `cells_` is empty.
bool CsvParser::scan(CsvScanner& scanner) {
  switch (scanner.next(cells_)) {
    case CsvScanner::Outcome::kRecord:
      return true;
    case CsvScanner::Outcome::kEnd:
      return false;
    case CsvScanner::Outcome::kOpenQuote:
      fault(cells_.back().line, cells_.back().character, "this quote is not closed");
      return false;
    case CsvScanner::Outcome::kTextAfterQuote:
      fault(
          cells_.back().line, cells_.back().character,
          "there is text between the closing quote of this cell and the delimiter; double a quote "
          "inside a quoted cell");
      scanner.skip_line();
      cells_.clear();
      return true;
  }
  return false;
}

/// Columns asked for that a delimiter finds in the header, then the number of cells.
int CsvParser::score(char delimiter) {
  CsvScanner scanner = scanner_;
  scanner.set_delimiter(delimiter);
  std::vector<CsvCell> cells;
  scanner.next(cells);  // up to a fault, if there is one
  int found = 0;
  for (const CsvCell& cell : cells) {
    const std::string name = name_of(cell);
    const auto is_column = [&](const CsvColumn& column) { return column.name == name; };
    const auto is_source = [&](const ColumnMapping& mapping) { return mapping.source == name; };
    if (std::any_of(columns_.begin(), columns_.end(), is_column) ||
        std::any_of(mappings_.begin(), mappings_.end(), is_source)) {
      ++found;
    }
  }
  return 10000 * found + static_cast<int>(std::min<std::size_t>(cells.size(), 9999));
}

void CsvParser::choose_delimiter() {
  int best = 0;
  char chosen = ',';
  for (const char delimiter : {',', ';', '\t'}) {
    if (const int points = score(delimiter); points > best) {
      best = points;
      chosen = delimiter;
    }
  }
  scanner_.set_delimiter(chosen);
}

bool CsvParser::read_header() {
  scanner_.peek_line();
  table_.header_line_ = scanner_.line();
  choose_delimiter();
  const std::size_t before = faults_.size();
  if (!scan(scanner_)) {
    if (faults_.size() == before) {
      faults_.push_back({table_.file_, "the file has no header row; expected the columns' names"});
    }
    return false;
  }
  if (cells_.empty()) return false;
  header_cells_ = cells_;
  for (const CsvCell& cell : cells_) header_.push_back(name_of(cell));
  if (std::all_of(header_.begin(), header_.end(),
                  [](const std::string& name) { return number_from_text(name).has_value(); })) {
    fault(table_.header_line_, 1, "this row holds numbers; expected the columns' names");
    return false;
  }
  for (const CsvColumn& column : columns_) find_column(column);
  return true;
}

/// A mapping counts where the file has its SOURCE; else the column is looked for under its own
/// name.
void CsvParser::find_column(const CsvColumn& column) {
  const auto stands = [&](const std::string& name) {
    return std::find(header_.begin(), header_.end(), name) != header_.end();
  };
  const ColumnMapping* chosen = nullptr;
  const ColumnMapping* absent = nullptr;
  for (const ColumnMapping& mapping : mappings_) {
    if (mapping.name != column.name) continue;
    if (!stands(mapping.source)) {
      absent = &mapping;
    } else if (chosen == nullptr) {
      chosen = &mapping;
    } else {
      fault(table_.header_line_, 1,
            fmt::format("two mappings give the column {}: \"{}\" and \"{}\"; keep one", column.name,
                        chosen->source, mapping.source));
    }
  }
  if (chosen != nullptr) {
    use(column, chosen->source, chosen);
  } else if (stands(column.name)) {
    use(column, column.name, nullptr);
  } else if (column.required) {
    report_missing(column.name, absent != nullptr ? absent->source : column.name);
  }
}

void CsvParser::use(const CsvColumn& column, const std::string& source,
                    const ColumnMapping* mapping) {
  const auto first = std::find(header_.begin(), header_.end(), source);
  const auto second = std::find(first + 1, header_.end(), source);
  if (second != header_.end()) {
    const CsvCell& cell = header_cells_[static_cast<std::size_t>(second - header_.begin())];
    fault(
        cell.line, cell.character,
        fmt::format("the column \"{}\" stands twice in the header; rename or remove one", source));
    return;
  }
  used_.push_back({column.name, static_cast<std::size_t>(first - header_.begin()), mapping,
                   &table_.columns_[column.name]});
}

void CsvParser::report_missing(const std::string& name, const std::string& source) {
  std::string message =
      source == name ? fmt::format("the column {} is missing", name)
                     : fmt::format("the column \"{}\", mapped to {}, is missing", source, name);
  if (const std::string near = nearest(source, header_); !near.empty()) {
    message += fmt::format("; did you mean \"{}\"?", near);
  } else {
    message += fmt::format("; the header has {}; rename one or map it with {}", listed(header_),
                           option_text(fmt::format("column {}=SOURCE", name)));
  }
  fault(table_.header_line_, 1, std::move(message));
}

bool CsvParser::read_row() {
  if (!scan(scanner_)) return false;
  if (cells_.empty()) return true;
  if (cells_.size() != header_.size()) {
    report_ragged();
  } else {
    read_cells();
  }
  return true;
}

void CsvParser::report_ragged() {
  const CsvCell& cell = cells_.size() > header_.size() ? cells_[header_.size()] : cells_.back();
  std::string message =
      fmt::format("this row has {} cells, the header {}", cells_.size(), header_.size());
  if (cells_.size() == 2 * header_.size()) {
    message += "; if these are decimal commas, write numbers with a point";
  }
  fault(cell.line, cell.character, std::move(message));
}

void CsvParser::read_cells() {
  table_.lines_.push_back(cells_.front().line);
  for (const Used& used : used_) {
    const CsvCell& cell = cells_[used.index];
    auto value = number_from_text(cell.text);
    if (value && used.mapping != nullptr) {
      *value = *value * used.mapping->scale + used.mapping->offset;
      if (!std::isfinite(*value)) value = tl::unexpected(std::string("out of range once scaled"));
    }
    if (!value) {
      fault(cell.line, cell.character, fmt::format("column {}: {}", used.name, value.error()));
      continue;
    }
    used.values->values.push_back(*value);
    used.values->character.push_back(cell.character);
  }
}

Result<CsvTable> read_csv_text(std::string_view bytes, const std::string& file,
                               std::span<const CsvColumn> columns,
                               std::span<const ColumnMapping> mappings) {
  if (bytes.empty()) {
    return input_error(file, "the file is empty; expected a header row and rows");
  }
  if (bytes.find('\0') != std::string_view::npos) {
    return input_error(file, "this is not UTF-8 text (UTF-16?); save it as UTF-8");
  }
  if (bytes.starts_with(kByteOrderMark)) bytes.remove_prefix(kByteOrderMark.size());
  return CsvParser(file, bytes, columns, mappings).parse();
}

Result<CsvTable> read_csv(const std::filesystem::path& path, std::span<const CsvColumn> columns,
                          std::span<const ColumnMapping> mappings) {
  AWMR_ASSIGN_OR_RETURN(const std::string bytes, read_input(path));
  return read_csv_text(bytes, path.string(), columns, mappings);
}

}  // namespace awmr
