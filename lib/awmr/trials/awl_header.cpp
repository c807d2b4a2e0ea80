#include "awl_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <set>

#include "awmr/control/log_row.h"
#include "awmr/core/json_document.h"
#include "awmr/core/time_column.h"
#include "byte_reader.h"

namespace awmr::awl {
namespace {

constexpr std::string_view kSchema = "awmr.awl/1";
constexpr long kLargestRow = 512;
constexpr std::size_t kLongestName = 64;
const NumberRule kScaleRule{.min = 1e-12, .max = 1e12};

/// True if the name of a column has only letters, digits and _. Other characters are not allowed,
/// because the name becomes a cell of a CSV header.
bool is_plain(std::string_view name) {
  constexpr std::string_view kAllowed =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_";
  return name.find_first_not_of(kAllowed) == name.npos;
}

std::size_t bytes_of(Kind kind) { return kind == Kind::kByte ? 1 : 4; }

/// Reads the columns of the header. In a row, each column begins where the previous one ends.
std::vector<Column> columns_in(JsonObject& header) {
  std::vector<Column> columns;
  std::set<std::string> names;
  std::size_t offset = kLogRowHead;
  for (JsonObject& entry : header.objects("columns")) {
    Column column{.name = entry.string("name"),
                  .kind = entry.choice("type", kKindNames),
                  .scale = entry.number("scale", kScaleRule),
                  .offset = offset};
    entry.reject_unknown_keys();
    offset += bytes_of(column.kind);
    if (column.name.empty() || column.name.size() > kLongestName || !is_plain(column.name) ||
        column.name == "run") {
      entry.fault(
          ErrorCode::kBadName, "name",
          fmt::format("expected 1 to {} letters, digits and _ as the column's name, but not 'run'",
                      kLongestName));
    } else if (!names.insert(column.name).second) {
      entry.fault(ErrorCode::kGivenTwice, "name", "another column has this name");
    }
    columns.push_back(std::move(column));
  }
  return columns;
}

}  // namespace

const Column* Layout::find(std::string_view name) const {
  const auto found = std::find_if(columns.begin(), columns.end(),
                                  [&](const Column& column) { return column.name == name; });
  return found == columns.end() ? nullptr : &*found;
}

double value_in(std::string_view row, const Column& column) {
  const std::string_view bytes = row.substr(column.offset);
  switch (column.kind) {
    case Kind::kFloat:
      return column.scale * static_cast<double>(number_in<float>(bytes));
    case Kind::kUnsigned:
      return column.scale * number_in<std::uint32_t>(bytes);
    case Kind::kByte:
      return column.scale * number_in<std::uint8_t>(bytes);
  }
  return 0.0;
}

unsigned bits_in(std::string_view row, const Layout& layout, std::string_view name) {
  const Column* column = layout.find(name);
  if (column == nullptr || column->kind != Kind::kByte) return 0;
  return number_in<std::uint8_t>(row.substr(column->offset));
}

std::optional<std::string_view> header_at(std::string_view bytes, std::size_t at) {
  if (bytes.size() - at < kLogHeaderBytes) return std::nullopt;
  const std::string_view header = bytes.substr(at, kLogHeaderBytes);
  if (std::memcmp(header.data(), kLogMagic, sizeof kLogMagic) != 0) return std::nullopt;
  const std::string_view covered = header.substr(0, kLogHeaderBytes - sizeof(std::uint32_t));
  std::uint32_t crc = kCrc32Start;
  for (const char c : covered) crc = crc32_with(crc, static_cast<std::uint8_t>(c));
  if (~crc != number_in<std::uint32_t>(header.substr(covered.size()))) return std::nullopt;
  return covered.substr(sizeof kLogMagic);
}

Result<Layout> layout_of(std::string_view json, const std::string& file) {
  AWMR_ASSIGN_OR_RETURN(const Json document, read_json_text(json, file));
  std::vector<Fault> faults;
  JsonObject header(document, file, "", faults);
  if (header.string("schema") != kSchema) {
    header.fault(ErrorCode::kWrongFile, "schema",
                 fmt::format("unsupported version of the log; this program reads \"{}\"", kSchema));
    return input_errors(std::move(faults));
  }
  Layout layout{.parameters_sha256 = header.string("parameters_sha256"),
                .row_bytes = static_cast<std::size_t>(header.integer("row_bytes", 1, kLargestRow)),
                .columns = columns_in(header)};
  header.reject_unknown_keys();
  if (faults.empty()) {
    const std::size_t end = layout.columns.empty() ? kLogRowHead
                                                   : layout.columns.back().offset +
                                                         bytes_of(layout.columns.back().kind);
    if (end != layout.row_bytes) {
      header.fault(ErrorCode::kBrokenFile, "row_bytes",
                   fmt::format("found {} bytes per row, but the sync bytes, checksum, row number "
                               "and columns have {} bytes",
                               layout.row_bytes, end));
    } else if (layout.columns.empty() || layout.columns.front().name != kTimeName) {
      header.fault(ErrorCode::kBrokenFile, "columns",
                   fmt::format("the first column must be {}", kTimeName));
    }
  }
  if (!faults.empty()) return input_errors(std::move(faults));
  return layout;
}

}  // namespace awmr::awl
