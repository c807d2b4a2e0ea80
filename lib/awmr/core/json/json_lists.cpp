// The functions of JsonObject that read arrays, and the texts of faults (json_fault.h).

#include <fmt/format.h>

#include <utility>

#include "awmr/core/csv.h"
#include "awmr/core/json/json.h"
#include "awmr/core/json/json_fault.h"
#include "awmr/core/json/json_shape.h"
#include "awmr/core/text.h"

namespace awmr {

std::string describe(const Json& value) {
  if (value.is_null()) return "null";
  std::string text = value.dump();
  if (text.size() > 40) text = std::string(first_characters(text, 37)) + "...";
  return fmt::format("{} {}", value.type_name(), text);
}

ErrorCode number_error(const Json& value) {
  return value.is_number() ? ErrorCode::kOutOfRange : ErrorCode::kWrongType;
}

void add_fault(ErrorCode code, std::vector<Fault>& faults, const std::string& file,
               const std::string& pointer, std::string message) {
  if (faults.size() >= kMaxFaults) return;
  faults.push_back(
      {code, pointer.empty() ? file : fmt::format("{}:{}", file, pointer), std::move(message)});
}

Interval JsonObject::interval(std::string_view key, NumberRule rule) {
  if (shape_ != nullptr) shape_->type(key, interval_schema(rule));
  const Json* value = find(key, true);
  if (value == nullptr) return {};
  if (value->is_array() && value->size() == 2 && (*value)[0].is_number() &&
      (*value)[1].is_number()) {
    const Interval interval{(*value)[0].get<double>(), (*value)[1].get<double>()};
    if (allows(rule, interval)) return interval;
    if (interval.lo <= interval.hi) {
      fault(ErrorCode::kOutOfRange, key,
            fmt::format("both ends must be {}, found {}", describe(rule), describe(*value)));
      return {};
    }
  }
  wrong(ErrorCode::kWrongType, key, "[lo, hi] with lo <= hi", *value);
  return {};
}

std::optional<Interval> JsonObject::nullable_interval(std::string_view key) {
  if (shape_ != nullptr) shape_->type(key, or_null(interval_schema(kAnyNumber)));
  const Json* value = find(key, true);
  if (value == nullptr || value->is_null()) return std::nullopt;
  return interval(key);
}

const Json* JsonObject::array(std::string_view key, std::string_view elements) {
  const Json* value = find(key, true);
  if (value == nullptr || value->is_array()) return value;
  wrong(ErrorCode::kWrongType, key, fmt::format("an array of {}", elements), *value);
  return nullptr;
}

std::vector<double> JsonObject::numbers(std::string_view key, NumberRule rule) {
  if (shape_ != nullptr) shape_->type(key, array_schema(schema_of(rule)));
  const Json* value = array(key, "numbers");
  std::vector<double> result;
  if (value == nullptr) return result;
  for (std::size_t i = 0; i < value->size(); ++i) {
    const Json& element = (*value)[i];
    if (element.is_number() && allows(rule, element.get<double>())) {
      result.push_back(element.get<double>());
    } else {
      add_fault(number_error(element), *faults_, file_, fmt::format("{}/{}", pointer(key), i),
                fmt::format("expected {}, found {}", describe(rule), describe(element)));
    }
  }
  return result;
}

std::vector<std::string> JsonObject::strings(std::string_view key) {
  if (shape_ != nullptr) shape_->type(key, array_schema({{"type", "string"}}));
  const Json* value = array(key, "strings");
  std::vector<std::string> result;
  if (value == nullptr) return result;
  for (std::size_t i = 0; i < value->size(); ++i) {
    const Json& element = (*value)[i];
    if (element.is_string()) {
      result.push_back(element.get<std::string>());
    } else {
      add_fault(ErrorCode::kWrongType, *faults_, file_, fmt::format("{}/{}", pointer(key), i),
                fmt::format("expected a string, found {}", describe(element)));
    }
  }
  return result;
}

std::vector<JsonObject> JsonObject::objects(std::string_view key) {
  const Json* value = array(key, "objects");
  if (shape_ != nullptr) return {JsonObject(shape_->element(key), *faults_)};
  std::vector<JsonObject> result;
  if (value == nullptr) return result;
  for (std::size_t i = 0; i < value->size(); ++i) {
    result.emplace_back((*value)[i], file_, fmt::format("{}/{}", pointer(key), i), *faults_);
  }
  return result;
}

const Json* JsonObject::rows(std::string_view key) {
  if (shape_ != nullptr) shape_->type(key, array_schema(array_schema(schema_of(kAnyNumber))));
  return find(key, true);
}

}  // namespace awmr
