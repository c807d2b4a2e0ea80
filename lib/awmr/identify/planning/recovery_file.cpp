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

}  // namespace awmr
