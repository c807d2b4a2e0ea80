/// Strict reader of JSON files. Unknown, missing and duplicate keys and values out of range are
/// faults, each with its JSON pointer. All faults of a file are reported at once. Also writes JSON.
/// Include this header from .cpp files only, because nlohmann/json is slow to compile.
#pragma once

#include <concepts>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "awmr/core/interval.h"
#include "awmr/core/name_table.h"
#include "awmr/core/number_rule.h"
#include "awmr/core/provenance.h"
#include "awmr/core/result.h"

namespace awmr {

using Json = nlohmann::ordered_json;

/// Parses a file. Errors: those of read_input() and read_json_text().
Result<Json> read_json_file(const std::filesystem::path& path);

class JsonShape;
class JsonObject;

/// Function that reads the keys of an object. It may return a value. It takes `JsonObject&`: a copy
/// would not mark the keys of the object as known.
template <class Read>
concept ObjectReader =
    std::invocable<const Read&, JsonObject&> && !std::invocable<const Read&, JsonObject>;

/// A strict view of one JSON object. Each function that reads a key marks the key as known. Faults:
/// a value of the wrong type or out of range; a missing key (except in the optional_ functions). On
/// a fault, the function adds it to the shared list and returns a neutral value: NaN, `min` of an
/// integer, the first of several choices, false or empty. So reading continues and finds all faults
/// of the file. Call `reject_unknown_keys()` after all keys were read.
class JsonObject {
 public:
  JsonObject(const Json& value, std::string file, std::string pointer, std::vector<Fault>& faults);
  /// A view without a document, for json_schema_text(): records the requested keys in `shape` and
  /// returns neutral values.
  JsonObject(JsonShape& shape, std::vector<Fault>& ignored) : faults_(&ignored), shape_(&shape) {}

  /// True if the object has the key, even with the value null. Marks the key as known.
  bool has(std::string_view key);
  /// Number of elements in the array or object under the key. It counts faulty elements as well,
  /// which numbers() and strings() leave out. Absent if the key is missing or has another type.
  std::optional<std::size_t> size(std::string_view key) const;
  double number(std::string_view key, NumberRule rule = kAnyNumber);
  std::optional<double> optional_number(std::string_view key, NumberRule rule = kAnyNumber) {
    return has(key) ? std::optional(number(key, rule)) : std::nullopt;
  }
  /// `null` is allowed and gives nullopt; a missing key is a fault.
  std::optional<double> nullable_number(std::string_view key, NumberRule rule = kAnyNumber);
  long integer(std::string_view key, long min, long max);
  std::optional<long> optional_integer(std::string_view key, long min, long max) {
    return has(key) ? std::optional(integer(key, min, max)) : std::nullopt;
  }
  bool boolean(std::string_view key);
  std::optional<bool> optional_boolean(std::string_view key) {
    return has(key) ? std::optional(boolean(key)) : std::nullopt;
  }
  std::string string(std::string_view key);
  std::optional<std::string> optional_string(std::string_view key) {
    return has(key) ? std::optional(string(key)) : std::nullopt;
  }
  /// A whole number from 0 to 2^64 - 1; 0 on a fault.
  std::uint64_t seed(std::string_view key);
  /// The value as text: a string, or a number in the range of `rule`. Empty if the key is missing
  /// or on a fault.
  std::optional<std::string> optional_number_or_string(std::string_view key, NumberRule rule);
  /// A string that is one of `choices`. Returns its index in `choices`. On a fault, returns 0, and
  /// the fault suggests the nearest choice.
  std::size_t choice(std::string_view key, std::span<const std::string> choices);
  /// Reads a string that is a name in `table` and returns the value of this name. On a fault,
  /// returns the first value of the table.
  template <class T, std::size_t N>
  T choice(std::string_view key, const NameTable<T, N>& table) {
    return table[choice(key, std::span<const std::string>(names_in(table)))].value;
  }
  /// `[lo, hi]` with lo <= hi and both ends in the range of the rule; [0, 0] on a fault.
  Interval interval(std::string_view key, NumberRule rule = kAnyNumber);
  std::optional<Interval> optional_interval(std::string_view key, NumberRule rule = kAnyNumber) {
    return has(key) ? std::optional(interval(key, rule)) : std::nullopt;
  }
  std::optional<Interval> nullable_interval(std::string_view key);
  std::vector<double> numbers(std::string_view key, NumberRule rule = kAnyNumber);
  std::vector<std::string> strings(std::string_view key);
  /// The array under the key. The caller must check that its elements are arrays of numbers. Null
  /// if the key is missing, which is a fault.
  const Json* rows(std::string_view key);
  /// The object under the key. If it is missing or not an object (a fault), returns an empty view
  /// that reports no further faults.
  JsonObject object(std::string_view key);
  std::optional<JsonObject> optional_object(std::string_view key) {
    return has(key) ? std::optional(object(key)) : std::nullopt;
  }
  /// Returns read(*this), and then rejects the keys that it did not read.
  template <ObjectReader Read>
  auto read_by(const Read& read) {
    if constexpr (std::is_void_v<decltype(read(*this))>) {
      read(*this);
      reject_unknown_keys();
    } else {
      auto value = read(*this);
      reject_unknown_keys();
      return value;
    }
  }
  /// Reads the object under the key by read_by().
  template <ObjectReader Read>
  auto object(std::string_view key, const Read& read) {
    return object(key).read_by(read);
  }
  template <ObjectReader Read>
  auto optional_object(std::string_view key, const Read& read) {
    using Value = decltype(read(*this));
    if constexpr (std::is_void_v<Value>) {
      if (has(key)) object(key, read);
    } else {
      return has(key) ? std::optional<Value>(object(key, read)) : std::optional<Value>();
    }
  }
  /// The elements of an array of objects.
  std::vector<JsonObject> objects(std::string_view key);
  std::vector<JsonObject> optional_objects(std::string_view key) {
    return has(key) ? objects(key) : std::vector<JsonObject>();
  }
  /// The values of this object, if its keys are arbitrary and its values are all objects.
  std::vector<JsonObject> values();
  /// As above, but each function reads every object by read_by(), and returns the values.
  template <ObjectReader Read>
  auto objects(std::string_view key, const Read& read) {
    return read_all(objects(key), read);
  }
  template <ObjectReader Read>
  auto optional_objects(std::string_view key, const Read& read) {
    return read_all(optional_objects(key), read);
  }
  template <ObjectReader Read>
  auto values(const Read& read) {
    return read_all(values(), read);
  }
  /// Marks a key as known without reading its value; the key may be missing.
  void ignore(std::string_view key);
  /// Reads the optional key `schema`. Call it before all other keys are read: if the value is not
  /// `expected`, the file is of another kind. This is a fault, and the view then reports no further
  /// faults.
  void schema(std::string_view expected);
  /// All keys of the object, in the order of the file; for objects with arbitrary keys.
  std::vector<std::string> keys() const;

  /// Adds a fault at the key's place (FILE:POINTER).
  void fault(ErrorCode code, std::string_view key, std::string message);
  /// Adds a fault at the key's place, with the code and the message of the first fault of `cause`.
  void fault(std::string_view key, const Error& cause);
  /// Adds a fault for each key of the object that was not read. Only the first of these faults
  /// lists the known keys.
  void reject_unknown_keys();
  /// All faults found so far in the file.
  const std::vector<Fault>& faults() const { return *faults_; }
  const std::string& file() const { return file_; }
  /// JSON pointer of a key of this object.
  std::string pointer(std::string_view key) const;

 private:
  template <ObjectReader Read>
  static auto read_all(std::vector<JsonObject> all, const Read& read) {
    using Value = std::invoke_result_t<const Read&, JsonObject&>;
    if constexpr (std::is_void_v<Value>) {
      for (JsonObject& one : all) one.read_by(read);
    } else {
      std::vector<Value> values;
      for (JsonObject& one : all) values.push_back(one.read_by(read));
      return values;
    }
  }
  const Json* find(std::string_view key, bool required);
  /// The array under the key; null, with a fault, if the key is missing or has another value.
  /// `elements`: what the array should have, for the fault ("numbers").
  const Json* array(std::string_view key, std::string_view elements);
  /// Adds a fault for the value of the key: "expected ..., found ...".
  void wrong(ErrorCode code, std::string_view key, std::string_view expected, const Json& found);
  const Json* value_ = nullptr;  ///< null: an object that reports no faults
  std::string file_;
  std::string pointer_;
  std::vector<Fault>* faults_;
  JsonShape* shape_ = nullptr;  ///< null: reads a document
  std::set<std::string, std::less<>> known_;
};

/// Reader of an object that has only numbers, under these keys.
inline auto numbers_at(std::vector<const char*> keys, NumberRule rule = kAnyNumber) {
  return [keys = std::move(keys), rule](JsonObject& json) {
    for (const char* key : keys) json.number(key, rule);
  };
}

/// Returns the result of `read(JsonObject&)`, applied to a document. `file`: its name in errors.
/// Errors (input): all faults that `read` finds.
template <class Read>
auto read_json_object(const Json& document, const std::string& file, const Read& read)
    -> Result<std::invoke_result_t<const Read&, JsonObject&>> {
  std::vector<Fault> faults;
  JsonObject json(document, file, "", faults);
  auto content = read(json);
  if (!faults.empty()) return input_errors(std::move(faults));
  return content;
}

/// As above, for the document in a file. Errors: also those of read_json_file().
template <class Read>
auto read_json_object(const std::filesystem::path& path, const Read& read)
    -> Result<std::invoke_result_t<const Read&, JsonObject&>> {
  AWMR_ASSIGN_OR_RETURN(const Json document, read_json_file(path));
  return read_json_object(document, path.string(), read);
}

/// Returns a JSON Schema (draft 2020-12) that accepts every document that `read` accepts. To derive
/// it, `read` is run for every value of every choice(), with and without optional keys. The schema
/// has a rule where the value of a choice decides which other keys are allowed, and no rules for
/// other relations between keys. `format`: value of the key `$id`.
std::string json_schema_text(std::string_view format, std::string_view title,
                             const std::function<void(JsonObject&)>& read);

/// A number, or null if it is absent.
inline Json value_or_null(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}
/// `[lo, hi]`, or null if the interval is absent.
inline Json value_or_null(const std::optional<Interval>& interval) {
  return interval ? Json::array({interval->lo, interval->hi}) : Json(nullptr);
}

/// Writes the provenance keys `{"command", "version", "options", "inputs"}` into `json`.
void put_provenance(Json& json, const Provenance& provenance);
/// A new output document with the keys `schema` and those of put_provenance().
Json output_document(std::string_view schema, const Provenance& provenance);
/// Reads the keys written by put_provenance().
Provenance read_provenance(JsonObject& json);
/// True if the `inputs` of the document include a file with this SHA-256. Empty if the document
/// lists no inputs, for example because it was written by hand.
std::optional<bool> is_made_from(const Json& document, std::string_view sha256);

/// JSON text, indented by two spaces, with a newline at the end. Reading it gives the same numbers.
/// A number that is not finite is not possible in JSON: throws std::logic_error with its pointer.
std::string to_text(const Json& json);

}  // namespace awmr
