#include "awmr/core/json/json.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "awmr/core/json/json_fault.h"
#include "awmr/core/json/json_shape.h"
#include "awmr/core/nearest.h"

namespace awmr {
namespace {
constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
}  // namespace

JsonObject::JsonObject(const Json& value, std::string file, std::string pointer,
                       std::vector<Fault>& faults)
    : value_(&value), file_(std::move(file)), pointer_(std::move(pointer)), faults_(&faults) {
  if (!value.is_object()) {
    add_fault(ErrorCode::kWrongType, *faults_, file_, pointer_,
              fmt::format("expected an object, found {}", describe(value)));
    value_ = nullptr;
  }
}

std::string JsonObject::pointer(std::string_view key) const {
  return pointer_ + "/" + pointer_token(key);
}

void JsonObject::fault(ErrorCode code, std::string_view key, std::string message) {
  if (value_ == nullptr) return;
  add_fault(code, *faults_, file_, pointer(key), std::move(message));
}

void JsonObject::wrong(ErrorCode code, std::string_view key, std::string_view expected,
                       const Json& found) {
  fault(code, key, fmt::format("expected {}, found {}", expected, describe(found)));
}

void JsonObject::fault(std::string_view key, const Error& cause) {
  fault(cause.faults.front().code, key, cause.faults.front().message);
}

const Json* JsonObject::find(std::string_view key, bool required) {
  if (shape_ != nullptr) {
    shape_->requested(key, required);
    return nullptr;
  }
  known_.emplace(key);
  if (value_ == nullptr) return nullptr;
  const auto found = value_->find(std::string(key));
  if (found != value_->end()) return &*found;
  if (required) fault(ErrorCode::kMissing, key, "this key is missing; add it");
  return nullptr;
}

bool JsonObject::has(std::string_view key) {
  return shape_ != nullptr ? shape_->has(key) : find(key, false) != nullptr;
}

std::optional<std::size_t> JsonObject::size(std::string_view key) const {
  if (value_ == nullptr) return std::nullopt;
  const auto found = value_->find(std::string(key));
  if (found == value_->end() || !found->is_structured()) return std::nullopt;
  return found->size();
}

double JsonObject::number(std::string_view key, NumberRule rule) {
  if (shape_ != nullptr) shape_->type(key, schema_of(rule));
  const Json* value = find(key, true);
  if (value == nullptr) return kNoNumber;
  if (value->is_number() && allows(rule, value->get<double>())) return value->get<double>();
  wrong(number_error(*value), key, describe(rule), *value);
  return kNoNumber;
}

std::optional<double> JsonObject::nullable_number(std::string_view key, NumberRule rule) {
  if (shape_ != nullptr) shape_->type(key, or_null(schema_of(rule)));
  const Json* value = find(key, true);
  if (value == nullptr || value->is_null()) return std::nullopt;
  return number(key, rule);
}

long JsonObject::integer(std::string_view key, long min, long max) {
  if (shape_ != nullptr) shape_->type(key, schema_of(min, max));
  const Json* value = find(key, true);
  if (value == nullptr) return min;
  const bool fits = value->is_number_integer() &&
                    (!value->is_number_unsigned() ||
                     value->get<std::uint64_t>() <= std::numeric_limits<long>::max()) &&
                    value->get<long>() >= min && value->get<long>() <= max;
  if (fits) return value->get<long>();
  wrong(number_error(*value), key, fmt::format("a whole number from {} to {}", min, max), *value);
  return min;
}

std::uint64_t JsonObject::seed(std::string_view key) {
  constexpr std::uint64_t kMax = std::numeric_limits<std::uint64_t>::max();
  if (shape_ != nullptr) {
    shape_->type(key, {{"type", "integer"}, {"minimum", 0}, {"maximum", kMax}});
  }
  const Json* value = find(key, true);
  if (value == nullptr) return 0;
  if (value->is_number_unsigned()) return value->get<std::uint64_t>();
  wrong(number_error(*value), key, fmt::format("a whole number from 0 to {}", kMax), *value);
  return 0;
}

bool JsonObject::boolean(std::string_view key) {
  if (shape_ != nullptr) shape_->type(key, {{"type", "boolean"}});
  const Json* value = find(key, true);
  if (value == nullptr) return false;
  if (value->is_boolean()) return value->get<bool>();
  wrong(ErrorCode::kWrongType, key, "true or false", *value);
  return false;
}

std::string JsonObject::string(std::string_view key) {
  if (shape_ != nullptr) shape_->type(key, {{"type", "string"}});
  const Json* value = find(key, true);
  if (value == nullptr) return {};
  if (!value->is_string()) {
    wrong(ErrorCode::kWrongType, key, "a string", *value);
    return {};
  }
  if (value->get_ref<const std::string&>().find('\0') != std::string::npos) {
    fault(ErrorCode::kBadName, key, "the text contains a NUL character (\\u0000); remove it");
    return {};
  }
  return value->get<std::string>();
}

std::optional<std::string> JsonObject::optional_number_or_string(std::string_view key,
                                                                 NumberRule rule) {
  if (!has(key)) return std::nullopt;
  if (shape_ != nullptr) {
    shape_->type(key, {{"anyOf", {schema_of(rule), {{"type", "string"}}}}});
  }
  const Json* value = find(key, true);
  if (value == nullptr) return std::nullopt;
  if (value->is_number()) {
    const double given = number(key, rule);
    return std::isfinite(given) ? std::optional(fmt::format("{}", given)) : std::nullopt;
  }
  const std::string text = string(key);
  return value->is_string() ? std::optional(text) : std::nullopt;
}

std::size_t JsonObject::choice(std::string_view key, std::span<const std::string> choices) {
  const Json* value = find(key, true);
  if (shape_ != nullptr) return shape_->choice(key, choices);
  if (value == nullptr) return 0;
  if (value->is_string()) {
    const auto found = std::find(choices.begin(), choices.end(), value->get<std::string>());
    if (found != choices.end()) return static_cast<std::size_t>(found - choices.begin());
  }
  const std::string near = value->is_string() ? nearest(value->get<std::string>(), choices) : "";
  fault(ErrorCode::kUnknownName, key,
        fmt::format("expected one of {}, found {}{}", fmt::join(choices, ", "), describe(*value),
                    near.empty() ? "" : "; did you mean " + near + "?"));
  return 0;
}

JsonObject JsonObject::object(std::string_view key) {
  static const Json kEmpty = Json::object();
  const Json* value = find(key, true);
  if (shape_ != nullptr) return {shape_->object(key), *faults_};
  if (value != nullptr) return {*value, file_, pointer(key), *faults_};
  JsonObject absent(kEmpty, file_, pointer(key), *faults_);
  absent.value_ = nullptr;
  return absent;
}

std::vector<JsonObject> JsonObject::values() {
  std::vector<JsonObject> result;
  for (const std::string& key : keys()) result.push_back(object(key));
  return result;
}

void JsonObject::ignore(std::string_view key) { find(key, false); }

void JsonObject::schema(std::string_view expected) {
  if (shape_ != nullptr) {
    shape_->requested("schema", false);
    return shape_->type("schema", {{"const", expected}});
  }
  const auto found = optional_string("schema");
  if (found && *found != expected) {
    fault(ErrorCode::kWrongFile, "schema",
          fmt::format("expected \"{}\", found \"{}\": give a file of the expected kind", expected,
                      *found));
    value_ = nullptr;  // a file of another kind has other keys: report no further faults
  }
}

std::vector<std::string> JsonObject::keys() const {
  if (shape_ != nullptr) return {"*"};
  std::vector<std::string> result;
  if (value_ == nullptr) return result;
  for (const auto& [key, unused] : value_->items()) result.push_back(key);
  return result;
}

void JsonObject::reject_unknown_keys() {
  if (shape_ != nullptr) return shape_->close();
  const std::vector<std::string> known(known_.begin(), known_.end());
  std::string known_keys = fmt::format("; the keys here are {}", fmt::join(known, ", "));
  for (const std::string& key : keys()) {
    if (known_.count(key) != 0 || faults_->size() >= kMaxFaults) continue;
    const std::string near = nearest(key, known);
    fault(ErrorCode::kUnknownName, key,
          near.empty() ? "unknown key" + std::exchange(known_keys, {})
                       : fmt::format("unknown key; did you mean \"{}\"?", near));
  }
}

}  // namespace awmr
