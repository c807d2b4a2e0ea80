#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "awmr/compare/shard.h"
#include "awmr/core/file.h"
#include "awmr/emit/manifest.h"
#include "awmr/identify/planning/recover_shard.h"
#include "awmr/identify/planning/suggest.h"
#include "awmr/model/model_file.h"
#include "awmr/model/vehicle_file.h"
#include "awmr/report/report.h"
#include "awmr/simulate/run_side.h"
#include "awmr/simulate/scenario_file.h"
#include "awmr/tune/tune_file.h"
#include "choices.h"
#include "commands.h"
#include "json_output.h"
#include "paths.h"
#include "project.h"
#include "schemas.h"

namespace awmr::cli {
namespace {

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
