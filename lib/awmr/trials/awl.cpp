#include "awmr/trials/awl.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "awmr/control/safety.h"
#include "awmr/core/csv.h"
#include "awmr/trials/checks/log_channels.h"
#include "awmr/trials/formats/awl_format.h"

namespace awmr {
namespace {

using awl::Column;
using awl::Damage;
using awl::Layout;
using awl::Lost;
using awl::Place;
using awl::Scan;

/// Bits of SafetyFault that mark a row in which heading or speed is too old, or in which a
/// measurement or the reference is not finite.
constexpr unsigned kNotMeasured = kFaultHeadingStale | kFaultSpeedStale | kFaultNotFinite;

/// Bits of the column `reset_cause`, which stores the chip's register MCUSR: the cause of the last
/// reset. [ATmega2560 data sheet, 12.5.1]
constexpr unsigned kBrownOut = 4;
constexpr unsigned kWatchdog = 8;

template <class Items, class TextOf>
std::string list_of(const Items& items, const TextOf& text_of) {
  constexpr std::size_t kMax = 4;
  std::string text;
  for (std::size_t i = 0; i < std::min(kMax, items.size()); ++i) {
    text += (i == 0 ? "" : ", ") + text_of(items[i]);
  }
  return items.size() > kMax ? text + fmt::format(", and {} more", items.size() - kMax) : text;
}

void warn(AwlLog& log, const std::string& file, const char* code, std::string message) {
  const std::string name = std::filesystem::path(file).filename().string();
  log.findings.push_back({name, 0, Severity::kWarning, code, std::move(message)});
}

void report_scan(const Scan& scan, const std::string& file, AwlLog& log) {
  for (const Lost& lost : scan.lost) log.lost += lost.count;
  for (const Damage& damage : scan.damaged) log.damaged_bytes += damage.end - damage.begin;
  if (log.lost > 0) {
    warn(log, file, "rows-lost",
         fmt::format("{} rows are missing: {}", log.lost, list_of(scan.lost, [](const Lost& lost) {
                       return fmt::format("{} before {:.6g} s ({})", lost.count, lost.before_s,
                                          lost.is_damaged ? "the file is damaged there"
                                                          : "the chip had no room to buffer them");
                     })));
  }
  if (log.damaged_bytes > 0) {
    warn(log, file, "log-damaged",
         fmt::format("{} bytes are neither a header nor a complete row and are skipped: {}",
                     log.damaged_bytes, list_of(scan.damaged, [](const Damage& damage) {
                       return fmt::format("bytes {} to {}", damage.begin, damage.end - 1);
                     })));
  }
  if (scan.truncated > 0) {
    warn(log, file, "log-truncated",
         fmt::format("the file ends inside a row, whose {} bytes are not read", scan.truncated));
  }
}

/// Returns the rows with up-to-date measurements and finite values. Reports other rows
/// (`rows-not-measured`).
std::vector<Place> usable_rows(std::string_view bytes, const Scan& scan, const std::string& file,
                               AwlLog& log) {
  const Layout& layout = scan.layout;
  std::vector<Place> measured;
  std::vector<double> not_measured_s;
  for (const Place& place : scan.rows) {
    const std::string_view row = bytes.substr(place.offset, layout.row_bytes);
    const bool is_stale = (awl::bits_in(row, layout, "fault") & kNotMeasured) != 0;
    const bool is_finite = std::all_of(
        layout.columns.begin(), layout.columns.end(),
        [&](const Column& column) { return std::isfinite(awl::value_in(row, column)); });
    if (!is_stale && is_finite) {
      measured.push_back(place);
    } else {
      not_measured_s.push_back(awl::time_of(bytes, place.offset, layout));
    }
  }
  if (!not_measured_s.empty()) {
    warn(log, file, "rows-not-measured",
         fmt::format(
             "{} rows are not used, because heading or speed was too old (no fix or no compass "
             "yet) or a value is not a number; the first of these rows is at {:.6g} s, the last at "
             "{:.6g} s",
             not_measured_s.size(), not_measured_s.front(), not_measured_s.back()));
  }
  return measured;
}

/// Removes and reports runs of fewer than kShortestLog rows. Renumbers the remaining runs from 1.
std::vector<Place> without_short_runs(const std::vector<Place>& rows, const std::string& file,
                                      AwlLog& log) {
  std::vector<Place> kept;
  std::vector<std::size_t> dropped;
  for (std::size_t begin = 0; begin < rows.size();) {
    std::size_t end = begin;
    while (end < rows.size() && rows[end].run == rows[begin].run) ++end;
    if (end - begin < kShortestLog) {
      dropped.push_back(end - begin);
    } else {
      ++log.runs;
      for (std::size_t i = begin; i < end; ++i) kept.push_back({rows[i].offset, log.runs});
    }
    begin = end;
  }
  if (!dropped.empty()) {
    warn(log, file, "short-run",
         fmt::format("{} runs with fewer than {} rows are not used; their numbers of rows: {}. "
                     "Drive longer runs",
                     dropped.size(), kShortestLog,
                     list_of(dropped, [](std::size_t size) { return fmt::format("{}", size); })));
  }
  return kept;
}

void report_resets(std::string_view bytes, const Layout& layout, const std::vector<Place>& rows,
                   const std::string& file, AwlLog& log) {
  std::size_t run = 0;
  for (const Place& place : rows) {
    if (place.run == run) continue;
    run = place.run;
    const std::string_view row = bytes.substr(place.offset, layout.row_bytes);
    const unsigned cause = awl::bits_in(row, layout, "reset_cause");
    if ((cause & (kBrownOut | kWatchdog)) == 0) continue;
    warn(log, file, "chip-reset",
         fmt::format("run {} began with a reset by {}", run,
                     (cause & kWatchdog) != 0 ? "the watchdog: a control step did not end in time"
                                              : "a drop of the supply voltage (brown-out)"));
  }
}

void fill_columns(std::string_view bytes, const Layout& layout, const std::vector<Place>& rows,
                  AwlLog& log) {
  for (const Column& column : layout.columns) {
    log.header.push_back(column.name);
    std::vector<double>& values = log.columns.emplace_back();
    values.reserve(rows.size());
    for (const Place& place : rows) {
      values.push_back(awl::value_in(bytes.substr(place.offset, layout.row_bytes), column));
    }
  }
  log.header.emplace_back("run");
  std::vector<double>& runs = log.columns.emplace_back();
  for (const Place& place : rows) runs.push_back(static_cast<double>(place.run));
}

}  // namespace

Result<AwlLog> read_awl(std::string_view bytes, const std::string& file) {
  AWMR_ASSIGN_OR_RETURN(const Scan scan, awl::scan_of(bytes, file));
  AwlLog log{.parameters_sha256 = scan.layout.parameters_sha256};
  report_scan(scan, file, log);
  const std::vector<Place> rows =
      without_short_runs(usable_rows(bytes, scan, file, log), file, log);
  if (rows.empty()) {
    return refusal(
        ErrorCode::kTooFewData,
        fmt::format("{}: none of the {} complete rows can be used{}", file, scan.rows.size(),
                    log.findings.empty() ? "" : "; " + log.findings.back().message));
  }
  fill_columns(bytes, scan.layout, rows, log);
  report_resets(bytes, scan.layout, rows, file, log);
  return log;
}

std::string log_csv(const AwlLog& log) {
  std::string text;
  for (const std::string& name : log.header) text += (text.empty() ? "" : ",") + name;
  text += '\n';
  for (std::size_t row = 0; row < log.rows(); ++row) {
    for (std::size_t c = 0; c < log.columns.size(); ++c) {
      if (c > 0) text += ',';
      text += format_number(log.columns[c][row]);
    }
    text += '\n';
  }
  return text;
}

}  // namespace awmr
