/// The integrator against SUNDIALS CVODE: the same equations of motion, somebody else's method.
#include <cvode/cvode.h>
#include <gtest/gtest.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <cmath>

#include "awmr/core/units.h"
#include "awmr/simulate/simulate.h"
#include "support/paper_vehicle.h"

namespace awmr::testing {
namespace {

/// What CVODE needs to know: the plant and the command, constant in open loop.
struct Problem {
  Plant<double> plant;
  SideForces<double> force;
  double steering_command_rad;
};

State<double> state_of(N_Vector y) {
  const double* v = N_VGetArrayPointer(y);
  return {v[0], v[1], v[2], v[3], v[4], v[5], v[6]};
}

int rates(double, N_Vector y, N_Vector rate, void* user) {
  const auto* problem = static_cast<const Problem*>(user);
  const State<double> d =
      state_rates(problem->plant, state_of(y), problem->force, problem->steering_command_rad);
  double* out = N_VGetArrayPointer(rate);
  const double values[] = {d.x_m, d.y_m, d.psi_rad, d.u_mps, d.v_mps, d.r_radps, d.steering_rad};
  for (int i = 0; i < 7; ++i) out[i] = values[i];
  return 0;
}

/// The state at `end_s`, BDF at tolerances far below what is asked of the simulator.
State<double> by_cvode(Problem problem, const State<double>& start, double end_s) {
  SUNContext context = nullptr;
  SUNContext_Create(nullptr, &context);
  N_Vector y = N_VNew_Serial(7, context);
  const double values[] = {start.x_m,   start.y_m,     start.psi_rad,     start.u_mps,
                           start.v_mps, start.r_radps, start.steering_rad};
  for (int i = 0; i < 7; ++i) N_VGetArrayPointer(y)[i] = values[i];
  void* cvode = CVodeCreate(CV_BDF, context);
  SUNMatrix matrix = SUNDenseMatrix(7, 7, context);
  SUNLinearSolver solver = SUNLinSol_Dense(y, matrix, context);
  EXPECT_EQ(CVodeInit(cvode, rates, 0.0, y), CV_SUCCESS);
  EXPECT_EQ(CVodeSStolerances(cvode, 1e-11, 1e-12), CV_SUCCESS);
  EXPECT_EQ(CVodeSetUserData(cvode, &problem), CV_SUCCESS);
  EXPECT_EQ(CVodeSetLinearSolver(cvode, solver, matrix), CV_SUCCESS);
  EXPECT_EQ(CVodeSetMaxNumSteps(cvode, 1000000), CV_SUCCESS);
  double reached = 0.0;
  EXPECT_GE(CVode(cvode, end_s, y, &reached, CV_NORMAL), 0);
  const State<double> end = state_of(y);
  CVodeFree(&cvode);
  SUNLinSolFree(solver);
  SUNMatDestroy(matrix);
  N_VDestroy(y);
  SUNContext_Free(&context);
  return end;
}

TEST(Cvode, OpenLoopPositionsAgreeAfterAMinuteInEveryMode) {
  const Plant<double> plant = paper_plant();
  Vehicle vehicle{};
  vehicle.wheel_force = {-1.0, 1.0};
  const Controller<double> controller = make_controller(plant, vehicle, {});
  for (const double tau_turn_m : {0.0, 0.05, 0.4}) {
    for (const YawMode mode : kYawModes) {
      const Scenario scenario{"open loop", 60.0, {}, 0.0, OpenLoop{2.0, tau_turn_m}};
      const awmr::Run run =
          simulate(plant, controller, scenario, mode, {.sample_time_s = 0.01, .substeps = {}});
      const RunRow& first = run.rows.front();
      const State<double> expected =
          by_cvode({plant, first.force, first.steering_command_rad}, {}, 60.0);
      const State<double>& found = run.rows.back().state;
      EXPECT_NEAR(run.rows.back().t_s, 60.0, 1e-9);
      EXPECT_NEAR(found.x_m, expected.x_m, 1e-5) << name_of(mode) << " " << tau_turn_m;
      EXPECT_NEAR(found.y_m, expected.y_m, 1e-5) << name_of(mode) << " " << tau_turn_m;
    }
  }
}

TEST(Simulate, ConvergesWithFourthOrderWhereTheModelIsSmooth) {
  Plant<double> plant = paper_plant();
  plant.steering_max_rate_radps = 1e6;  // no kink at the rate limit
  Vehicle vehicle{};
  vehicle.wheel_force = {-1.0, 1.0};
  const Controller<double> controller = make_controller(plant, vehicle, {});
  State<double> start{};
  start.u_mps = 1.0;
  start.r_radps = 0.3;  // away from the kink of the resistance at 0
  const Scenario scenario{"smooth", 1.0, start, 0.0, OpenLoop{1.5, 0.2}};
  const auto end = [&](int substeps) {
    return simulate(plant, controller, scenario, YawMode::kCombined,
                    {.sample_time_s = 0.01, .substeps = substeps})
        .rows.back()
        .state;
  };
  const State<double> reference = end(64);
  const auto error = [&](int substeps) {
    const State<double> s = end(substeps);
    return std::hypot(s.x_m - reference.x_m, s.y_m - reference.y_m);
  };
  // Each halving of the step divides the error by 2^4.
  EXPECT_NEAR(std::log2(error(2) / error(4)), 4.0, 0.3);
  EXPECT_NEAR(std::log2(error(4) / error(8)), 4.0, 0.3);
}

}  // namespace
}  // namespace awmr::testing
