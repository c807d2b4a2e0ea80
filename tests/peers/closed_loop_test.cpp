/// Closed-loop simulation compared with Boost.odeint: from each row's state, odeint integrates to
/// the next row with the row's command and disturbance held.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "awmr/core/units.h"
#include "awmr/model/gains_file.h"
#include "awmr/model/rest.h"
#include "awmr/simulate/physics.h"
#include "awmr/simulate/simulate.h"
#include "peers/reference_integrator.h"
#include "support/paper_vehicle.h"

namespace awmr::testing {
namespace {

/// State one sample after the row, with the row's command and disturbance held.
State<double> reference(const Plant<double>& plant, const RunRow& row, double duration_s) {
  const auto rates = [&](const State<double>& s) {
    State<double> d = state_rates(plant, s, row.force, row.steering_command_rad);
    d.u_mps += row.disturbance.surge / plant.mass_norm;
    d.v_mps += row.disturbance.sway / plant.mass_norm;
    d.r_radps += row.disturbance.yaw_m / plant.inertia_norm;
    return d;
  };
  return integrate_reference(rates, row.state, duration_s);
}

Scenario disturbed_turns() {
  Scenario s{.name = "turns",
             .duration_s = 6.0,
             .initial = {},
             .speed_mps = 1.0,
             .guidance = HeadingSteps{{{0.0, radians(40.0)}, {3.0, radians(-40.0)}}}};
  s.initial.u_mps = 0.5;
  DisturbanceTerm push;
  push.kind = DisturbanceTerm::Kind::kSine;
  push.value = 0.1;
  push.frequency_hz = 0.5;
  push.phase_rad = 0.3;
  s.disturbance.surge = s.disturbance.sway = {push};
  push.value = 0.02;
  s.disturbance.yaw = {push};
  return s;
}

TEST(ReferenceIntegrator, TheClosedLoopAgreesOverEverySampleInEveryMode) {
  const Plant<double> plant = paper_plant();
  constexpr double kSample_s = 0.01;
  const auto controller = make_controller(plant, paper_vehicle(), kPaperGains);
  for (const YawMode mode : kYawModes) {
    const awmr::Run run =
        simulate(plant, controller, disturbed_turns(), mode, {.sample_time_s = kSample_s});
    // Near rest, the simulator replaces each resistance by a chord. The reference uses the same
    // chord, because it is part of the simulated equations and no error of the integrator.
    const Plant<double> resolved = resolved_at_rest(plant, kSample_s / run.substeps);
    for (std::size_t i = 0; i + 1 < run.rows.size(); ++i) {
      const State<double> expected = reference(resolved, run.rows[i], kSample_s);
      const State<double>& found = run.rows[i + 1].state;
      // RK4's error in a step h is (h/T)^5/120 = 1e-6 of the change: d_r changes by at most 0.05
      // rad per sample, and v by 0.05 m/s. If the servo's rate limit or r = 0 is crossed within a
      // step, RK4 has only first order there. The error of r is then up to the response of I'z to
      // the chord of g3.
      EXPECT_NEAR(found.x_m, expected.x_m, 1e-6) << name_of(mode) << " row " << i;
      EXPECT_NEAR(found.y_m, expected.y_m, 1e-6) << name_of(mode) << " row " << i;
      EXPECT_NEAR(found.psi_rad, expected.psi_rad, 1e-5) << name_of(mode) << " row " << i;
      EXPECT_NEAR(found.u_mps, expected.u_mps, 1e-4) << name_of(mode) << " row " << i;
      EXPECT_NEAR(found.v_mps, expected.v_mps, 1e-4) << name_of(mode) << " row " << i;
      EXPECT_NEAR(found.r_radps, expected.r_radps, 1e-3) << name_of(mode) << " row " << i;
    }
  }
}

}  // namespace
}  // namespace awmr::testing
