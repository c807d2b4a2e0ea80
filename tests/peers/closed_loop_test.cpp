/// SUNDIALS' CVODE as the reference of the closed loop: over each sample, from the row's state with
/// the row's held command and disturbance to the next row's state.
#include <cvode/cvode.h>
#include <gtest/gtest.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <algorithm>
#include <cmath>

#include "awmr/core/units.h"
#include "awmr/model/gains_file.h"
#include "awmr/model/rest.h"
#include "awmr/simulate/physics.h"
#include "awmr/simulate/simulate.h"
#include "support/paper_vehicle.h"

namespace awmr::testing {
namespace {

/// What holds over one sample.
struct Held {
  Plant<double> plant;
  RunRow row;
};

int rates(double, N_Vector y, N_Vector rate, void* user) {
  const auto* held = static_cast<const Held*>(user);
  const double* v = N_VGetArrayPointer(y);
  const State<double> s{v[0], v[1], v[2], v[3], v[4], v[5], v[6]};
  State<double> d = state_rates(held->plant, s, held->row.force, held->row.steering_command_rad);
  d.u_mps += held->row.disturbance.surge / held->plant.mass_norm;
  d.v_mps += held->row.disturbance.sway / held->plant.mass_norm;
  d.r_radps += held->row.disturbance.yaw_m / held->plant.inertia_norm;
  const double values[] = {d.x_m, d.y_m, d.psi_rad, d.u_mps, d.v_mps, d.r_radps, d.steering_rad};
  std::copy(std::begin(values), std::end(values), N_VGetArrayPointer(rate));
  return 0;
}

/// One CVODE for many short runs.
class Reference {
 public:
  Reference() {
    SUNContext_Create(nullptr, &context_);
    y_ = N_VNew_Serial(7, context_);
    N_VConst(0.0, y_);
    cvode_ = CVodeCreate(CV_BDF, context_);
    matrix_ = SUNDenseMatrix(7, 7, context_);
    solver_ = SUNLinSol_Dense(y_, matrix_, context_);
    EXPECT_EQ(CVodeInit(cvode_, rates, 0.0, y_), CV_SUCCESS);
    EXPECT_EQ(CVodeSStolerances(cvode_, 1e-10, 1e-12), CV_SUCCESS);
    EXPECT_EQ(CVodeSetUserData(cvode_, &held_), CV_SUCCESS);
    EXPECT_EQ(CVodeSetLinearSolver(cvode_, solver_, matrix_), CV_SUCCESS);
    EXPECT_EQ(CVodeSetMaxNumSteps(cvode_, 100000), CV_SUCCESS);
  }
  ~Reference() {
    CVodeFree(&cvode_);
    SUNLinSolFree(solver_);
    SUNMatDestroy(matrix_);
    N_VDestroy(y_);
    SUNContext_Free(&context_);
  }
  Reference(const Reference&) = delete;
  Reference& operator=(const Reference&) = delete;

  State<double> after(const Plant<double>& plant, const RunRow& row, double duration_s) {
    held_ = {plant, row};
    const State<double>& s = row.state;
    const double values[] = {s.x_m, s.y_m, s.psi_rad, s.u_mps, s.v_mps, s.r_radps, s.steering_rad};
    std::copy(std::begin(values), std::end(values), N_VGetArrayPointer(y_));
    EXPECT_EQ(CVodeReInit(cvode_, 0.0, y_), CV_SUCCESS);
    EXPECT_EQ(CVodeSetStopTime(cvode_, duration_s), CV_SUCCESS);
    double reached = 0.0;
    EXPECT_GE(CVode(cvode_, duration_s, y_, &reached, CV_NORMAL), 0);
    const double* v = N_VGetArrayPointer(y_);
    return {v[0], v[1], v[2], v[3], v[4], v[5], v[6]};
  }

 private:
  Held held_{};
  SUNContext context_ = nullptr;
  N_Vector y_ = nullptr;
  void* cvode_ = nullptr;
  SUNMatrix matrix_ = nullptr;
  SUNLinearSolver solver_ = nullptr;
};

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

TEST(Cvode, TheClosedLoopAgreesOverEverySampleInEveryMode) {
  const Plant<double> plant = paper_plant();
  constexpr double kSample_s = 0.01;
  const auto controller = make_controller(plant, paper_vehicle(), kPaperGains);
  Reference reference;
  for (const YawMode mode : kYawModes) {
    const awmr::Run run = simulate(plant, controller, disturbed_turns(), mode,
                                   {.sample_time_s = kSample_s, .substeps = {}});
    // The chord at rest is part of what is simulated, not of the integrator's error.
    const Plant<double> resolved = resolved_at_rest(plant, kSample_s / run.substeps);
    for (std::size_t i = 0; i + 1 < run.rows.size(); ++i) {
      const State<double> expected = reference.after(resolved, run.rows[i], kSample_s);
      const State<double>& found = run.rows[i + 1].state;
      // (h/T)^5/120 = 1e-6 of an excursion: d_r moves by 0.05 rad in a sample at most, v follows it
      // with 0.05 m/s; where the servo's rate limit or r = 0 is crossed inside a step, RK4 falls to
      // first order there, and r is off by up to I'z's response to g3's chord.
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
