#include "awmr/model/gains_file.h"

#include "awmr/core/json.h"

namespace awmr {

Result<Gains<double>> read_gains(const std::filesystem::path& path) {
  const auto json = read_json_file(path);
  if (!json) return tl::unexpected(json.error());
  std::vector<Fault> faults;
  JsonObject root(*json, path.string(), "", faults);
  root.schema("awmr.gains/1");

  JsonObject heading = root.object("heading");
  JsonObject speed = root.object("speed");
  const Gains<double> gains{.heading = {.lambda = heading.number("lambda", kPositive),
                                        .mu = heading.number("mu", kPositive),
                                        .epsilon = heading.number("epsilon", kPositive)},
                            .speed = {.mu = speed.number("mu", kPositive),
                                      .epsilon = speed.number("epsilon", kPositive)}};
  heading.reject_unknown_keys();
  speed.reject_unknown_keys();

  for (const std::string_view key : {"command", "version", "options", "inputs", "time_constants",
                                     "constraints", "objective", "metrics", "search", "baseline"}) {
    root.ignore(key);
  }
  root.reject_unknown_keys();
  if (!faults.empty()) return input_errors(std::move(faults));
  return gains;
}

}  // namespace awmr
