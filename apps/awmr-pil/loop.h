// The closed loop of simulate/ with the control step executed elsewhere, in float.
#pragma once

#include <vector>

#include "awmr/control/sensor_fault.h"
#include "awmr/core/progress.h"
#include "awmr/model/model.h"
#include "awmr/simulate/scenario.h"
#include "executor.h"
#include "pil_options.h"

namespace awmr::pil {

struct LoopSetup {
  Plant<double> plant;
  double sample_time_s = 0.01;
  double force_max = 1.0;
  Scenario scenario;
  Mission mission;  ///< mission_of() the scenario
  YawMode mode = YawMode::kCombined;
  cli::Injection injection = cli::Injection::kNone;
  SafetyLimits limits{};                 ///< the firmware's
  std::size_t middle = 0;                ///< the sample from which on the injection works
  std::vector<std::size_t> resets = {};  ///< samples before whose step the executor is reset
};

struct LoopRow {
  double t_s = 0.0;
  State<double> state{};
  Step step;
  SensorFault cause =
      kSensorGood;  ///< the first sensor that is not believed, where failures are injected
  SideForces<double> force{};         ///< the step's, as the actuators can make it
  double steering_command_rad = 0.0;  ///< the same
};

/// True where the simulated speed sensor gives |u|, and the firmware computes the direction.
bool has_unsigned_speed(const Scenario& scenario);

/// Errors (input): the scenario asks for what the firmware does not do.
Status check_scenario(const Scenario& scenario, const std::string& file);

/// Errors: the executor's. Ends with the scenario, or where its course does.
Result<std::vector<LoopRow>> run_loop(const LoopSetup& setup, Executor& executor,
                                      const Progress& progress = {});

}  // namespace awmr::pil
