#include "awmr/core/json.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "awmr/core/csv.h"
#include "awmr/core/json_text.h"
#include "awmr/core/nearest.h"
#include "awmr/core/text.h"

namespace awmr {
namespace {

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

/// A value as a fault shows it, cut between characters where it is long.
std::string describe(const Json& value) {
  std::string text = value.dump();
  if (text.size() > 40) text = std::string(first_characters(text, 37)) + "...";
  return fmt::format("{} {}", value.type_name(), text);
}

std::string describe(const NumberRule& rule) {
  const bool below = rule.min <= kAnyNumber.min;
  const bool above = rule.max >= kAnyNumber.max;
  const char* relation = rule.min_excluded ? "above" : "at least";
  if (below && above) return "a number";
  if (above) return fmt::format("a number {} {}", relation, format_number(rule.min));
  if (below) return fmt::format("a number at most {}", format_number(rule.max));
  return fmt::format("a number {} {} and at most {}", relation, format_number(rule.min),
                     format_number(rule.max));
}

bool allows(const NumberRule& rule, double value) {
  return value <= rule.max && (rule.min_excluded ? value > rule.min : value >= rule.min);
}

void add_fault(std::vector<Fault>& faults, const std::string& file, const std::string& pointer,
               std::string message) {
  if (faults.size() >= kMaxFaults) return;
  faults.push_back(
      {pointer.empty() ? file : fmt::format("{}:{}", file, pointer), std::move(message)});
}

}  // namespace

JsonObject::JsonObject(const Json& value, std::string file, std::string pointer,
                       std::vector<Fault>& faults)
    : value_(&value), file_(std::move(file)), pointer_(std::move(pointer)), faults_(&faults) {
  if (!value.is_object()) {
    add_fault(*faults_, file_, pointer_,
              fmt::format("expected an object, found {}", describe(value)));
    value_ = nullptr;
  }
}

std::string JsonObject::pointer(std::string_view key) const {
  return pointer_ + "/" + pointer_token(key);
}

void JsonObject::fault(std::string_view key, std::string message) {
  add_fault(*faults_, file_, pointer(key), std::move(message));
}

const Json* JsonObject::find(std::string_view key, bool required) {
  known_.emplace(key);
  if (value_ == nullptr) return nullptr;
  const auto found = value_->find(std::string(key));
  if (found != value_->end()) return &*found;
  if (required) fault(key, "this key is missing; add it");
  return nullptr;
}

bool JsonObject::has(std::string_view key) { return find(key, false) != nullptr; }

double JsonObject::number(std::string_view key, NumberRule rule) {
  const Json* value = find(key, true);
  if (value == nullptr) return kNoNumber;
  if (!value->is_number() || !std::isfinite(value->get<double>()) ||
      !allows(rule, value->get<double>())) {
    fault(key, fmt::format("expected {}, found {}", describe(rule), describe(*value)));
    return kNoNumber;
  }
  return value->get<double>();
}

std::optional<double> JsonObject::optional_number(std::string_view key, NumberRule rule) {
  if (!has(key)) return std::nullopt;
  return number(key, rule);
}

std::optional<double> JsonObject::nullable_number(std::string_view key, NumberRule rule) {
  const Json* value = find(key, true);
  if (value == nullptr || value->is_null()) return std::nullopt;
  return number(key, rule);
}

long JsonObject::integer(std::string_view key, long min, long max) {
  const Json* value = find(key, true);
  if (value == nullptr) return min;
  const bool fits = value->is_number_integer() &&
                    (!value->is_number_unsigned() ||
                     value->get<std::uint64_t>() <= std::numeric_limits<long>::max()) &&
                    value->get<long>() >= min && value->get<long>() <= max;
  if (!fits) {
    fault(key, fmt::format("expected a whole number from {} to {}, found {}", min, max,
                           describe(*value)));
    return min;
  }
  return value->get<long>();
}

std::optional<long> JsonObject::optional_integer(std::string_view key, long min, long max) {
  if (!has(key)) return std::nullopt;
  return integer(key, min, max);
}

bool JsonObject::boolean(std::string_view key) {
  const Json* value = find(key, true);
  if (value == nullptr) return false;
  if (!value->is_boolean()) {
    fault(key, fmt::format("expected true or false, found {}", describe(*value)));
    return false;
  }
  return value->get<bool>();
}

std::optional<bool> JsonObject::optional_boolean(std::string_view key) {
  if (!has(key)) return std::nullopt;
  return boolean(key);
}

std::string JsonObject::string(std::string_view key) {
  const Json* value = find(key, true);
  if (value == nullptr) return {};
  if (!value->is_string()) {
    fault(key, fmt::format("expected a string, found {}", describe(*value)));
    return {};
  }
  return value->get<std::string>();
}

std::optional<std::string> JsonObject::optional_string(std::string_view key) {
  if (!has(key)) return std::nullopt;
  return string(key);
}

std::size_t JsonObject::choice(std::string_view key, std::span<const std::string> choices) {
  const Json* value = find(key, true);
  if (value == nullptr) return 0;
  if (value->is_string()) {
    const auto found = std::find(choices.begin(), choices.end(), value->get<std::string>());
    if (found != choices.end()) return static_cast<std::size_t>(found - choices.begin());
  }
  const std::string near = value->is_string() ? nearest(value->get<std::string>(), choices) : "";
  fault(key, fmt::format("expected one of {}, found {}{}", fmt::join(choices, ", "),
                         describe(*value), near.empty() ? "" : "; did you mean " + near + "?"));
  return 0;
}

Interval JsonObject::interval(std::string_view key) {
  const Json* value = find(key, true);
  if (value == nullptr) return {};
  if (value->is_array() && value->size() == 2 && (*value)[0].is_number() &&
      (*value)[1].is_number()) {
    const Interval interval{(*value)[0].get<double>(), (*value)[1].get<double>()};
    if (interval.lo <= interval.hi) return interval;
  }
  fault(key, fmt::format("expected [lo, hi] with lo <= hi, found {}", describe(*value)));
  return {};
}

std::optional<Interval> JsonObject::optional_interval(std::string_view key) {
  if (!has(key)) return std::nullopt;
  return interval(key);
}

std::optional<Interval> JsonObject::nullable_interval(std::string_view key) {
  const Json* value = find(key, true);
  if (value == nullptr || value->is_null()) return std::nullopt;
  return interval(key);
}

std::vector<double> JsonObject::numbers(std::string_view key, NumberRule rule) {
  const Json* value = find(key, true);
  std::vector<double> result;
  if (value == nullptr) return result;
  if (!value->is_array()) {
    fault(key, fmt::format("expected an array of numbers, found {}", describe(*value)));
    return result;
  }
  for (std::size_t i = 0; i < value->size(); ++i) {
    const Json& element = (*value)[i];
    if (element.is_number() && allows(rule, element.get<double>())) {
      result.push_back(element.get<double>());
    } else {
      add_fault(*faults_, file_, fmt::format("{}/{}", pointer(key), i),
                fmt::format("expected {}, found {}", describe(rule), describe(element)));
    }
  }
  return result;
}

std::vector<std::string> JsonObject::strings(std::string_view key) {
  const Json* value = find(key, true);
  std::vector<std::string> result;
  if (value == nullptr) return result;
  if (!value->is_array()) {
    fault(key, fmt::format("expected an array of strings, found {}", describe(*value)));
    return result;
  }
  for (std::size_t i = 0; i < value->size(); ++i) {
    const Json& element = (*value)[i];
    if (element.is_string()) {
      result.push_back(element.get<std::string>());
    } else {
      add_fault(*faults_, file_, fmt::format("{}/{}", pointer(key), i),
                fmt::format("expected a string, found {}", describe(element)));
    }
  }
  return result;
}

JsonObject JsonObject::object(std::string_view key) {
  static const Json kEmpty = Json::object();
  const Json* value = find(key, true);
  if (value != nullptr) return {*value, file_, pointer(key), *faults_};
  JsonObject absent(kEmpty, file_, pointer(key), *faults_);
  absent.value_ = nullptr;
  return absent;
}

std::optional<JsonObject> JsonObject::optional_object(std::string_view key) {
  if (!has(key)) return std::nullopt;
  return object(key);
}

std::vector<JsonObject> JsonObject::objects(std::string_view key) {
  const Json* value = find(key, true);
  std::vector<JsonObject> result;
  if (value == nullptr) return result;
  if (!value->is_array()) {
    fault(key, fmt::format("expected an array of objects, found {}", describe(*value)));
    return result;
  }
  for (std::size_t i = 0; i < value->size(); ++i) {
    result.emplace_back((*value)[i], file_, fmt::format("{}/{}", pointer(key), i), *faults_);
  }
  return result;
}

std::vector<JsonObject> JsonObject::optional_objects(std::string_view key) {
  if (!has(key)) return {};
  return objects(key);
}

void JsonObject::ignore(std::string_view key) { known_.emplace(key); }

void JsonObject::schema(std::string_view expected) {
  const auto found = optional_string("schema");
  if (found && *found != expected) {
    fault("schema", fmt::format("expected \"{}\", found \"{}\": this is another kind of file",
                                expected, *found));
  }
}

std::vector<std::string> JsonObject::keys() const {
  std::vector<std::string> result;
  if (value_ == nullptr) return result;
  for (const auto& [key, unused] : value_->items()) result.push_back(key);
  return result;
}

void JsonObject::reject_unknown_keys() {
  const std::vector<std::string> known(known_.begin(), known_.end());
  for (const std::string& key : keys()) {
    if (known_.count(key) != 0 || faults_->size() >= kMaxFaults) continue;
    const std::string near = nearest(key, known);
    fault(key, near.empty()
                   ? fmt::format("unknown key; the keys here are {}", fmt::join(known, ", "))
                   : fmt::format("unknown key; did you mean \"{}\"?", near));
  }
}

}  // namespace awmr
