#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <limits>
#include <memory>

#include "awmr/compare/shard.h"
#include "awmr/core/file.h"
#include "awmr/core/json/json.h"
#include "awmr/emit/manifest.h"
#include "awmr/identify/planning/recover_shard.h"
#include "awmr/identify/planning/suggest.h"
#include "awmr/model/findings_json.h"
#include "awmr/model/model_file.h"
#include "awmr/model/vehicle_file.h"
#include "awmr/report/report.h"
#include "awmr/simulate/run_file.h"
#include "awmr/simulate/scenario_file.h"
#include "awmr/tune/tune_file.h"
#include "commands.h"
#include "json_output.h"
#include "option_values.h"
#include "project.h"

namespace awmr::cli {
namespace {

constexpr long kLargestInt = std::numeric_limits<int>::max();

/// Describes an object with the difference of two runs for each signal; null if not finite.
void describe_difference(JsonObject json) {
  for (const std::string& signal : json.keys()) json.nullable_number(signal);
}

void describe_chip(JsonObject& json) {
  json.object("cycles", numbers_at({"min", "mean", "max"}, kNonNegative));
  json.nullable_number("cycles_bound", kNonNegative);
  json.optional_object("hostile", [](JsonObject& hostile) {
    hostile.integer("steps", 0, kLargestInt);
    hostile.integer("differing", 0, kLargestInt);
  });
  json.number("period_share", kNonNegative);
  json.integer("flash_bytes", 0, kLargestInt);
  json.integer("ram_bytes", 0, kLargestInt);
  json.optional_integer("repeats", 0, kLargestInt);
  json.optional_integer("restarts", 0, kLargestInt);
  json.nullable_number("stack_bytes", kNonNegative);
}

void describe_verdict(JsonObject& json) {
  json.optional_object("injected", [](JsonObject& injected) {
    for (const char* key : {"expected_fault", "fault", "start_fault"}) {
      injected.integer(key, 0, kLargestInt);
    }
    injected.boolean("safe");
  });
  json.objects("checks", [](JsonObject& check) {
    check.string("check");
    check.nullable_number("value");
    check.number("bound");
    check.boolean("passed");
  });
  static const std::string kVerdicts[] = {"passed", "failed"};
  json.choice("verdict", kVerdicts);
}

void describe_pil(JsonObject& json) {
  json.schema("awmr.pil/1");
  read_provenance(json);
  json.string("scenario");
  json.string("mode");
  json.integer("samples", 0, kLargestInt);
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

/// Schema of pil.json, which awmr-pil writes.
std::string pil_schema() {
  return json_schema_text(
      "awmr.pil/1", "Comparison of a run of the firmware on the chip with the same run on the host",
      describe_pil);
}

struct Schema {
  std::string name;       ///< format name: "vehicle"
  std::string (*text)();  ///< JSON Schema, draft 2020-12
};

/// All schemas, in the order in which a user creates the files.
const std::vector<Schema>& schemas() {
  static const std::vector<Schema> all{
      {"project", project_schema},
      {"vehicle", vehicle_schema},
      {"columns", columns_schema},
      {"model", model_schema},
      {"suggest", suggest_schema},
      {"recover", recover_schema},
      {"recover_shard", [] { return shard_schema(recover_shards()); }},
      {"tune", tune_schema},
      {"gains", gains_schema},
      {"scenario", scenario_schema},
      {"run", run_schema},
      {"emit", emit_schema},
      {"validation", validation_schema},
      {"comparison", comparison_schema},
      {"shard", [] { return shard_schema(comparison_shards()); }},
      {"figures", figures_schema},
      {"pil", pil_schema},
      {"result", result_schema},
      {"error", error_schema}};
  return all;
}

std::vector<std::string> schema_names() {
  std::vector<std::string> names;
  for (const Schema& schema : schemas()) names.push_back(schema.name);
  return names;
}

Result<Outcome> write_schemas(const fs::path& directory) {
  Outcome outcome;
  std::vector<OutputFile> files;
  for (const Schema& schema : schemas()) {
    files.push_back({directory / (schema.name + ".schema.json"), schema.text()});
    outcome.written.push_back(files.back().path);
  }
  AWMR_RETURN_IF_ERROR(make_directory(directory));
  AWMR_RETURN_IF_ERROR(write_files(files));
  outcome.summary = fmt::format("wrote {} schemas to {}\n", files.size(), directory.string());
  return outcome;
}

Outcome show_schema(const std::string& name) {
  if (name.empty()) return Outcome{.summary = fmt::format("{}\n", fmt::join(schema_names(), "\n"))};
  const auto found = std::find_if(schemas().begin(), schemas().end(),
                                  [&](const Schema& schema) { return schema.name == name; });
  return Outcome{.summary = found->text(), .document = found->text()};
}

}  // namespace

void add_schema(CLI::App& app, Session& session) {
  struct Words {
    std::string format;
    std::optional<fs::path> directory;
  };
  auto words = std::make_shared<Words>();
  CLI::App* sub = add_command(app, session, "schema", "Print the JSON Schema of a file format",
                              "awmr schema vehicle", [words]() -> Result<Outcome> {
                                if (words->directory) return write_schemas(*words->directory);
                                return show_schema(words->format);
                              });
  sub->group(kServiceGroup);
  auto* format =
      sub->add_option("FORMAT", words->format, "File format; without it, all names are listed")
          ->check(one_of(schema_names()));
  add_directory(*sub, "-o,--output", words->directory, "Write all schemas to this directory")
      ->excludes(format);
}

}  // namespace awmr::cli
