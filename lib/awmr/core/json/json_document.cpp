#include "awmr/core/json/json_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <unordered_set>
#include <utility>

#include "awmr/core/input_file.h"
#include "awmr/core/json/json_fault.h"
#include "awmr/core/text.h"

namespace awmr {
namespace {

/// Place of the byte at `offset` for messages, `FILE:LINE:COLUMN`. COLUMN counts characters.
std::string place_of(const std::string& file, std::string_view text, std::size_t offset) {
  std::string_view before = text.substr(0, std::min(offset, text.size()));
  const auto lines = std::count(before.begin(), before.end(), '\n');
  if (lines == 0 && before.starts_with("\xEF\xBB\xBF")) before.remove_prefix(3);
  // Keeps the last line. If there is no line end, rfind() returns npos, and npos + 1 is 0.
  before.remove_prefix(before.rfind('\n') + 1);
  const auto characters =
      std::count_if(before.begin(), before.end(), [](char c) { return !continues_character(c); });
  return fmt::format("{}:{}:{}", file, lines + 1, characters + 1);
}

/// Returns the fault of a text that exceeds kMaxJsonDepth or kMaxJsonValues; else empty. Checked
/// before the text is parsed, so that a hostile file cannot exhaust the memory.
std::optional<Fault> beyond_bounds(const std::string& file, std::string_view text) {
  std::size_t depth = 0;
  std::size_t values = 1;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string && c == '\\') ++i;
    if (c == '"') in_string = !in_string;
    if (in_string) continue;
    if (c == '[' || c == '{') ++depth;
    if ((c == ']' || c == '}') && depth > 0) --depth;
    if (c == ',' || c == '[' || c == '{') ++values;
    if (depth > kMaxJsonDepth) {
      return Fault{
          ErrorCode::kTooLarge, place_of(file, text, i),
          fmt::format("this is not a file of awmr: its arrays and objects are nested more than "
                      "{} deep; give another file",
                      kMaxJsonDepth)};
    }
    if (values > kMaxJsonValues) {
      return Fault{
          ErrorCode::kTooLarge, place_of(file, text, i),
          fmt::format("the file has more than {} values; give another file", kMaxJsonValues)};
    }
  }
  return std::nullopt;
}

/// Builds the document from the events of the parser, and reports duplicate keys. Replaces the
/// builder of nlohmann/json, whose time grows with the square of the number of keys.
class DocumentBuilder final : public Json::json_sax_t {
 public:
  explicit DocumentBuilder(std::string file, std::string_view text)
      : file_(std::move(file)), text_(text) {}

  bool null() override { return add(nullptr); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(number_integer_t value) override { return add(value); }
  bool number_unsigned(number_unsigned_t value) override { return add(value); }
  bool number_float(number_float_t value, const string_t& /*text*/) override { return add(value); }
  bool string(string_t& value) override { return add(std::move(value)); }
  bool binary(binary_t& /*value*/) override { return false; }  // JSON text has no binary values
  bool start_object(std::size_t /*size*/) override { return open(Json::object()); }
  bool key(string_t& value) override;
  bool end_object() override { return close(); }
  bool start_array(std::size_t /*size*/) override { return open(Json::array()); }
  bool end_array() override { return close(); }
  bool parse_error(std::size_t position, const std::string& last_token,
                   const Json::exception& error) override;

  Json& document() { return document_; }
  std::vector<Fault>& faults() { return faults_; }

 private:
  /// An array or object that is still open.
  struct Level {
    Json value;
    std::string key;                       ///< of an object: key of the value that follows
    std::unordered_set<std::string> keys;  ///< of an object: the keys read so far
  };

  bool open(Json value) {
    levels_.push_back({std::move(value), "", {}});
    return true;
  }
  bool add(Json value);
  bool close();

  std::string file_;
  std::string_view text_;
  std::vector<Level> levels_;
  Json document_;
  std::vector<Fault> faults_;
};

bool DocumentBuilder::add(Json value) {
  if (levels_.empty()) {
    document_ = std::move(value);
  } else if (Level& level = levels_.back(); level.value.is_array()) {
    level.value.push_back(std::move(value));
  } else {
    // Json stores an object as a list of pairs in their order. key() has already refused duplicate
    // keys.
    std::vector<Json::object_t::value_type>& members = level.value.get_ref<Json::object_t&>();
    members.emplace_back(std::move(level.key), std::move(value));
  }
  return true;
}

bool DocumentBuilder::close() {
  Json value = std::move(levels_.back().value);
  levels_.pop_back();
  return add(std::move(value));
}

bool DocumentBuilder::key(string_t& value) {
  Level& level = levels_.back();
  level.key = std::move(value);
  if (level.keys.insert(level.key).second || faults_.size() >= kMaxFaults) return true;
  std::string place = file_ + ":";
  for (const Level& outer : levels_) {
    const bool is_array = outer.value.is_array();
    place.append("/").append(is_array ? std::to_string(outer.value.size())
                                      : pointer_token(outer.key));
  }
  faults_.push_back(
      {ErrorCode::kGivenTwice, std::move(place), "this key appears twice in its object; keep one"});
  return true;
}

/// Message of the parser without its prefix "[json.exception...] ... at line 3, column 5: ".
std::string reason_of(const Json::exception& error) {
  const std::string text = error.what();
  const std::size_t prefix = text.find("] ");
  const std::size_t place = text.find(": ");
  if (text.find(" at line ") < place && place != std::string::npos) return text.substr(place + 2);
  return prefix == std::string::npos ? text : text.substr(prefix + 2);
}

bool DocumentBuilder::parse_error(std::size_t position, const std::string& last_token,
                                  const Json::exception& error) {
  const std::string reason = reason_of(error);
  if (dynamic_cast<const Json::out_of_range*>(&error) != nullptr) {
    const std::size_t begin = position - std::min(position, last_token.size());
    faults_ = {{ErrorCode::kOutOfRange, place_of(file_, text_, begin),
                "a number is out of range: " + reason}};
  } else {
    // `position` is the number of bytes read, including the faulty one.
    const std::size_t offset = position == 0 ? 0 : position - 1;
    faults_ = {{ErrorCode::kBrokenFile, place_of(file_, text_, offset),
                "this is not valid JSON: " + reason}};
  }
  return false;
}

/// Throws for NaN and infinity, which nlohmann/json would write as null.
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

Result<Json> read_json_text(std::string_view text, const std::string& file) {
  if (text.find_first_not_of(" \t\r\n") == std::string_view::npos) {
    return input_error(ErrorCode::kBrokenFile, file, "the file is empty; expected a JSON object");
  }
  if (auto fault = beyond_bounds(file, text)) return input_errors({std::move(*fault)});
  DocumentBuilder builder(file, text);
  Json::sax_parse(text, &builder);
  if (!builder.faults().empty()) return input_errors(std::move(builder.faults()));
  return std::move(builder.document());
}

Status check_json_text(std::string_view text, const std::string& file) {
  AWMR_RETURN_IF_ERROR(read_json_text(text, file));
  return {};
}

Result<Json> read_json_file(const std::filesystem::path& path) {
  AWMR_ASSIGN_OR_RETURN(const std::string text, read_input(path, kMaxJsonBytes));
  return read_json_text(text, path.string());
}

std::string to_text(const Json& json) {
  require_finite(json, "");
  // A text that is not UTF-8, such as a path, is written with replacement characters.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace awmr
