/// Fuzz target: reads the bytes as a scenario and simulates it for 0.2 s. The rows are finite and
/// the commands within their limits, or reader or simulator return an error.
#include "awmr/simulate/scenario_file.h"

#include <algorithm>
#include <cmath>

#include "awmr/simulate/physics.h"
#include "awmr/simulate/run_file.h"
#include "awmr/simulate/simulate.h"
#include "fuzz/file_of_bytes.h"
#include "fuzz/target.h"
#include "support/paper_vehicle.h"

using awmr::fuzz::require;

namespace {

void check(const awmr::Run& run, const awmr::Plant<double>& plant) {
  require(!run.rows.empty(), "a run has a row");
  for (const awmr::RunRow& row : run.rows) {
    const awmr::State<double>& s = row.state;
    require(std::isfinite(s.x_m) && std::isfinite(s.y_m) && std::isfinite(s.psi_rad) &&
                std::isfinite(s.u_mps) && std::isfinite(s.v_mps) && std::isfinite(s.r_radps),
            "a state is finite");
    require(std::abs(row.force.left) <= 1.0 && std::abs(row.force.right) <= 1.0,
            "a force is within its limits");
    require(std::abs(row.steering_command_rad) <= plant.steering_max_rad * (1.0 + 1e-12),
            "a steering angle is within its limits");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  auto scenario = awmr::read_scenario(awmr::fuzz::file_of_bytes(data, size));
  if (!scenario) return 0;
  scenario->duration_s = std::min(scenario->duration_s, 0.2);
  const awmr::Plant<double> plant = awmr::testing::paper_plant();
  const auto controller =
      awmr::make_controller(plant, awmr::testing::paper_vehicle(), {{3.0, 50.0, 12.0}, {5.0, 1.2}});
  for (const awmr::YawMode mode : awmr::kYawModes) {
    const awmr::Run run = awmr::simulate(plant, controller, *scenario, mode, {});
    check(run, plant);
    const std::string text = awmr::run_csv(run, *scenario);
    require(text.find("nan") == std::string::npos && text.find("inf") == std::string::npos,
            "run.csv has only finite numbers");
  }
  return 0;
}
