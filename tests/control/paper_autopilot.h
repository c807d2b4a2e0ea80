#pragma once
// Test fixture for complete autopilot steps: the paper's robot with safety limits.
#include <gtest/gtest.h>

#include "awmr/control/autopilot.h"
#include "support/no_parts.h"
#include "support/paper_vehicle.h"

namespace awmr::testing {

inline constexpr SafetyLimits kLimits{.speed_max_mps = 3.0F,
                                      .yaw_rate_max_radps = 8.0F,
                                      .heading_timeout_ms = 100,
                                      .speed_timeout_ms = 600,
                                      .command_timeout_ms = 1000,
                                      .step_timeout_ms = 30};

/// Autopilot parameters with kLimits and the paper's robot, and its inputs.
class PaperAutopilot : public ::testing::Test {
 protected:
  PaperAutopilot() {
    const Controller<float> controller = paper_controller_of<float>();
    block_.surge_alpha_beta[0] = controller.surge.alpha;
    block_.surge_alpha_beta[1] = controller.surge.beta;
    block_.yaw_alpha_beta[0] = controller.yaw.alpha;
    block_.yaw_alpha_beta[1] = controller.yaw.beta;
    block_.constants = prepared(controller).constants;
    block_.safety = kLimits;
    crc_ = crc32_of_parameters(&block_, nullptr, 0, nullptr, 0);
  }
  static AutopilotInput good() {
    return {.mode = 2,
            .measured = {0.1F, 1.0F, 0.01F, 0.2F},
            .position_m = {1.0F, 2.0F},
            .reference = {0.3F, 0.0F, 0.0F, 1.5F, 0.0F},
            .times = {1000, 1000, 1000, 1000}};
  }

  static constexpr Position<float> kPoints[] = {{5.0F, 5.0F}, {10.0F, 0.0F}};
  ParameterBlock block_{};
  std::uint32_t crc_ = 0;
};

}  // namespace awmr::testing
