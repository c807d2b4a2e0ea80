/// Findings about model errors, from the drift in the noise of a fit.
#include "awmr/identify/logs/checks/log_checks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <tuple>
#include <vector>

#include "awmr/identify/logs/findings/term_findings.h"
#include "identify/synthetic_log.h"

namespace awmr::testing {
namespace {

/// Noise of a channel whose drift lasts 1 s and is `drift` times the sensor noise.
ChannelNoise noise_with(double drift) {
  constexpr double kSensor = 0.01;
  return {.white_std = kSensor,
          .drift_std = drift * kSensor,
          .correlation_s = 1.0,
          .sensor_std = kSensor};
}

/// Result of the check of a fit with this noise.
Adequacy adequacy_of(const NoiseLevels& noise) {
  static const std::vector<DrivingLog> logs{drive(kTruths[0], 1, {.duration_s = 2.0})};
  FamilyFit fit;
  fit.fit.quantities = {free_parameter(ParameterId::kSteeringTimeConstant),
                        free_parameter(ParameterId::kSwayAlpha)};
  fit.fit.coordinates = {std::log(0.05), std::log(10.0)};
  fit.fit.noise = noise;
  fit.fit.usable = true;
  return check_adequacy(logs, {}, fit, false);
}

/// True if the check has the finding `model-inadequate`, and it names `cause`: an option, a column
/// or a key of the vehicle file.
bool names_cause(const Adequacy& adequacy, const std::string& cause) {
  return adequacy.findings.size() == 1 && adequacy.findings.front().code == "model-inadequate" &&
         adequacy.findings.front().severity == Severity::kWarning &&
         adequacy.findings.front().message.find(cause) != std::string::npos;
}

TEST(Adequacy, OfSensorNoiseHasNoFinding) {
  const Adequacy adequacy = adequacy_of(
      {{{LogChannel::kSpeed}, noise_with(0.3)}, {{LogChannel::kYawRate}, noise_with(0.0)}});
  EXPECT_TRUE(adequacy.findings.empty());
  EXPECT_FALSE(adequacy.withdraws_intervals);
}

TEST(Adequacy, WithdrawsTheIntervalsOfADriftAboveTheNoise) {
  const Adequacy small = adequacy_of({{{LogChannel::kSpeed}, noise_with(1.0)}});
  EXPECT_TRUE(names_cause(small, "half_track_m"));
  EXPECT_FALSE(small.withdraws_intervals);
  EXPECT_FALSE(small.withdraws_servo);
  EXPECT_FALSE(small.withdraws_sway);
  EXPECT_TRUE(adequacy_of({{{LogChannel::kSpeed}, noise_with(3.0)}}).withdraws_intervals);
  // A compass can drift by itself if a gyroscope shows no model error.
  EXPECT_FALSE(adequacy_of({{{LogChannel::kYawRate}, noise_with(0.0)},
                            {{LogChannel::kHeading}, noise_with(3.0)}})
                   .withdraws_intervals);
  EXPECT_TRUE(adequacy_of({{{LogChannel::kHeading}, noise_with(3.0)}}).withdraws_intervals);
  EXPECT_TRUE(
      adequacy_of({{{LogChannel::kX}, noise_with(1.0)}, {{LogChannel::kY}, noise_with(0.0)}})
          .withdraws_intervals)
      << "logs of positions only";
}

TEST(Adequacy, NamesCausesOfTheChannel) {
  const Adequacy yaw = adequacy_of({{{LogChannel::kYawRate}, noise_with(1.0)}});
  EXPECT_TRUE(names_cause(yaw, "steering_deg"));
  EXPECT_TRUE(names_cause(yaw, "bias.yaw_rate_radps"));
  EXPECT_TRUE(yaw.withdraws_servo);
  EXPECT_FALSE(yaw.withdraws_sway);
  const Adequacy speed = adequacy_of({{{LogChannel::kSpeed}, noise_with(1.0)}});
  EXPECT_FALSE(names_cause(speed, "bias.yaw_rate_radps"));
  const Adequacy sway = adequacy_of({{{LogChannel::kSway}, noise_with(1.0)}});
  EXPECT_TRUE(names_cause(sway, "sway.alpha"));
  EXPECT_FALSE(names_cause(sway, "half_track_m")) << "only the causes of a sway speed";
  EXPECT_TRUE(sway.withdraws_sway);
}

/// Fit with one delay, lag or error of the value `value` and a small standard error.
LogFit fit_with_term(const FreeQuantity& quantity, double value) {
  LogFit fit;
  fit.quantities = {quantity};
  fit.coordinates = {value};
  fit.covariance = Eigen::MatrixXd::Constant(1, 1, 1e-8);
  fit.refusal_reason = {""};
  fit.noise = {{{LogChannel::kSpeed}, noise_with(0.0)}};
  fit.report.parameters = {{quantity.name(), value, 1e-4, {}, {}}};
  return fit;
}

TEST(WheelSlip, OfMoreThanAQuarterNeedsAPosition) {
  const FreeQuantity ratio = wheel_slip_of(LogChannel::kSpeed, true);
  EXPECT_FALSE(has_implausible_term(fit_with_term(ratio, 0.2)));
  LogFit large = fit_with_term(ratio, 0.3);
  EXPECT_TRUE(has_implausible_term(large));
  large.noise[{LogChannel::kX}] = noise_with(0.0);
  EXPECT_FALSE(has_implausible_term(large));
}

/// Codes of the findings about a delay or lag of this size if commands change up to 10 ms before or
/// after their expected times.
std::vector<std::string> codes_with(const FreeQuantity& quantity, double value) {
  LogFit fit = fit_with_term(quantity, value);
  fit.change_reach_s = 0.01;
  DrivingLog log;
  log.file = "log.csv";
  std::vector<std::string> codes;
  for (const Finding& finding : command_and_sensor_findings(fit, false, {log})) {
    codes.push_back(finding.code);
  }
  return codes;
}

TEST(CommandFindings, LeaveOutTimesWithinTheRowSpacing) {
  using Kind = FreeQuantity::Kind;
  const FreeQuantity sensor = free_term(Kind::kSensorDelay, LogChannel::kSpeed);
  for (const auto& [quantity, within, beyond, code] :
       {std::tuple(free_term(Kind::kDelay), 0.009, 0.012, "actuator-lag"),
        std::tuple(free_term(Kind::kMotorLag), 0.009, 0.012, "actuator-lag"),
        std::tuple(free_term(Kind::kSteeringDelay), 0.002, 0.004, "steering-delay"),
        std::tuple(sensor, 0.002, 0.004, "sensor-delay")}) {
    EXPECT_TRUE(codes_with(quantity, within).empty()) << code;
    EXPECT_EQ(codes_with(quantity, beyond), std::vector<std::string>{code}) << quantity.name();
  }
}

/// A fit whose errors of the yaw rate have this standard deviation.
LogFit fit_with_yaw_rate_error(double error_radps) {
  LogFit fit;
  fit.errors[{LogChannel::kYawRate}] = {
      {.error = {error_radps, -error_radps}, .since_s = {0.0, 1.0}}};
  return fit;
}

/// Replaces the yaw rate by that of rolling wheels with the wheelbase `wheelbase_m` and a steering
/// lag of 0.1 s.
void turn_like_a_car(double wheelbase_m, DrivingLog& log) {
  Random random(1, 9);
  double steering = 0.0;
  for (std::size_t i = 1; i < log.rows(); ++i) {
    const double share = 1.0 - std::exp(-(log.t_s[i] - log.t_s[i - 1]) / 0.1);
    steering += share * (log.driving_steering_rad()[i] - steering);
    log[LogChannel::kYawRate]->value[i] =
        log[LogChannel::kSpeed]->value[i] * std::tan(steering) / wheelbase_m +
        0.01 * random.normal();
  }
}

TEST(CarSteering, IsNamedIfItExplainsTheYawRateBetterThanTheFit) {
  DrivingLog log = drive(kTruths[0], 3, {.duration_s = 40.0});
  const double wheelbase_m = 0.7 * robot().length_m;
  turn_like_a_car(wheelbase_m, log);
  const auto found = car_steering_finding(robot(), {log}, fit_with_yaw_rate_error(0.2));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->code, "turns-like-a-car");
  EXPECT_EQ(found->severity, Severity::kWarning);
  EXPECT_FALSE(car_steering_finding(robot(), {log}, fit_with_yaw_rate_error(0.01)));
  Vehicle without_steering = robot();
  without_steering.drive = Drive::kDifferential;
  EXPECT_FALSE(car_steering_finding(without_steering, {log}, fit_with_yaw_rate_error(0.2)));
}

TEST(CarSteering, IsNotNamedForTheModelOrAnImpossibleWheelbase) {
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
    DrivingLog log = drive(kTruths[0], seed, {.duration_s = 40.0});
    EXPECT_FALSE(car_steering_finding(robot(), {log}, fit_with_yaw_rate_error(1.0))) << seed;
    turn_like_a_car(2.0 * robot().length_m, log);
    EXPECT_FALSE(car_steering_finding(robot(), {log}, fit_with_yaw_rate_error(1.0))) << seed;
    log[LogChannel::kSpeed].reset();
    EXPECT_FALSE(car_steering_finding(robot(), {log}, fit_with_yaw_rate_error(1.0))) << seed;
  }
}

}  // namespace
}  // namespace awmr::testing
