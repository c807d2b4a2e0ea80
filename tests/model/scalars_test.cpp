/// One model and one controller, instantiated for several scalar types.
#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <cmath>

#include "support/control_step.h"
#include "support/paper_vehicle.h"
#include "support/strict_scalar.h"

namespace awmr::testing {
namespace {

template <class T>
State<T> rates_of(const T& u, const T& v, const T& r, const T& steering) {
  return state_rates(paper_plant_of<T>(), State<T>{T(0.0), T(0.0), T(0.3), u, v, r, steering},
                     SideForces<T>{T(0.3), T(0.5)}, T(0.21));
}

TEST(Scalars, JetDerivativesAgreeWithCentralDifferences) {
  using Jet = ceres::Jet<double, 4>;
  const double at[4] = {1.2, 0.1, 0.4, 0.2};
  const State<Jet> jet = rates_of(Jet(at[0], 0), Jet(at[1], 1), Jet(at[2], 2), Jet(at[3], 3));
  constexpr double h = 1e-5;
  for (int i = 0; i < 4; ++i) {
    double up[4] = {at[0], at[1], at[2], at[3]};
    double down[4] = {at[0], at[1], at[2], at[3]};
    up[i] += h;
    down[i] -= h;
    const State<double> a = rates_of(up[0], up[1], up[2], up[3]);
    const State<double> b = rates_of(down[0], down[1], down[2], down[3]);
    // Errors of the central difference: truncation h^2 f'''/6 and rounding 1e-16 |f|/h, with f up
    // to about 1e2. Both are below 1e-7.
    EXPECT_NEAR(jet.u_mps.v[i], (a.u_mps - b.u_mps) / (2 * h), 1e-7);
    EXPECT_NEAR(jet.v_mps.v[i], (a.v_mps - b.v_mps) / (2 * h), 1e-7);
    EXPECT_NEAR(jet.r_radps.v[i], (a.r_radps - b.r_radps) / (2 * h), 1e-7);
  }
}

TEST(Scalars, StrictScalarRunsModelAndControllerToTheSameBits) {
  const State<Strict> strict = rates_of(Strict(1.2), Strict(0.1), Strict(0.4), Strict(0.2));
  const State<double> plain = rates_of(1.2, 0.1, 0.4, 0.2);
  EXPECT_EQ(strict.u_mps.value(), plain.u_mps);
  EXPECT_EQ(strict.v_mps.value(), plain.v_mps);
  EXPECT_EQ(strict.r_radps.value(), plain.r_radps);
  for (const YawMode mode : {YawMode::kDifferential, YawMode::kSteering, YawMode::kCombined}) {
    const Command<Strict> a = control_step(
        paper_controller_of<Strict>(), mode, {Strict(0.1), Strict(0.8), Strict(0.02), Strict(0.3)},
        {Strict(0.6), Strict(0.0), Strict(0.0), Strict(1.0), Strict(0.0)});
    const Command<double> b = control_step(paper_controller_of<double>(), mode,
                                           {0.1, 0.8, 0.02, 0.3}, {0.6, 0.0, 0.0, 1.0, 0.0});
    EXPECT_EQ(a.allocation.force.left.value(), b.allocation.force.left);
    EXPECT_EQ(a.allocation.force.right.value(), b.allocation.force.right);
    EXPECT_EQ(a.allocation.steering_rad.value(), b.allocation.steering_rad);
  }
}

TEST(Scalars, FloatAgreesWithDoubleToFloatPrecision) {
  for (const YawMode mode : {YawMode::kDifferential, YawMode::kSteering, YawMode::kCombined}) {
    const Command<float> a =
        control_step(paper_controller_of<float>(), mode, {0.1F, 0.8F, 0.02F, 0.3F},
                     {0.6F, 0.0F, 0.0F, 1.0F, 0.0F});
    const Command<double> b = control_step(paper_controller_of<double>(), mode,
                                           {0.1, 0.8, 0.02, 0.3}, {0.6, 0.0, 0.0, 1.0, 0.0});
    // Tolerance: about ten roundings of 6e-8 on values near 1.
    EXPECT_NEAR(static_cast<double>(a.tau_speed), b.tau_speed, 1e-6);
    EXPECT_NEAR(static_cast<double>(a.allocation.force.left), b.allocation.force.left, 1e-6);
    EXPECT_NEAR(static_cast<double>(a.allocation.steering_rad), b.allocation.steering_rad, 1e-6);
  }
}

}  // namespace
}  // namespace awmr::testing
