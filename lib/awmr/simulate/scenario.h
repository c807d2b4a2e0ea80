/// scenario.json (`awmr.scenario/1`): what the vehicle is asked to do.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "awmr/control/yaw_mode.h"
#include "awmr/core/result.h"
#include "awmr/model/state.h"

namespace awmr {

/// Constant generalised forces, through the mode's allocation and limits.
struct OpenLoop {
  double tau_speed = 0.0;
  double tau_turn_m = 0.0;
};

struct HeadingStep {
  double t_s = 0.0;
  double psi_rad = 0.0;
};

/// Headings to hold, each from its time on; the first at t = 0.
struct HeadingSteps {
  std::vector<HeadingStep> steps;  ///< strictly increasing in time, not empty
};

using Guidance = std::variant<OpenLoop, HeadingSteps>;

struct Scenario {
  std::string name;
  double duration_s = 0.0;  ///< > 0
  State<double> initial{};
  double speed_mps = 0.0;   ///< u_d, >= 0
  Guidance guidance;
};

Result<Scenario> read_scenario(const std::filesystem::path& path);

/// "differential", "steering", "combined".
std::string_view name_of(YawMode mode);
std::optional<YawMode> yaw_mode_by_name(std::string_view name);
inline constexpr YawMode kYawModes[] = {YawMode::kDifferential, YawMode::kSteering,
                                        YawMode::kCombined};

}  // namespace awmr
