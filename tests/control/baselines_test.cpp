/// Baseline laws: pure pursuit, integral line of sight, Stanley, LQI.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>

#include "awmr/control/guidance/line_laws.h"
#include "awmr/control/heading_lqi.h"
#include "support/any_robot.h"
#include "support/strict_scalar.h"

namespace awmr::testing::baselines_test {
namespace {

using P = Position<double>;
constexpr double kPi = pi<double>();
using Pursued = Polyline<double, PurePursuit<double>>;
constexpr LineMotion<double> kStraight{0.0, 1.0, 0.01};
constexpr LineMotion<double> kSlipping{0.1, 1.0, 0.01};

TEST(PurePursuit, GoesToTheFartherPointOfTheLineThatIsTheLookaheadAway) {
  const P points[] = {{0.0, 0.0}, {100.0, 0.0}};
  const Pursued line{points, 2, 0.0, {5.0, false}};
  auto progress = start_polyline(0.0);
  const auto guided = guide(line, P{10.0, 3.0}, kStraight, progress);
  EXPECT_NEAR(guided.psi_rad, std::atan2(-3.0, 4.0), 1e-15);  // towards (14, 0), 5 m away
  EXPECT_NEAR(guided.cross_track_m, 3.0, 1e-15);
  EXPECT_NEAR(guided.to_go_m, 90.0, 1e-12);
  // Farther than the lookahead: steer to the nearest point; before the line's start: to the start.
  EXPECT_NEAR(guide(line, P{10.0, -8.0}, kStraight, progress).psi_rad, kPi / 2.0, 1e-15);
  EXPECT_NEAR(guide(line, P{-9.0, 4.0}, kStraight, progress).psi_rad, std::atan2(-4.0, 9.0), 1e-15);
}

TEST(PurePursuit, TakesSideslipOffOnlyWhereRequested) {
  const P points[] = {{0.0, 0.0}, {100.0, 0.0}};
  auto progress = start_polyline(0.0);
  EXPECT_NEAR(guide(Pursued{points, 2, 0.0, {5.0, true}}, P{1.0, 0.0}, kSlipping, progress).psi_rad,
              -0.1, 1e-15);
  EXPECT_NEAR(
      guide(Pursued{points, 2, 0.0, {5.0, false}}, P{1.0, 0.0}, kSlipping, progress).psi_rad, 0.0,
      1e-15);
}

TEST(PurePursuit, TheGoalTurnsTheCornerBeforeTheVehicleWithoutAJump) {
  const P points[] = {{0, 0}, {10, 0}, {10, 0}, {10, 10}};  // the second segment has length 0
  const Pursued line{points, 4, 0.0, {2.0, false}};
  auto progress = start_polyline(0.0);
  EXPECT_NEAR(guide(line, P{7.999, 0.0}, kStraight, progress).psi_rad, 0.0, 1e-12);
  EXPECT_EQ(progress.segment, 0);
  // The target is the corner itself: 2 m ahead.
  EXPECT_NEAR(guide(line, P{8.0, 0.0}, kStraight, progress).psi_rad, 0.0, 1e-12);
  EXPECT_EQ(progress.segment, 2);
  // While the vehicle turns at the corner, the cross-track error is measured from the nearer
  // segment.
  const auto inside = guide(line, P{8.8, 0.4}, kStraight, progress);
  EXPECT_NEAR(inside.psi_rad, std::atan2(1.6, 1.2), 1e-12);  // the target is 2 m away
  EXPECT_NEAR(inside.cross_track_m, 1.2, 1e-12);             // the previous segment has no length
  EXPECT_FALSE(guide(line, P{10.0, 9.9}, kStraight, progress).finished);
  EXPECT_TRUE(guide(line, P{10.1, 10.0}, kStraight, progress).finished);
}

TEST(PurePursuit, TheErrorAtACornerIsFromTheNearerSegment) {
  const P points[] = {{0, 0}, {10, 0}, {10, 10}};
  const Pursued line{points, 3, 0.0, {2.0, false}};
  auto progress = start_polyline(0.0);
  EXPECT_NEAR(guide(line, P{8.5, 0.1}, kStraight, progress).cross_track_m, 0.1, 1e-12);
  EXPECT_EQ(progress.segment, 1);
  EXPECT_NEAR(guide(line, P{9.5, 1.0}, kStraight, progress).cross_track_m, 0.5, 1e-12);
}

TEST(PurePursuit, WithoutAnyLengthItIsFinishedAndTheHeadingHeld) {
  const P points[] = {{1, 1}, {1, 1}};
  auto progress = start_polyline(0.4);
  const auto guided = guide(Pursued{points, 2, 0.0, {1.0, true}}, P{0, 0}, kStraight, progress);
  EXPECT_TRUE(guided.finished);
  EXPECT_EQ(guided.psi_rad, 0.4);
}

AlongSegment<double> beside(double cross_track_m) { return {100.0, 1.0, 0.0, 10.0, cross_track_m}; }

TEST(Ilos, IsTheStatedEquation) {
  const IntegralLos<double> law{3.0, 0.5, true};
  double integral_s = 2.0;
  const double approach = approach_rad(law, beside(1.5), kStraight, integral_s);
  const double aside_m = 1.5 + 0.5 * 2.0;
  EXPECT_NEAR(approach, std::atan(aside_m / 3.0), 1e-15);
  EXPECT_NEAR(integral_s, 2.0 + 0.01 * 3.0 * 1.5 / (aside_m * aside_m + 9.0), 1e-15);
}

TEST(Ilos, FarFromTheLineTheIntegralHardlyGrows) {
  const IntegralLos<double> law{3.0, 0.5, false};
  double far_s = 0.0;
  double near_s = 0.0;
  approach_rad(law, beside(1000.0), kStraight, far_s);
  approach_rad(law, beside(3.0), kStraight, near_s);
  EXPECT_LT(far_s, 0.01 * near_s);
}

TEST(Ilos, RestartsOnEachSegment) {
  const P points[] = {{0, 0}, {10, 0}, {10, 10}};
  const Polyline<double, IntegralLos<double>> line{points, 3, 0.0, {2.0, 0.5, false}};
  auto progress = start_polyline(0.0);
  for (int i = 0; i < 100; ++i) guide(line, P{5.0, 1.0}, kStraight, progress);
  EXPECT_GT(progress.memory, 0.1);
  const auto turned = guide(line, P{10.0, 0.5}, kStraight, progress);
  EXPECT_EQ(progress.segment, 1);
  EXPECT_NEAR(turned.psi_rad, kPi / 2.0, 1e-15);
  EXPECT_EQ(progress.memory, 0.0);
}

TEST(Stanley, ApproachesByTheDistanceOverTheSpeed) {
  const Stanley<double> law{0.5, 0.2, true};
  double none = 0.0;
  EXPECT_NEAR(approach_rad(law, beside(1.5), {0.0, 2.0, 0.01}, none), std::atan(0.75 / 2.2), 1e-15);
  EXPECT_NEAR(approach_rad(law, beside(-1.5), {0.0, 0.0, 0.01}, none), -std::atan(0.75 / 0.2),
              1e-15);
  // rolling backward counts as at rest
  EXPECT_EQ(approach_rad(law, beside(1.5), {0.0, -5.0, 0.01}, none),
            approach_rad(law, beside(1.5), {0.0, 0.0, 0.01}, none));
}

using Real = long double;
using Matrix3 = Eigen::Matrix<Real, 3, 3>;
using Vector3 = Eigen::Matrix<Real, 3, 1>;
using Equations = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
using Unknowns = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

/// Linear plant for which the LQI gains are optimal: x_dot = A x + B w, x = (e, e_dot, z), with z
/// the integral of the heading error e.
struct LinearPlant {
  Matrix3 a = Matrix3::Zero();
  Vector3 b{0.0L, -1.0L, 0.0L};
  LinearPlant() { a(0, 1) = a(2, 0) = 1.0L; }
};

/// Stability by the criterion of Routh and Hurwitz: every root of s^3 + c2 s^2 + c1 s + c0 = det(s
/// I - A) has a negative real part.
bool is_stable(const Matrix3& a) {
  const Real c2 = -a.trace();
  const Real c1 = (a.trace() * a.trace() - (a * a).trace()) / 2.0L;
  const Real c0 = -a.determinant();
  return c2 > 0.0L && c0 > 0.0L && c2 * c1 > c0;
}

/// Spectral radius by Gelfand's formula: the limit of |A^n|^(1/n), here for n = 2^60, by repeated
/// squaring.
Real spectral_radius(Matrix3 power) {
  Real log_radius = 0.0L;
  for (int k = 0; k < 60; ++k) {
    const Real norm = power.cwiseAbs().maxCoeff();
    log_radius += std::ldexp(std::log(norm), -k);
    power /= norm;
    power *= power;
  }
  return std::exp(log_radius);
}

/// Solves A_c' P + P A_c + M = 0 for P by its nine linear equations.
Matrix3 lyapunov(const Matrix3& closed, const Matrix3& m) {
  Equations equations = Equations::Zero(9, 9);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      for (int k = 0; k < 3; ++k) {
        equations(i + 3 * j, k + 3 * j) += closed(k, i);
        equations(i + 3 * j, i + 3 * k) += closed(k, j);
      }
    }
  }
  const Unknowns right = -Eigen::Map<const Unknowns>(m.data(), 9);
  const Unknowns p = equations.fullPivLu().solve(right);
  return Eigen::Map<const Matrix3>(p.data());
}

LqiWeights<double> any_weights() {
  return {ratio_between(0.01, 3.0), ratio_between(0.01, 10.0), ratio_between(0.01, 100.0),
          ratio_between(1e-3, 3.0)};
}

/// The gains solve A'P + PA - P B R^-1 B' P + Q = 0 with P > 0, and the loop's poles are stable. P
/// is the cost of the loop closed with the gains. If B' P gives the same gains, they are optimal.
/// The gains are accurate to a few roundings of double, 1e-15, amplified by the loop's condition;
/// 1e-9 of the equation's largest term allows a factor of a million.
RC_GTEST_PROP(Lqi, TheGainsSolveTheRiccatiEquationAndTheLoopIsStable, ()) {
  const LqiWeights<double> weights = any_weights();
  const double inertia_norm = ratio_between(1e-3, 10.0);
  const LqiGains<double> gains = lqi_gains(weights, inertia_norm);
  const LinearPlant plant;
  // The law is w = -k x.
  const Vector3 k(-Real(gains.heading_per_s2), -Real(gains.rate_per_s),
                  -Real(gains.integral_per_s3));
  const Vector3 largest(weights.heading_rad, weights.yaw_rate_radps, weights.integral_rad_s);
  const Matrix3 q = largest.cwiseProduct(largest).cwiseInverse().asDiagonal();
  const Real w_max = Real(weights.tau_turn_m) / Real(inertia_norm);
  const Real r = 1.0L / (w_max * w_max);
  const Matrix3 closed = plant.a - plant.b * k.transpose();
  RC_ASSERT(is_stable(closed));
  const Matrix3 p = lyapunov(closed, q + r * k * k.transpose());
  RC_ASSERT(Eigen::LLT<Matrix3>(p).info() == Eigen::Success);  // P > 0
  const Vector3 optimal = plant.b.transpose() * p / r;
  // Each gain is multiplied by the largest value of its state, so that all states have equal
  // weight.
  const Vector3 off = (optimal - k).cwiseProduct(largest);
  RC_ASSERT(off.cwiseAbs().maxCoeff() < 1e-9L * k.cwiseProduct(largest).cwiseAbs().maxCoeff());
  const Matrix3 by_input = p * plant.b * plant.b.transpose() * p / r;
  const Matrix3 residual = plant.a.transpose() * p + p * plant.a - by_input + q;
  const Matrix3 scale = largest.asDiagonal();
  RC_ASSERT((scale * residual * scale).cwiseAbs().maxCoeff() <
            1e-9L * (scale * (by_input + q) * scale).cwiseAbs().maxCoeff());
}

/// settles_when_sampled() is true exactly if all eigenvalues of the sampled law are within the unit
/// circle.
RC_GTEST_PROP(Lqi, SettlesWhenSampledWhereEveryEigenvalueDoes, ()) {
  const LqiGains<double> gains = lqi_gains(any_weights(), ratio_between(1e-3, 10.0));
  const double t_s = ratio_between(1e-3, 1.0);
  Matrix3 step = Matrix3::Identity();  // transition matrix of (e, e_dot, z)
  step(0, 1) = step(2, 0) = Real(t_s);
  const Vector3 k(gains.heading_per_s2, gains.rate_per_s, gains.integral_per_s3);
  const Vector3 by_command(-0.5L * t_s * t_s, -Real(t_s), 0.0L);
  step += by_command * k.transpose();
  const Real largest = spectral_radius(step);
  RC_PRE(std::abs(largest - 1.0L) > 1e-9L);  // at 1, rounding decides whether the loop is stable
  RC_TAG(largest < 1.0L);
  RC_ASSERT(settles_when_sampled(gains, t_s) == (largest < 1.0L));
}

/// At the bounds of a scenario's parameters the gains are finite and solve their equations.
TEST(Lqi, TheGainsAreFiniteAtTheEndsOfTheirRanges) {
  for (const double heading_deg : {1e-3, 180.0}) {
    for (const double yaw_rate_degps : {1e-3, 1e5}) {
      for (const double integral_deg_s : {1e-3, 1e6}) {
        for (const double w_max : {1e-9, 1e12}) {
          const LqiGains<double> gains = lqi_gains<double>(
              {radians(heading_deg), radians(yaw_rate_degps), radians(integral_deg_s), w_max}, 1.0);
          const double c1 = std::pow(w_max / radians(heading_deg), 2.0);
          const double a1_squared = c1 + 2.0 * gains.integral_per_s3 * gains.rate_per_s;
          EXPECT_NEAR(gains.heading_per_s2 * gains.heading_per_s2 / a1_squared, 1.0, 1e-12);
        }
      }
    }
  }
}

TEST(Lqi, OnTheModelItselfTheErrorFollowsTheLinearLoop) {
  const Resistance<double> yaw{.alpha = 0.3, .beta = 0.8};
  const LqiGains<double> gains{1.0, 12.0, 7.0};
  LqiState<double> state{0.05, 0.0};
  const double tau_turn_m = lqi_law(yaw, 0.0121, gains, {0.2, 1.0, 0.0, 0.4},
                                    Reference<double>{0.5, 0.1, 0.7, 1.0, 0.0}, state);
  const double r_dot = (tau_turn_m - yaw(0.4)) / 0.0121;
  EXPECT_NEAR(0.7 - r_dot, -(12.0 * 0.3 + 7.0 * (0.1 - 0.4) + 1.0 * 0.05), 1e-12);
  EXPECT_NEAR(state.error_rad, 0.3, 1e-15);
}

TEST(Lqi, StopsIntegratingAtALimit) {
  const auto after = [](double error_rad, double made_m, bool limited) {
    LqiState<double> state{1.0, error_rad};
    Allocation<double> a{};
    a.force_limited = limited;
    integrate_error(0.5, a, {1.0, 0.1, made_m - 0.1}, 0.01, state);
    return state.integral_rad_s;
  };
  EXPECT_NEAR(after(0.2, 0.5, false), 1.002, 1e-15);
  EXPECT_EQ(after(0.2, 0.3, true), 1.0);
  EXPECT_NEAR(after(-0.2, 0.3, true), 0.998, 1e-15);        // integrates: e reduces the request
  EXPECT_NEAR(after(0.2, 0.5 - 1e-9, true), 1.002, 1e-15);  // integrates: reduced by rounding only
  EXPECT_NEAR(after(0.2, 0.48, false), 1.002, 1e-15);       // integrates: no limit reached
}

TEST(Baselines, MixNoDoubleIntoTheirScalar) {
  using S = Strict;
  const Position<S> points[] = {{S(1.0), S(2.0)}, {S(3.0), S(4.0)}};
  auto along = start_polyline(S(0.0));
  const LineMotion<S> motion{S(0.1), S(1.0), S(0.01)};
  const Polyline<S, PurePursuit<S>> pursued{points, 2, S(0.0), {S(1.0), true}};
  EXPECT_FALSE(guide(pursued, points[0], motion, along).finished);
  const Polyline<S, IntegralLos<S>> line{points, 2, S(0.0), {S(1.0), S(0.2), true}};
  EXPECT_FALSE(guide(line, points[0], motion, along).finished);
  const Polyline<S, Stanley<S>> smooth{points, 2, S(0.0), {S(1.0), S(0.2), true}};
  EXPECT_FALSE(guide(smooth, points[0], motion, along).finished);
  const LqiWeights<S> weights{S(0.2), S(0.4), S(1.0), S(0.02)};
  const LqiGains<S> gains = lqi_gains(weights, S(0.012));
  EXPECT_EQ(gains.rate_per_s.value(), lqi_gains<double>({0.2, 0.4, 1.0, 0.02}, 0.012).rate_per_s);
  LqiState<S> state{S(0.0), S(0.0)};
  const Resistance<S> yaw{S(0.3), S(0.8)};
  const S tau_turn_m = lqi_law(yaw, S(0.012), gains, {S(0.1), S(0.8), S(0.0), S(0.3)},
                               {S(0.6), S(0.0), S(0.0), S(1.0), S(0.0)}, state);
  integrate_error(tau_turn_m, Allocation<S>{}, {S(0.0), S(0.0), tau_turn_m}, S(0.01), state);
  EXPECT_NEAR(state.integral_rad_s.value(), 0.005, 1e-15);
}

}  // namespace
}  // namespace awmr::testing::baselines_test
