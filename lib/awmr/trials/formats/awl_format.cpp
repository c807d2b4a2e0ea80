#include "awl_format.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <optional>
#include <set>
#include <utility>

#include "awmr/core/csv/time_column.h"
#include "awmr/core/json/json_document.h"
#include "awmr/core/name_table.h"
#include "awmr/trials/awl.h"
#include "awmr/trials/awl_row.h"
#include "byte_reader.h"

namespace awmr::awl {
namespace {

constexpr NameTable<Kind, 3> kKindNames{
    {{"f32", Kind::kFloat}, {"u32", Kind::kUnsigned}, {"u8", Kind::kByte}}};
constexpr std::string_view kSchema = "awmr.awl/1";
constexpr long kLargestRow = 512;
constexpr std::size_t kLongestName = 64;
const NumberRule kScaleRule{.min = 1e-12, .max = 1e12};
const std::string_view kMagic(reinterpret_cast<const char*>(kLogMagic), sizeof kLogMagic);
const std::string_view kSync(reinterpret_cast<const char*>(kLogSync), sizeof kLogSync);

/// Maximum number of damaged headers in a file. The checksums of more headers would take too long.
constexpr std::size_t kMaxDamagedHeaders = 1000;

/// True if the name of a column has only letters, digits and _. Other characters could damage the
/// CSV header that the name goes into.
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

/// Returns the JSON text of the header that begins at the offset `at`; empty if no header begins
/// there or if its checksum is wrong.
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

/// Parses the JSON text of a header. Errors (input), with the place as `FILE:/pointer`: text that
/// is not JSON; an unknown version; a column with an invalid or duplicate name, or an invalid type
/// or scale; a first column other than t_s; a row size that differs from the sum of its parts.
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

bool is_row(std::string_view bytes, std::size_t at, std::size_t row_bytes) {
  if (bytes.size() - at < row_bytes || !bytes.substr(at).starts_with(kSync)) return false;
  const std::string_view covered = bytes.substr(at + kLogRowCovered, row_bytes - kLogRowCovered);
  std::uint16_t crc = kCrc16Start;
  for (const char c : covered) crc = crc16_with(crc, static_cast<std::uint8_t>(c));
  return crc == number_in<std::uint16_t>(bytes.substr(at + kSync.size()));
}

std::uint32_t sequence_of(std::string_view bytes, std::size_t offset) {
  return number_in<std::uint32_t>(bytes.substr(offset + kLogRowCovered));
}

/// Adds the complete row at the offset `at` to `scan`, and a gap if row numbers before this row are
/// missing. `after_header`: true if a header precedes the row, which then begins a run.
void add_row(std::string_view bytes, std::size_t at, bool after_header, Scan& scan) {
  const std::uint32_t sequence = sequence_of(bytes, at);
  const double t_s = time_of(bytes, at, scan.layout);
  std::size_t run = 1;
  std::size_t missing = sequence;
  std::size_t last_end = 0;
  if (!scan.rows.empty()) {
    const Place& last = scan.rows.back();
    const std::uint32_t before = sequence_of(bytes, last.offset);
    const bool goes_on =
        !after_header && sequence > before && t_s > time_of(bytes, last.offset, scan.layout);
    run = last.run + (goes_on ? 0 : 1);
    if (goes_on) missing = sequence - before - 1;
    last_end = last.offset;
  }
  if (missing > 0) {
    const bool is_damaged = !scan.damaged.empty() && scan.damaged.back().begin >= last_end;
    scan.lost.push_back({missing, t_s, is_damaged});
  }
  scan.rows.push_back({at, run});
}

/// Counts the bytes from `at` to the next possible start of a row or header as damaged. Returns the
/// offset of that start.
std::size_t pass_over(std::string_view bytes, std::size_t at, Scan& scan) {
  const char starts[] = {kMagic[0], kSync[0]};
  const std::size_t found = bytes.find_first_of(std::string_view(starts, sizeof starts), at + 1);
  const std::size_t next = std::min(found, bytes.size());
  if (!scan.damaged.empty() && scan.damaged.back().end == at) {
    scan.damaged.back().end = next;
  } else {
    scan.damaged.push_back({at, next});
  }
  return next;
}

/// Adds the header at the offset `at` to `scan`. Errors (input): its layout differs from that of an
/// earlier header.
Status add_header(std::string_view json, std::size_t at, const std::string& file, Scan& scan) {
  AWMR_ASSIGN_OR_RETURN(Layout layout, layout_of(json, file));
  if (scan.layout.row_bytes > 0 && scan.layout != layout) {
    return input_error(ErrorCode::kBrokenFile, file,
                       fmt::format("byte {}: the columns or parameters of this header differ from "
                                   "those of the header before it; split the file there",
                                   at));
  }
  scan.layout = std::move(layout);
  return {};
}

/// Counts damaged bytes at the end of the file as an incomplete row, not as damage, if they are
/// fewer than the bytes of a row.
void note_end(std::string_view bytes, Scan& scan) {
  if (scan.damaged.empty() || scan.damaged.back().end != bytes.size()) return;
  const std::size_t size = bytes.size() - scan.damaged.back().begin;
  if (size >= scan.layout.row_bytes) return;
  scan.truncated = size;
  scan.damaged.pop_back();
}

}  // namespace

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
  const auto column = std::ranges::find(layout.columns, name, &Column::name);
  if (column == layout.columns.end() || column->kind != Kind::kByte) return 0;
  return number_in<std::uint8_t>(row.substr(column->offset));
}

Result<Scan> scan_of(std::string_view bytes, const std::string& file) {
  Scan scan;
  bool after_header = true;
  std::size_t damaged_headers = 0;
  for (std::size_t at = 0; at < bytes.size();) {
    if (const auto header = header_at(bytes, at)) {
      AWMR_RETURN_IF_ERROR(add_header(*header, at, file, scan));
      after_header = true;
      at += kLogHeaderBytes;
    } else if (scan.layout.row_bytes > 0 && is_row(bytes, at, scan.layout.row_bytes)) {
      add_row(bytes, at, after_header, scan);
      after_header = false;
      at += scan.layout.row_bytes;
    } else {
      if (bytes.substr(at).starts_with(kMagic) && ++damaged_headers > kMaxDamagedHeaders) {
        return input_error(
            ErrorCode::kBrokenFile, file,
            fmt::format("byte {}: more than {} damaged headers; give an undamaged copy of the file",
                        at, kMaxDamagedHeaders));
      }
      at = pass_over(bytes, at, scan);
    }
  }
  if (scan.layout.row_bytes == 0) {
    return input_error(
        ErrorCode::kWrongFile, file,
        "no undamaged header of an awmr log found; give a file that an emitted sketch wrote "
        "(LOG00.AWL)");
  }
  note_end(bytes, scan);
  return scan;
}

double time_of(std::string_view bytes, std::size_t offset, const Layout& layout) {
  return value_in(bytes.substr(offset, layout.row_bytes), layout.columns.front());
}

}  // namespace awmr::awl

namespace awmr {

bool is_awl(std::string_view bytes) {
  constexpr std::size_t kHeaderWithin = 4 * kLogHeaderBytes;
  return bytes.substr(0, kHeaderWithin).find(awl::kMagic) != bytes.npos;
}

}  // namespace awmr
