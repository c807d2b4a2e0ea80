#include "run_files.h"

#include <fmt/format.h>

#include <utility>

#include "awmr/core/containers.h"
#include "awmr/core/file.h"
#include "awmr/core/json/json.h"
#include "awmr/core/json/json_document.h"
#include "awmr/emit/manifest.h"
#include "awmr/model/gains_file.h"
#include "awmr/model/model_file.h"
#include "awmr/model/paper_gains.h"
#include "awmr/report/report.h"
#include "awmr/simulate/conditions.h"
#include "awmr/simulate/run_file.h"
#include "awmr/simulate/scenario_file.h"
#include "awmr/simulate/simulate.h"

namespace awmr::cli {

namespace fs = std::filesystem;

namespace {

constexpr const char* kTuned = "tuned";
constexpr const char* kPaper = "paper";

/// A set of gains, and its name in the file name of a run: "tuned" or "paper".
struct NamedSet {
  const char* name;
  ModeGains gains;
};

std::string run_name(const fs::path& scenario, YawMode mode, const char* gains) {
  return fmt::format("run_{}_{}_{}.csv", scenario.stem().string(), name_of(mode), gains);
}

std::string scenario_name(const fs::path& scenario) {
  return fmt::format("scenario_{}.json", scenario.stem().string());
}

/// Simulates one run. Writes the run to the file `csv`, and its origin (inputs and options) to a
/// second file with the name `csv` + ".json". Returns the paths of both files.
Result<std::vector<fs::path>> write_run(const Model& model, const NamedSet& gains,
                                        const Scenario& scenario, YawMode mode,
                                        const std::vector<fs::path>& inputs,
                                        const InputNames& names, const fs::path& csv) {
  AWMR_ASSIGN_OR_RETURN(const Run run, simulate(model, gains.gains.in(mode), scenario, mode));
  AWMR_ASSIGN_OR_RETURN(std::vector<InputFile> files_read, input_files(inputs, names));
  const Provenance provenance{"simulate",
                              {{"mode", std::string(name_of(mode))}, {"gains", gains.name}},
                              std::move(files_read)};
  const std::string text = run_csv(run, scenario);
  const OutputFile files[] = {
      {csv, text, check_run_text},
      {run_side_path(csv), run_side_text(text, provenance, "", {}), check_json_text}};
  AWMR_RETURN_IF_ERROR(write_files(files));
  return std::vector<fs::path>{files[0].path, files[1].path};
}

}  // namespace

Result<std::vector<fs::path>> write_runs(const Project& project, const InputNames& names,
                                         const fs::path& directory) {
  std::vector<fs::path> written;
  AWMR_ASSIGN_OR_RETURN(const Model model, read_model(directory / "model.json"));
  AWMR_ASSIGN_OR_RETURN(const ModeGains tuned, read_mode_gains(directory / "gains.json"));
  for (const fs::path& path : project.scenarios) {
    AWMR_ASSIGN_OR_RETURN(Scenario scenario, read_scenario(path));
    scenario = equipped(model.vehicle, std::move(scenario));
    AWMR_ASSIGN_OR_RETURN(const std::string text, read_file(path));
    written.push_back(directory / scenario_name(path));
    AWMR_RETURN_IF_ERROR(write_file(written.back(), text, check_json_text));
    std::vector<fs::path> inputs{directory / "model.json", path};
    std::vector<fs::path> of_tuned = inputs;
    of_tuned.push_back(directory / "gains.json");
    for (const YawMode mode : yaw_modes(model.vehicle)) {
      for (const NamedSet& gains : {NamedSet{kTuned, tuned}, NamedSet{kPaper, kPaperGains}}) {
        AWMR_ASSIGN_OR_RETURN(
            const std::vector<fs::path> files,
            write_run(model, gains, scenario, mode, gains.name == kTuned ? of_tuned : inputs, names,
                      directory / run_name(path, mode, gains.name)));
        append(written, files);
      }
    }
  }
  return written;
}

std::vector<std::string> run_outputs(const Project& project) {
  std::vector<std::string> outputs{"model.json",    "gains.json",     "validation.json",
                                   "awmr_params.h", "comparison.csv", "comparison.json",
                                   "report.html"};
  for (const fs::path& path : project.scenarios) {
    outputs.push_back(scenario_name(path));
    for (const YawMode mode : kYawModes) {
      for (const char* gains : {kTuned, kPaper}) {
        const std::string run = run_name(path, mode, gains);
        outputs.push_back(run);
        outputs.push_back(run_side_path(run).string());
      }
    }
  }
  return outputs;
}

Status check_own_results(const fs::path& directory) {
  std::vector<Fault> faults;
  for (const char* name : {"model.json", "gains.json", "validation.json", "comparison.json"}) {
    const fs::path path = directory / name;
    AWMR_ASSIGN_OR_RETURN(const bool exists, regular_file_exists(path));
    if (!exists) continue;
    const auto json = read_json_file(path);
    if (json && json->is_object() && json->contains("command")) continue;
    faults.push_back({ErrorCode::kWouldOverwrite, path.string(),
                      "is not a result that awmr wrote, and run would replace it. Choose another "
                      "directory, or move the file away"});
  }
  for (const Status& status : {check_report_page(directory / "report.html"),
                               check_replaceable(directory, {{"awmr_params.h", ""}}),
                               check_replaceable(directory / kLibrary, library_outline())}) {
    if (status) continue;
    append(faults, status.error().faults);
  }
  if (!faults.empty()) return input_errors(std::move(faults));
  return {};
}

}  // namespace awmr::cli
