#include "awl_scan.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "awmr/control/log_row.h"
#include "byte_reader.h"

namespace awmr::awl {
namespace {

const std::string_view kMagic(reinterpret_cast<const char*>(kLogMagic), sizeof kLogMagic);
const std::string_view kSync(reinterpret_cast<const char*>(kLogSync), sizeof kLogSync);

/// Maximum number of damaged headers; a file with more is refused, because computing their
/// checksums would take too long.
constexpr std::size_t kMaxDamagedHeaders = 1000;

/// The first header of a log begins within this number of bytes.
constexpr std::size_t kHeaderWithin = 4 * kLogHeaderBytes;

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

/// Adds the complete row at the offset `at` to `scan`. If row numbers are missing before it, adds
/// this gap, too. `after_header`: true if a header precedes the row, which then begins a run.
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
                       fmt::format("byte {}: this header has other columns or parameters than the "
                                   "header before it; split the file there",
                                   at));
  }
  scan.layout = std::move(layout);
  return {};
}

/// If damaged bytes at the end of the file are fewer than the bytes of a row, counts them as an
/// incomplete row. They are then not reported as damage.
void note_end(std::string_view bytes, Scan& scan) {
  if (scan.damaged.empty() || scan.damaged.back().end != bytes.size()) return;
  const std::size_t size = bytes.size() - scan.damaged.back().begin;
  if (size >= scan.layout.row_bytes) return;
  scan.truncated = size;
  scan.damaged.pop_back();
}

}  // namespace

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

bool begins_log(std::string_view bytes) {
  return bytes.substr(0, kHeaderWithin).find(kMagic) != bytes.npos;
}

}  // namespace awmr::awl
