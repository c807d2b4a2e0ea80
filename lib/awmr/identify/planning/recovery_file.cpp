#include <fmt/format.h>

#include "awmr/core/json.h"
#include "awmr/identify/planning/recover.h"

namespace awmr {

std::string recovery_text(const Recovery& recovery, const Provenance& provenance) {
  Json json = output_document("awmr.recover/1", provenance);
  json["runs"] = recovery.runs;
  json["refused_runs"] = recovery.failed;
  json["noise"] = recovery.noise_text;
  json["parameters"] = Json::object();
  for (const RecoveredParameter& p : recovery.parameters) {
    json["parameters"][std::string(info(p.id).name)] = {{"truth", p.truth},
                                                        {"bias", p.bias},
                                                        {"rmse", p.rmse},
                                                        {"mean_std_error", p.mean_std_error},
                                                        {"coverage95", p.coverage95},
                                                        {"worst_relative_error", p.worst_error},
                                                        {"runs", p.runs}};
  }
  return to_text(json);
}

std::string recovery_table(const Recovery& recovery) {
  std::string text = fmt::format("{} runs, {} of them with a refused parameter; noise {}\n",
                                 recovery.runs, recovery.failed, recovery.noise_text);
  text += fmt::format("  {:<24} {:>10} {:>11} {:>10} {:>10} {:>9} {:>6}\n", "", "truth", "bias",
                      "rmse", "std error", "coverage", "runs");
  for (const RecoveredParameter& p : recovery.parameters) {
    text += fmt::format("  {:<24} {:>10.5g} {:>+11.2g} {:>10.2g} {:>10.2g} {:>7.1f} % {:>6}\n",
                        info(p.id).name, p.truth, p.bias, p.rmse, p.mean_std_error,
                        100.0 * p.coverage95, p.runs);
  }
  return text;
}

}  // namespace awmr
