#include "unstable_gains.h"

#include <fmt/format.h>

#include "awmr/tune/loop_stability.h"

namespace awmr::cli {

void note_unstable(const Model& model, const Gains<double>& gains,
                   const std::filesystem::path& gains_file, std::vector<Finding>& findings,
                   std::optional<YawMode> mode) {
  for (const UnstableLoop& loop : unstable_loops(model, gains, mode)) {
    findings.push_back(
        {gains_file.string(), 0, Severity::kWarning, "unstable-gains",
         fmt::format("the {} is unstable: {} is {:.3g} 1/s, too fast for the sample time of {:g} s "
                     "with the latency and the lag of the vehicle. Tune again for this model (awmr "
                     "tune)",
                     loop.name, loop.rate_name, loop.rate_per_s, model.vehicle.sample_time_s)});
  }
}

}  // namespace awmr::cli
