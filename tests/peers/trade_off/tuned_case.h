/// Converts a vehicle of tests/tune/vehicles.h to the inputs of the independent simulator, as plain
/// numbers.
#pragma once

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <random>

#include "awmr/core/units.h"
#include "awmr/simulate/conditions.h"
#include "awmr/tune/tune.h"
#include "peers/trade_off/front.h"

namespace awmr::peers {

inline Body body_of(const Model& model) {
  const auto value = [&model](ParameterId id) { return model[id].value.value_or(0.0); };
  return {.mass = value(ParameterId::kMassNorm),
          .inertia = value(ParameterId::kInertiaNorm),
          .surge = {value(ParameterId::kSurgeCoulomb), value(ParameterId::kSurgeAlpha),
                    value(ParameterId::kSurgeBeta), value(ParameterId::kSurgeQuadratic)},
          .yaw = {value(ParameterId::kYawCoulomb), value(ParameterId::kYawAlpha),
                  value(ParameterId::kYawBeta), value(ParameterId::kYawQuadratic)},
          .sway = value(ParameterId::kSwayAlpha)};
}

/// Bodies drawn independently from the covariance: exponents are normally distributed, other
/// parameters lognormally.
inline std::vector<Body> drawn_bodies(const Model& model, int count, std::uint64_t seed) {
  const std::vector<ParameterId>& ids = model.covariance.parameters;
  const auto n = static_cast<Eigen::Index>(ids.size());
  const auto is_exponent = [](ParameterId id) {
    return id == ParameterId::kSurgeBeta || id == ParameterId::kYawBeta;
  };
  Eigen::MatrixXd covariance(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      double c = model.covariance.matrix[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
      for (const Eigen::Index k : {i, j}) {
        const ParameterId id = ids[static_cast<std::size_t>(k)];
        if (!is_exponent(id)) c /= *model[id].value;
      }
      covariance(i, j) = c;
    }
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(covariance);
  const Eigen::MatrixXd factor =
      solver.eigenvectors() * solver.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::vector<Body> bodies;
  while (bodies.size() < static_cast<std::size_t>(count)) {
    Eigen::VectorXd z(n);
    for (double& one : z) one = normal(random);
    const Eigen::VectorXd moved = factor * z;
    Model drawn = model;
    bool is_possible = true;
    for (Eigen::Index i = 0; i < n; ++i) {
      const ParameterId id = ids[static_cast<std::size_t>(i)];
      double& value = *drawn[id].value;
      value = is_exponent(id) ? value + moved[i] : value * std::exp(moved[i]);
      is_possible = is_possible && value >= 0.0;
    }
    if (is_possible) bodies.push_back(body_of(drawn));
  }
  return bodies;
}

inline Course course_of(const Scenario& scenario) {
  const auto& steps = std::get<HeadingSteps>(scenario.guidance).steps;
  Course course{.speed_mps = scenario.speed_mps,
                .hold_s = scenario.duration_s / static_cast<double>(steps.size()),
                .headings_rad = {},
                .rate_limit_radps = {}};
  for (const HeadingStep& step : steps) course.headings_rad.push_back(step.psi_rad);
  if (scenario.shaping) course.rate_limit_radps = scenario.shaping->rate_max_radps;
  return course;
}

/// `limit_draws`: number of drawn bodies for which the limits have to hold.
inline Case case_of(const Model& model, const std::vector<Scenario>& scenarios,
                    const TuningLimits& limits, const ExaminedRange& examined, int limit_draws) {
  const Vehicle& v = model.vehicle;
  const LoopConditions c = conditions_of(v);
  Case one;
  one.model = body_of(model);
  one.vehicle = {.front_axle_m = v.front_axle_m,
                 .half_track_m = v.half_track_m,
                 .steering_max_rad = radians(v.steering_max_deg),
                 .steering_rate_radps = radians(v.steering_max_rate_degps),
                 .servo_s = v.has_steering() ? v.steering_time_constant_s : 0.0,
                 .sample_s = v.sample_time_s,
                 .force_min = v.wheel_force.lo,
                 .force_max = v.wheel_force.hi,
                 .motor_s = c.motor_time_constant_s};
  one.errors = {radians(c.heading_noise_deg),
                radians(c.yaw_rate_noise_degps),
                c.speed_noise_mps,
                c.heading_latency_s,
                c.yaw_rate_latency_s,
                c.speed_latency_s};
  one.modes = {Mode::kDifferential};
  if (v.has_steering()) one.modes = {Mode::kDifferential, Mode::kSteering, Mode::kCombined};
  for (const Scenario& scenario : scenarios) one.courses.push_back(course_of(scenario));
  one.limits = {.margin = 0.8,
                .damping = limits.damping,
                .late_damping = limits.late_damping,
                .delayed_damping = limits.delayed_damping,
                .noise_share = limits.noise_share,
                .steering_rate_degps = limits.steering_rate_rms_degps.value_or(0.0)};
  one.examined = {examined.speed_mps, examined.yaw_rate_radps};
  one.limit_bodies = drawn_bodies(model, limit_draws, 77);
  return one;
}

inline LawGains law_gains(const Gains<double>& g) {
  return {g.heading.lambda,
          g.heading.mu,
          g.heading.epsilon,
          g.speed.mu,
          g.speed.epsilon,
          g.heading.friction_width_radps,
          g.heading.combined_friction_width_radps};
}

}  // namespace awmr::peers
