/// Exported parameters of autopilots, compared with the equations of ArduPilot's and PX4's control
/// loops.
#include "awmr/emit/export.h"

#include <gmock/gmock.h>

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <sstream>

#include "awmr/core/csv.h"
#include "awmr/core/units.h"
#include "awmr/model/steady.h"
#include "emit/paper_robot.h"

namespace awmr::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr Gains<double> kGains{{3.0, 50.0, 12.0}, {5.0, 1.2}};

Model differential_model() {
  Model model = paper_robot();
  model.vehicle.drive = Drive::kDifferential;
  return model;
}

std::string text_of(const Model& model, ExportFormat format, bool with_gains = true) {
  ExportSource source{.model = model};
  if (with_gains) source.gains = kGains;
  const auto text = export_text(source, format);
  return text ? *text : to_text(text.error());
}

/// Parses NAME,VALUE lines, or PX4's with tabs.
std::map<std::string, double> parameters_of(const std::string& text) {
  std::map<std::string, double> values;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line[0] == '#') continue;
    if (line.starts_with("1\t1\t")) line = line.substr(4);
    const std::size_t end = line.find_first_of(",\t");
    values[line.substr(0, end)] = std::stod(line.substr(end + 1));
  }
  return values;
}

// Tolerance: the values have six decimals, so a product of two has an error of some 1e-6 of the
// larger factor.
constexpr double kPrinted = 2e-5;

TEST(Export, RefusesBackEmfForAutopilots) {
  Model model = paper_robot();
  model[ParameterId::kBackEmf] = {0.25, 0.01, {}, Source::kFitted, "trajectory"};
  for (const ExportFormat format : {ExportFormat::kArduPilot, ExportFormat::kPx4}) {
    EXPECT_THAT(text_of(model, format), HasSubstr("/motor/back_emf_s_per_m"));
  }
  EXPECT_THAT(text_of(model, ExportFormat::kPython), HasSubstr("MOTOR_BACK_EMF_S_PER_M = 0.25"));
}

TEST(Export, RefusesFrontWheelDriveForAutopilots) {
  Model model = paper_robot();
  model.vehicle.drive = Drive::kFrontWheel;
  for (const ExportFormat format : {ExportFormat::kArduPilot, ExportFormat::kPx4}) {
    EXPECT_THAT(text_of(model, format), HasSubstr("/vehicle/drive"));
  }
}

TEST(Export, ArduPilotsCruiseHoldsItsSpeedAtItsThrottle) {
  const Model model = paper_robot();
  const auto values = parameters_of(text_of(model, ExportFormat::kArduPilot));
  const Plant<double> plant = *model.plant();
  EXPECT_EQ(values.at("CRUISE_THROTTLE"), 50.0);
  EXPECT_NEAR(plant.surge.at(values.at("CRUISE_SPEED")), 4.0 * 0.5, kPrinted);
}

TEST(Export, ArduPilotsSpeedLoopClosesWithTheTimeConstantOfTheSpeedLaw) {
  // The loop m' du/dt = 4 (K_p + K_i/s) e - g1'(u) u has the bandwidth mu_s/eps_s if K_p and K_i
  // cancel the plant's pole: K_i/K_p = g1'/m', and 4 K_p/m' = mu_s/eps_s.
  const Model model = paper_robot();
  const SpeedGains<double> gains = kGains.speed;
  const auto values = parameters_of(text_of(model, ExportFormat::kArduPilot));
  const Plant<double> plant = *model.plant();
  const double u = values.at("CRUISE_SPEED");
  const double slope = (plant.surge.at(u + 1e-4) - plant.surge.at(u - 1e-4)) / 2e-4;
  EXPECT_NEAR(4.0 * values.at("ATC_SPEED_P") / plant.mass_norm, gains.mu / gains.epsilon, 1e-3);
  EXPECT_NEAR(values.at("ATC_SPEED_I") / values.at("ATC_SPEED_P"), slope / plant.mass_norm, 1e-3);
}

TEST(Export, TheGainsOfAModeAreListedAndUsedByAnAutopilotOfThatMode) {
  ModeGains gains(kGains);
  const SpeedGains<double> steering{2.0, 1.0};
  gains.set(YawMode::kSteering, {{1.5, 20.0, 8.0}, steering});
  const Model model = paper_robot();
  const ExportSource source{.model = model, .gains = gains};
  const std::string csv = export_text(source, ExportFormat::kCsv).value();
  EXPECT_THAT(csv, AllOf(HasSubstr("heading_lambda,3"), HasSubstr("heading_lambda_steering,1.5")));
  const auto values = parameters_of(export_text(source, ExportFormat::kArduPilot).value());
  const Plant<double> plant = *model.plant();
  EXPECT_NEAR(4.0 * values.at("ATC_SPEED_P") / plant.mass_norm, steering.mu / steering.epsilon,
              1e-3);
}

TEST(Export, ArduPilotsSteeringFeedForwardTurnsSteeredWheelsAtTheRateRequested) {
  const Model model = paper_robot();
  const auto values = parameters_of(text_of(model, ExportFormat::kArduPilot));
  const Plant<double> plant = *model.plant();
  const double u = values.at("CRUISE_SPEED");
  // r is the rate for which ArduPilot commands half of the steering stop. Its output, 0.5, is FF r,
  // divided by u if u is above 1 m/s.
  const double r = 0.5 / (values.at("ATC_STR_RAT_FF") / std::max(1.0, u));
  const double moment =
      plant.front_axle_m * plant.surge.at(u) * std::tan(0.5 * 0.5 * plant.steering_max_rad);
  EXPECT_NEAR(plant.yaw.at(r), moment, 1e-4 * moment);
}

TEST(Export, WarnsOfArduPilotsValuesOutsideOfItsManual) {
  const Model model = paper_robot();
  const ExportSource source{.model = model, .gains = ModeGains(kPaperGains)};
  const auto findings = export_findings(source, ExportFormat::kArduPilot);
  ASSERT_TRUE(findings);
  ASSERT_EQ(findings->size(), 1U);
  EXPECT_EQ(findings->front().code, "autopilot-range");
  EXPECT_EQ(findings->front().severity, Severity::kWarning);
  EXPECT_THAT(findings->front().message, ::testing::HasSubstr("ATC_STR_RAT_FF"));
  EXPECT_TRUE(export_findings(source, ExportFormat::kRos2)->empty());
}

TEST(Export, Px4sFeedForwardTurnsSkidSteeringAtTheRateRequested) {
  const Model model = differential_model();
  const auto values = parameters_of(text_of(model, ExportFormat::kPx4));
  const Plant<double> plant = *model.plant();
  EXPECT_NEAR(plant.surge.at(values.at("RO_MAX_THR_SPEED")), 4.0, 1e-5);
  EXPECT_NEAR(values.at("RD_WHEEL_TRACK"), 2.0 * model.vehicle.half_track_m, 1e-6);
  const double r = radians(0.5 * values.at("RO_YAW_RATE_LIM"));
  const double s = r * 0.5 * values.at("RD_WHEEL_TRACK") * values.at("RO_YAW_RATE_CORR") /
                   values.at("RO_MAX_THR_SPEED");
  // F'R - F'L = 2 s makes 2 d (F'R - F'L) = 4 d s.
  EXPECT_NEAR(4.0 * plant.half_track_m * s, plant.yaw.at(r), 1e-5);
}

TEST(Export, Px4sYawRateLimitIsWhatFullCommandsGiveUpToWhatWasMeasured) {
  Model model = paper_robot();
  const Plant<double> plant = *model.plant();
  const auto limit = [&] {
    return radians(parameters_of(text_of(model, ExportFormat::kPx4)).at("RO_YAW_RATE_LIM"));
  };
  // 2 l_f F'max sin d_max = g3(r)                                                    [paper (62)]
  EXPECT_NEAR(plant.yaw.at(limit()), 2.0 * plant.front_axle_m * std::sin(plant.steering_max_rad),
              1e-6);
  model.vehicle.yaw_rate_max_degps = 15.0;
  EXPECT_NEAR(limit(), radians(15.0), 1e-8);
}

TEST(Export, LeavesOutAndReportsValuesThatDoNotFollowFromTheModel) {
  const std::string px4 = text_of(paper_robot(), ExportFormat::kPx4);
  EXPECT_THAT(px4, HasSubstr("# left out: RA_WHEEL_BASE: the model has only the front axle"));
  EXPECT_EQ(parameters_of(px4).count("RA_WHEEL_BASE"), 0U);
  EXPECT_NEAR(parameters_of(px4).at("RA_MAX_STR_ANG"),
              radians(paper_robot().vehicle.steering_max_deg), 1e-6);
  const std::string without = text_of(paper_robot(), ExportFormat::kArduPilot, false);
  EXPECT_THAT(without, HasSubstr("# left out: ATC_SPEED_P: it is computed from gains"));
  EXPECT_EQ(parameters_of(without).count("ATC_SPEED_P"), 0U);
}

TEST(Export, AnObserverIsAValueOfTheGainsAndLeftOutOfAnAutopilots) {
  ExportSource source{.model = paper_robot()};
  Gains<double> observed = kGains;
  observed.observer = {2.5, 0.04, 1.3};
  source.gains = observed;
  for (const ExportFormat format : {ExportFormat::kArduPilot, ExportFormat::kPx4}) {
    EXPECT_THAT(export_text(source, format).value(), HasSubstr("the disturbance observer"));
    EXPECT_THAT(text_of(source.model, format), Not(HasSubstr("the disturbance observer")));
  }
  const std::string csv = export_text(source, ExportFormat::kCsv).value();
  EXPECT_THAT(csv, AllOf(HasSubstr("observer_bandwidth_radps,2.5"), HasSubstr("observer_yaw_max_m"),
                         HasSubstr("observer_surge_max")));
  EXPECT_THAT(text_of(source.model, ExportFormat::kCsv), Not(HasSubstr("observer")));
}

TEST(Export, AModelWithoutAYawLawGivesTheSpeedLoop) {
  Model model = paper_robot();
  model[ParameterId::kYawAlpha].value.reset();
  const std::string text = text_of(model, ExportFormat::kPx4);
  EXPECT_EQ(parameters_of(text).count("RO_MAX_THR_SPEED"), 1U);
  EXPECT_THAT(text, HasSubstr("the model lacks the yaw law"));
  model[ParameterId::kSurgeAlpha].value.reset();
  EXPECT_THAT(text_of(model, ExportFormat::kPx4), HasSubstr("no value for surge.alpha"));
}

TEST(Export, TheIntervalOfADerivedNumberIsThatOfTheModelsCovariance) {
  // RO_MAX_THR_SPEED = (4/a1)^(1/b1): if only a1 is uncertain, the relative error is that of a1,
  // divided by b1.
  Model model = paper_robot();
  const double alpha = *model[ParameterId::kSurgeAlpha].value;
  for (const ParameterInfo& parameter : parameter_table()) {
    model[parameter.id].source = Source::kGiven;
  }
  model[ParameterId::kSurgeAlpha].source = Source::kFitted;
  model.covariance = {{ParameterId::kSurgeAlpha}, {{1e-4 * alpha * alpha}}};
  const double speed = std::pow(4.0 / alpha, 1.0 / *model[ParameterId::kSurgeBeta].value);
  const double error = 0.01 / *model[ParameterId::kSurgeBeta].value;
  EXPECT_THAT(text_of(model, ExportFormat::kPx4),
              HasSubstr(fmt::format("95 % [{:.4g}, {:.4g}]", speed * std::exp(-1.96 * error),
                                    speed * std::exp(1.96 * error))));
}

TEST(Export, CsvIsReadBackByOurReader) {
  const std::string text = text_of(paper_robot(), ExportFormat::kCsv);
  const CsvColumn columns[] = {{"value", true}};
  const auto table = read_csv_text(text, "export.csv", columns);
  ASSERT_TRUE(table) << to_text(table.error());
  EXPECT_EQ(table->column("value").front(), *paper_robot()[ParameterId::kSurgeAlpha].value);
  EXPECT_THAT(text, HasSubstr("heading_lambda,"));
}

TEST(Export, HostileNamesStayInTheirComment) {
  Model model = paper_robot();
  model.vehicle.name = "x\n*/ int y; /*\r%{\n\"\"\"'''\u2028# \\\n";
  for (const ExportFormat format : values_in(kExportFormatNames)) {
    Model plain = model;
    plain.vehicle.name = "x";
    const std::string hostile = text_of(model, format);
    const std::string good = text_of(plain, format);
    // Only the first line, a comment, differs.
    EXPECT_EQ(hostile.substr(hostile.find('\n')), good.substr(good.find('\n')));
    EXPECT_THAT(hostile.substr(0, hostile.find('\n')),
                AllOf(Not(HasSubstr("*/")), Not(HasSubstr("\r")), Not(HasSubstr("\u2028"))));
  }
}

}  // namespace
}  // namespace awmr::testing
