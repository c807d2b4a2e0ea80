// JSON Schema of pil.json, the result file of awmr-pil.
#include <limits>
#include <string>

#include "awmr/core/json.h"
#include "awmr/model/findings_json.h"
#include "schemas.h"

namespace awmr::cli {
namespace {

constexpr long kAnyCount = std::numeric_limits<int>::max();

/// Object with the difference of two runs for each signal; null if the difference is not finite.
void describe_difference(JsonObject json) {
  for (const std::string& signal : json.keys()) json.nullable_number(signal);
}

void describe_chip(JsonObject& json) {
  JsonObject cycles = json.object("cycles");
  for (const char* key : {"min", "mean", "max"}) cycles.number(key, kNonNegative);
  cycles.reject_unknown_keys();
  json.nullable_number("cycles_bound", kNonNegative);
  if (auto hostile = json.optional_object("hostile")) {
    hostile->integer("steps", 0, kAnyCount);
    hostile->integer("differing", 0, kAnyCount);
    hostile->reject_unknown_keys();
  }
  json.number("period_share", kNonNegative);
  json.integer("flash_bytes", 0, kAnyCount);
  json.integer("ram_bytes", 0, kAnyCount);
  json.optional_integer("repeats", 0, kAnyCount);
  json.optional_integer("restarts", 0, kAnyCount);
  json.nullable_number("stack_bytes", kNonNegative);
}

void describe_verdict(JsonObject& json) {
  if (auto injected = json.optional_object("injected")) {
    for (const char* key : {"expected_fault", "fault", "start_fault"}) {
      injected->integer(key, 0, kAnyCount);
    }
    injected->boolean("safe");
    injected->reject_unknown_keys();
  }
  for (JsonObject& check : json.objects("checks")) {
    check.string("check");
    check.nullable_number("value");
    check.number("bound");
    check.boolean("passed");
    check.reject_unknown_keys();
  }
  static const std::string kVerdicts[] = {"passed", "failed"};
  json.choice("verdict", kVerdicts);
}

void describe_pil(JsonObject& json) {
  json.schema("awmr.pil/1");
  read_provenance(json);
  json.string("scenario");
  json.string("mode");
  json.integer("samples", 0, kAnyCount);
  json.boolean("guidance_on_chip");
  describe_difference(json.object("difference"));
  if (auto exact = json.optional_object("difference_double")) describe_difference(*exact);
  if (auto effect = json.optional_object("effect")) {
    for (const JsonObject& one : effect->values()) describe_difference(one);
  }
  describe_chip(json);
  describe_verdict(json);
  read_findings(json);
  json.reject_unknown_keys();
}

}  // namespace

std::string pil_schema() {
  return json_schema_text(
      "awmr.pil/1", "Comparison of a run of the firmware on the chip with the same run on the host",
      describe_pil);
}

}  // namespace awmr::cli
