// The text form of ArduPilot's DataFlash logs has one record per line. Its values are already
// scaled.
//
//     FMT, 129, 31, ATT, QffBB, TimeUS,Roll,Yaw,NSats,I
//     ATT, 1000000, 0.5, 91.25, 8, 0

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "awmr/core/text.h"
#include "dataflash_format.h"
#include "log_formats.h"

namespace awmr {
namespace {

/// Cells of a line, without surrounding blanks.
using Cells = std::vector<std::string_view>;

std::string_view without_blanks(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r";
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

Cells cells_of(std::string_view line) {
  Cells cells = dataflash::split_at_commas(line);
  for (std::string_view& cell : cells) cell = without_blanks(cell);
  return cells;
}

/// Calls `take(cells, line number)` for every line that is not empty.
template <class Take>
Status for_each_line(std::string_view bytes, const Take& take) {
  int number = 1;
  for (std::size_t at = 0; at < bytes.size(); ++number) {
    const std::size_t end = std::min(bytes.find('\n', at), bytes.size());
    const Cells cells = cells_of(bytes.substr(at, end - at));
    if (!cells.front().empty()) AWMR_RETURN_IF_ERROR(take(cells, number));
    at = end + 1;
  }
  return {};
}

template <class Number>
std::optional<Number> number_of(std::string_view text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return number;
}

/// Pads a text to the fixed size of the binary format.
std::string padded(std::string_view text, std::size_t bytes) {
  std::string padded(text.substr(0, bytes));
  padded.resize(bytes, '\0');
  return padded;
}

/// Converts an FMT line to the bytes of an FMT record in the binary format: type, length, name[4],
/// format[16], labels[64].
std::optional<std::string> binary_format(const Cells& cells) {
  constexpr std::size_t kLabels = 5;
  constexpr std::size_t kNameBytes = 4, kKindBytes = 16, kLabelBytes = 64;
  if (cells.size() < kLabels) return std::nullopt;
  const auto type = number_of<std::uint8_t>(cells[1]);
  const auto length = number_of<std::uint8_t>(cells[2]);
  std::string labels;
  for (std::size_t i = kLabels; i < cells.size(); ++i) {
    labels += (i == kLabels ? "" : ",") + std::string(cells[i]);
  }
  if (!type || !length || cells[3].empty() || cells[3].size() > kNameBytes ||
      cells[4].size() > kKindBytes || labels.size() > kLabelBytes) {
    return std::nullopt;
  }
  std::string record{static_cast<char>(*type), static_cast<char>(*length)};
  return record + padded(cells[3], kNameBytes) + padded(cells[4], kKindBytes) +
         padded(labels, kLabelBytes);
}

/// Formats by the name at the beginning of a line.
using NamedFormats = std::map<std::string, dataflash::Format, std::less<>>;

/// Like mark_instance() in dataflash.cpp, for an FMTU line.
void mark_instance_by_units(const Cells& cells, NamedFormats& formats) {
  constexpr std::size_t kType = 2, kUnits = 3;
  const auto type = cells.size() > kUnits ? number_of<std::uint8_t>(cells[kType]) : std::nullopt;
  if (!type) return;
  const std::size_t mark = cells[kUnits].find('#');
  for (auto& [name, format] : formats) {
    if (static_cast<std::uint8_t>(format.definition[0]) != *type) continue;
    if (mark < format.fields.size() && format.fields[mark].kind->bytes == 1) format.instance = mark;
  }
}

/// True if the line has one value per field. If the last field is text, it may contain commas.
bool has_its_fields(const Cells& cells, const dataflash::Format& format) {
  const std::size_t values = cells.size() - 1;
  if (values == format.fields.size()) return true;
  return values > format.fields.size() && !format.fields.empty() &&
         format.fields.back().kind->read == nullptr;
}

/// Returns the format of a line if it is known and the line is complete.
const dataflash::Format* format_of_line(const Cells& cells, const NamedFormats& formats) {
  const auto found = formats.find(cells.front());
  if (found == formats.end() || !has_its_fields(cells, found->second)) return nullptr;
  return &found->second;
}

tl::unexpected<Error> error_at(const std::string& file, int line, const std::string& why) {
  return input_error(ErrorCode::kBrokenFile, fmt::format("{}:{}", file, line), why);
}

Status define(const Cells& cells, const std::string& file, int line, NamedFormats& formats) {
  const std::optional<std::string> record = binary_format(cells);
  if (!record) {
    return error_at(file, line,
                    "invalid format line: expected FMT, type, length, name, format, field names");
  }
  auto format = dataflash::format_of(*record);
  if (!format) return error_at(file, line, format.error());
  const auto [known, is_new] = formats.try_emplace(std::string(cells[3]), *std::move(format));
  if (is_new || known->second.definition == *record) return {};
  return error_at(file, line,
                  fmt::format("a second definition (FMT line) of {} differs from the first "
                              "definition; give each log as a file of its own",
                              printable(known->second.name)));
}

/// Identifies a topic (one signal source): name of the record type, and number of the sensor.
using TextTopic = std::pair<std::string, std::uint8_t>;

/// The topic of a line. Empty if the field with the sensor number does not contain a number.
std::optional<TextTopic> topic_of_line(const Cells& cells, const dataflash::Format& format) {
  if (!format.instance) return TextTopic{format.name, std::uint8_t{0}};
  const auto instance = number_of<std::uint8_t>(cells[1 + *format.instance]);
  if (!instance) return std::nullopt;
  return TextTopic{format.name, *instance};
}

struct TextContents {
  NamedFormats formats = {};
  std::set<TextTopic> topics = {};
  std::size_t lines = 0, skipped = 0;
};

Result<TextContents> text_contents(std::string_view bytes, const std::string& file) {
  TextContents contents;
  AWMR_RETURN_IF_ERROR(for_each_line(bytes, [&](const Cells& cells, int line) -> Status {
    if (cells.front() == "FMT") return define(cells, file, line, contents.formats);
    if (cells.front() == "FMTU") mark_instance_by_units(cells, contents.formats);
    return {};
  }));
  AWMR_RETURN_IF_ERROR(for_each_line(bytes, [&](const Cells& cells, int) -> Status {
    ++contents.lines;
    if (cells.front() == "FMT") return {};
    const dataflash::Format* format = format_of_line(cells, contents.formats);
    const auto topic = format != nullptr ? topic_of_line(cells, *format) : std::nullopt;
    if (!topic) {
      ++contents.skipped;
    } else if (format->time) {
      contents.topics.insert(*topic);
    }
    return {};
  }));
  return contents;
}

std::optional<std::int64_t> time_of_line(const Cells& cells, const dataflash::Format& format) {
  const auto ticks = number_of<std::uint64_t>(cells[1 + *format.time]);
  return ticks ? dataflash::nanoseconds(format, *ticks) : std::nullopt;
}

Status take_line(const Cells& cells, int line, const std::string& file,
                 const dataflash::Format& format, const dataflash::ListedTopic& listed,
                 Topic& topic) {
  const auto time_ns = time_of_line(cells, format);
  if (!time_ns) {
    return error_at(file, line,
                    fmt::format("a record of {} has an invalid time", printable(format.name)));
  }
  topic.time_ns.push_back(*time_ns);
  for (std::size_t i = 0; i < listed.fields.size(); ++i) {
    const std::string_view cell = cells[1 + listed.fields[i]];
    const auto value = number_of<double>(cell);
    if (!value) {
      return error_at(
          file, line,
          fmt::format("{}.{} is not a number: {}", printable(format.name),
                      printable(format.fields[listed.fields[i]].name), printable(cell)));
    }
    topic.values[i].push_back(*value);
  }
  return {};
}

}  // namespace

bool is_dataflash_text(std::string_view bytes) {
  if (!bytes.starts_with("FMT")) return false;
  const std::size_t next = bytes.find_first_not_of(" \t", 3);
  return next != std::string_view::npos && bytes[next] == ',';
}

Result<Signals> read_dataflash_text(std::string_view bytes, const std::string& file,
                                    const Wanted& wanted) {
  // Leaves out a last line without a line end, because this line may be incomplete.
  const std::string_view whole = bytes.substr(0, bytes.rfind('\n') + 1);
  AWMR_ASSIGN_OR_RETURN(TextContents contents, text_contents(whole, file));
  if (whole.size() < bytes.size()) {
    ++contents.lines;
    ++contents.skipped;
  }
  Signals signals;
  std::map<TextTopic, dataflash::ListedTopic> listed;
  for (const TextTopic& key : contents.topics) {
    const dataflash::Format& format = contents.formats.find(key.first)->second;
    listed.emplace(key, dataflash::list_topic(format, key.second, wanted, signals));
  }
  AWMR_RETURN_IF_ERROR(dataflash::check_count(signals, file));
  AWMR_RETURN_IF_ERROR(for_each_line(whole, [&](const Cells& cells, int line) -> Status {
    if (cells.front() == "FMT") return {};
    const dataflash::Format* format = format_of_line(cells, contents.formats);
    if (format == nullptr || !format->time) return {};
    const auto key = topic_of_line(cells, *format);
    const auto entry = key ? listed.find(*key) : listed.end();
    if (entry == listed.end() || entry->second.fields.empty()) return {};
    return take_line(cells, line, file, *format, entry->second,
                     signals.topics[entry->second.topic]);
  }));
  if (contents.skipped > 0) {
    signals.notes.push_back({0, "log-damaged",
                             fmt::format("{} of {} lines have no known format and are skipped",
                                         contents.skipped, contents.lines)});
  }
  return signals;
}

}  // namespace awmr
