#include "awmr/core/json.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <utility>

#include "awmr/core/file.h"
#include "awmr/core/json_text.h"

namespace awmr {
namespace {

/// `FILE:LINE:COLUMN` of the byte at `offset`, the column in characters.
std::string place_of(const std::string& file, std::string_view text, std::size_t offset) {
  std::string_view before = text.substr(0, std::min(offset, text.size()));
  const auto lines = std::count(before.begin(), before.end(), '\n');
  if (lines == 0 && before.starts_with("\xEF\xBB\xBF")) before.remove_prefix(3);
  before.remove_prefix(before.rfind('\n') + 1);  // npos + 1 is 0
  const auto characters =
      std::count_if(before.begin(), before.end(), [](char c) { return !continues_character(c); });
  return fmt::format("{}:{}:{}", file, lines + 1, characters + 1);
}

/// Follows the parser through the document, to name the keys given twice by their JSON pointer.
class DuplicateKeys {
 public:
  explicit DuplicateKeys(std::string file) : file_(std::move(file)) {}

  bool operator()(int /*depth*/, Json::parse_event_t event, Json& parsed) {
    using Event = Json::parse_event_t;
    if (event == Event::key) note_key(parsed.get<std::string>());
    if (event == Event::object_start || event == Event::array_start) {
      begin_element();
      open_.emplace_back().is_array = event == Event::array_start;
    }
    if (event == Event::object_end || event == Event::array_end) open_.pop_back();
    if (event == Event::value) begin_element();
    return true;
  }
  std::vector<Fault>& faults() { return faults_; }

 private:
  struct Level {
    bool is_array = false;
    std::size_t elements = 0;
    std::string key;
    std::set<std::string> keys;
  };

  void begin_element() {
    if (!open_.empty() && open_.back().is_array)
      open_.back().key = std::to_string(open_.back().elements++);
  }
  void note_key(std::string key) {
    Level& level = open_.back();
    const bool is_new = level.keys.insert(key).second;
    level.key = std::move(key);
    if (is_new) return;
    std::string place = file_ + ":";
    for (const Level& outer : open_) place.append("/").append(pointer_token(outer.key));
    faults_.push_back({std::move(place), "this key stands twice in its object; keep one"});
  }

  std::string file_;
  std::vector<Level> open_;
  std::vector<Fault> faults_;
};

/// The parser's own words, without its prefix "[json.exception...] ... at line 3, column 5: ".
std::string reason_of(const Json::exception& error) {
  const std::string text = error.what();
  const std::size_t prefix = text.find("] ");
  const std::size_t place = text.find(": ");
  if (text.find(" at line ") < place && place != std::string::npos) return text.substr(place + 2);
  return prefix == std::string::npos ? text : text.substr(prefix + 2);
}

/// Where the literal stands that "number overflow parsing '1e999'" names.
std::string place_of_overflow(const std::string& file, std::string_view text,
                              std::string_view reason) {
  const std::size_t open = reason.find('\'');
  const std::size_t close = reason.rfind('\'');
  if (open == close) return file;
  const std::size_t found = text.find(reason.substr(open + 1, close - open - 1));
  return found == std::string_view::npos ? file : place_of(file, text, found);
}

/// nlohmann would print NaN and infinity as null, silently.
void require_finite(const Json& value, const std::string& pointer) {
  if (value.is_number_float() && !std::isfinite(value.get<double>())) {
    throw std::logic_error("a number to be written is not finite: " + pointer);
  }
  if (!value.is_structured()) return;
  std::size_t index = 0;
  for (const auto& [key, element] : value.items()) {
    require_finite(element, pointer + "/" + (value.is_array() ? std::to_string(index++) : key));
  }
}

}  // namespace

Result<Json> read_json_file(const std::filesystem::path& path) {
  const auto text = read_file(path);
  if (!text) return tl::unexpected(text.error());
  const std::string name = path.string();
  if (text->find_first_not_of(" \t\r\n") == std::string::npos) {
    return input_error(name, "the file is empty; expected a JSON object");
  }
  DuplicateKeys duplicates(name);
  Json json;
  try {
    json = Json::parse(*text, std::ref(duplicates));
  } catch (const Json::parse_error& error) {
    // `byte` counts what was read, the byte in fault included.
    const std::size_t offset = error.byte == 0 ? 0 : error.byte - 1;
    return input_error(place_of(name, *text, offset),
                       "this is not valid JSON: " + reason_of(error));
  } catch (const Json::out_of_range& error) {
    const std::string reason = reason_of(error);
    return input_error(place_of_overflow(name, *text, reason),
                       fmt::format("a number is out of range: {}", reason));
  }
  if (!duplicates.faults().empty()) return input_errors(std::move(duplicates.faults()));
  return json;
}

std::string to_text(const Json& json) {
  require_finite(json, "");
  // A name that is no UTF-8, as a path may be, is written with replacement characters.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace awmr
