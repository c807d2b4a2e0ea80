#include "project.h"

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>

#include "awmr/core/json/json.h"
#include "identify_options.h"

namespace awmr::cli {
namespace {

namespace fs = std::filesystem;

fs::path resolved(const fs::path& project, const std::string& name) {
  return (project.parent_path() / name).lexically_normal();
}

/// Reads the file names in a project file, and resolves them relative to the directory of that
/// file.
class FileNames {
 public:
  explicit FileNames(const fs::path& project) : project_(project) {}

  fs::path at(JsonObject& json, const char* key) const {
    const std::size_t before = json.faults().size();
    const std::string name = json.string(key);
    if (name.empty() && json.faults().size() == before) {
      json.fault(ErrorCode::kBadName, key, "is empty: give the path of a file");
    }
    return resolved(project_, name);
  }
  std::optional<fs::path> maybe_at(JsonObject& json, const char* key) const {
    return json.has(key) ? std::optional(at(json, key)) : std::nullopt;
  }
  std::vector<fs::path> all_at(JsonObject& json, const char* key) const {
    std::vector<fs::path> paths;
    for (const std::string& name : json.strings(key)) {
      if (name.empty())
        json.fault(ErrorCode::kBadName, key,
                   "contains an empty name: remove it, or give the path of a file");
      if (name.find('\0') != std::string::npos) {
        json.fault(ErrorCode::kBadName, key,
                   "contains a file name with a NUL character: remove the character");
      }
      paths.push_back(resolved(project_, name));
    }
    return paths;
  }
  fs::path of(const std::string& name) const { return resolved(project_, name); }

 private:
  const fs::path& project_;
};

/// Reads the column mappings for one file. If the name `file` is empty, they apply to all files.
void read_columns(JsonObject json, const std::string& file, Project& project) {
  for (const std::string& name : json.keys()) {
    const std::string expression = json.string(name);
    if (auto mapping = parse_column(name, expression)) {
      if (!file.empty()) mapping->file = file;
      project.trials.options.columns.push_back(*mapping);
    } else {
      json.fault(name, mapping.error());
    }
  }
}

void read_trials(JsonObject& json, const FileNames& files, Project& project) {
  project.trials.surge = files.maybe_at(json, "surge");
  if (const auto one = files.maybe_at(json, "coastdown")) project.trials.coastdowns.push_back(*one);
  project.trials.turning = files.maybe_at(json, "turning");
  if (json.has("coastdowns")) {
    std::ranges::move(files.all_at(json, "coastdowns"),
                      std::back_inserter(project.trials.coastdowns));
  }
  if (json.has("logs")) project.trials.logs = files.all_at(json, "logs");
  if (auto columns = json.optional_object("columns")) {
    for (const std::string& name : columns->keys()) {
      read_columns(columns->object(name), files.of(name).string(), project);
    }
  }
}

void read_identify(JsonObject& json, Project& project) {
  const auto choice = [&json](const char* key, const auto& table, auto set) {
    if (!json.has(key)) return;
    set(json.choice(key, table));
  };
  IdentifyOptions& options = project.identify;
  choice("method", kMethodNames, [&](Method value) { options.method = value; });
  choice("noise", kErrorModelNames, [&](ErrorModel value) { options.noise = value; });
  choice("loss", kLossNames, [&](Loss value) { options.loss = value; });
  choice("prefer", kPreferenceNames,
         [&](Preference value) { project.trials.options.preference = value; });
  const auto each = [&json](const char* key, const auto& add) {
    if (!json.has(key)) return;
    for (const std::string& text : json.strings(key)) {
      if (const auto added = add(text); !added) {
        json.fault(key, added.error());
      }
    }
  };
  each("family", [&](const std::string& text) { return add_family(text, options); });
  each("fit", [&](const std::string& text) { return add_requested(text, options); });
  each("exclude",
       [&](const std::string& text) { return add_excluded(text, project.trials.options); });
  constexpr NumberRule kTime_s{.min = -kMaxTime_s, .max = kMaxTime_s};
  Interval& used_s = project.trials.options.used_s;
  used_s.lo = json.optional_number("from_s", kTime_s).value_or(used_s.lo);
  used_s.hi = json.optional_number("until_s", kTime_s).value_or(used_s.hi);
  if (const auto used = check_used(project.trials.options); !used)
    json.fault("until_s", used.error());
  options.joint = json.optional_boolean("joint").value_or(false);
  options.seed =
      static_cast<std::uint64_t>(json.optional_integer("seed", 0, 1000000000L).value_or(1));
  options.bootstrap = static_cast<int>(json.optional_integer("bootstrap", 0, 1000000).value_or(0));
  project.trials.options.as_is = json.optional_boolean("as_is").value_or(false);
  options.keeps_outliers = project.trials.options.as_is;
  project.trials.steady_from_logs = json.optional_boolean("steady_from_logs").value_or(false);
}

/// Reads `heading_rate_limit`: a rate in deg/s, "measured" or "none".
void read_heading_rate(JsonObject& json, Project& project) {
  const auto rate = json.optional_number_or_string(
      "heading_rate_limit",
      {.min = kHeadingRateLimits_degps.lo, .max = kHeadingRateLimits_degps.hi});
  if (!rate) return;
  project.heading_rate_limit = *rate;
  if (const std::string why = fault_of_rate(*rate); !why.empty()) {
    json.fault(ErrorCode::kOutOfRange, "heading_rate_limit", why);
  }
}

void read_compare(JsonObject& json, const FileNames& files, Project& project) {
  project.scenarios = files.all_at(json, "scenarios");
  if (json.size("scenarios") == 0) {
    json.fault(ErrorCode::kMissing, "scenarios", "no scenario is given; name at least one file");
  }
  project.compare.samples =
      static_cast<int>(json.optional_integer("samples", 0, 1000000).value_or(0));
  project.compare.seed =
      static_cast<std::uint64_t>(json.optional_integer("seed", 0, 1000000000L).value_or(1));
  read_heading_rate(json, project);
}

constexpr std::string_view kProjectSchema = "awmr.project/1";

/// Converts the JSON content of a project file. `path`: the project file; file names in it are
/// relative to its directory.
Project project_from_json(JsonObject& json, const fs::path& path) {
  Project project;
  json.schema(kProjectSchema);
  const FileNames files(path);
  project.vehicle = files.at(json, "vehicle");
  json.object("trials", [&](JsonObject& trials) { read_trials(trials, files, project); });
  if (json.faults().empty() && paths_of(project.trials).empty()) {
    json.fault(ErrorCode::kMissing, "trials",
               "no trials: give at least one of surge, coastdown, turning, logs");
  }
  if (auto columns = json.optional_object("columns")) read_columns(*columns, "", project);
  json.optional_object("identify", [&](JsonObject& object) { read_identify(object, project); });
  project.tune = files.maybe_at(json, "tune");
  json.object("compare", [&](JsonObject& compare) { read_compare(compare, files, project); });
  json.reject_unknown_keys();
  return project;
}

}  // namespace

Result<Project> read_project(const fs::path& path) {
  return read_json_object(path, [&](JsonObject& json) { return project_from_json(json, path); });
}

std::string project_schema() {
  return json_schema_text(kProjectSchema, "A project: the inputs of `awmr run`",
                          [](JsonObject& json) { project_from_json(json, ""); });
}

}  // namespace awmr::cli
