/// For any robot and gains, an emitted controller's commands are finite and within its limits, or
/// the robot is refused.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "awmr/control/autopilot.h"
#include "emit/paper_robot.h"
#include "support/any_robot.h"
#include "support/no_parts.h"

namespace awmr::testing {
namespace {

float any_up_to(float largest) { return static_cast<float>(between(-1.0, 1.0)) * largest; }

AutopilotInput any_input(const SafetyLimits& limits) {
  return {.mode = static_cast<std::uint8_t>(*rc::gen::inRange(0, 3)),
          .measured = {any_up_to(4096.0F), any_up_to(limits.speed_max_mps),
                       any_up_to(limits.speed_max_mps), any_up_to(limits.yaw_rate_max_radps)},
          .position_m = {0.0F, 0.0F},
          .reference = {any_up_to(4096.0F), any_up_to(10.0F), any_up_to(10.0F),
                        any_up_to(limits.speed_max_mps), any_up_to(10.0F)},
          .times = {0, 0, 0, 0}};
}

template <class G>
void steps_stay_within_limits(const AutopilotParameters& p) {
  Autopilot<G, NoParts> autopilot{};
  RC_ASSERT(start_autopilot(autopilot, &p.block, p.surge.lines.data(), p.surge.lines.size(),
                            p.yaw.lines.data(), p.yaw.lines.size(), p.crc));
  for (int i = 0; i < 50; ++i) {
    AutopilotOutput out{};
    autopilot_step(autopilot, any_input(p.block.safety), out);
    RC_ASSERT(out.fault == kFaultNone);
    RC_ASSERT(std::isfinite(out.tau_speed) && std::isfinite(out.tau_turn_m));
    const auto& c = p.block.constants.allocation;
    RC_ASSERT(out.command.force.left >= c.force_min && out.command.force.left <= c.force_max);
    RC_ASSERT(out.command.force.right >= c.force_min && out.command.force.right <= c.force_max);
    RC_ASSERT(std::abs(out.command.steering_rad) <= c.steering_max_rad);
  }
}

void is_within_limits_or_refused(double beyond) {
  const Model model = any_model(beyond);
  const Gains<double> gains = any_gains(beyond);
  const auto header = params_header(model, gains, paper_inputs());
  if (header) RC_ASSERT(header->find("nan") == std::string::npos);
  for (const ResistanceForm form : {ResistanceForm::kTable, ResistanceForm::kPowf}) {
    const auto p = autopilot_parameters(model, gains, paper_inputs(), {.resistance = form});
    if (!p) {
      RC_ASSERT(p.error().kind != ErrorKind::kFault && !p.error().faults.empty());
    } else if (form == ResistanceForm::kTable) {
      for (const EmittedTable* table : {&p->surge, &p->yaw}) {
        RC_ASSERT(table->worst_relative_error <= p->table_error * (1.0 + 1e-6));
      }
      steps_stay_within_limits<ResistanceTable>(*p);
    } else {
      steps_stay_within_limits<Resistance<float>>(*p);
    }
  }
}

TEST(EmitProperty, InTheBoxEveryCommandIsWithinItsLimits) {
  EXPECT_TRUE(rc::check([] { is_within_limits_or_refused(1.0); }));
}

TEST(EmitProperty, TenTimesOutsideTheBoxTheSameHolds) {
  EXPECT_TRUE(rc::check([] { is_within_limits_or_refused(10.0); }));
}

}  // namespace
}  // namespace awmr::testing
