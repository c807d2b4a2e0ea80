/// Tyres fitted to logs of a vehicle whose simulator shares no code with the library.
#include "awmr/validate/tyre_fit.h"

#include <gtest/gtest.h>

#include "awmr/trials/replay.h"
#include "awmr/validate/validate.h"
#include "support/scratch_file.h"
#include "validate/tyre_vehicle.h"

namespace awmr::testing {
namespace {

std::vector<std::string> codes(const std::vector<Finding>& findings) {
  std::vector<std::string> codes;
  for (const Finding& finding : findings) codes.push_back(finding.code);
  return codes;
}

std::optional<TyreFit> fitted(const DrivingLog& log, std::vector<Finding>& findings) {
  auto fit = fit_tyres({log}, identified(), findings);
  EXPECT_TRUE(fit.has_value());
  return fit ? *fit : std::nullopt;
}

TEST(TyreFit, FindsTheTyresAndIsReadAsItWasWritten) {
  Model model = identified();
  model[ParameterId::kInertiaNorm].source = Source::kFitted;
  std::vector<Finding> findings;
  const auto fit =
      fit_tyres({driven({.friction = 0.5, .stiffness = 7.0})}, model, findings).value();
  ASSERT_TRUE(fit && fit->friction && fit->cornering_per_rad);
  EXPECT_EQ(codes(findings), (std::vector<std::string>{"inertia-of-logs", "plants-compared"}));
  EXPECT_LT(log_errors_off(*fit->friction, 0.5), 3.5) << *fit->friction->value;
  EXPECT_LT(log_errors_off(*fit->cornering_per_rad, 7.0), 3.5) << *fit->cornering_per_rad->value;
  EXPECT_EQ(fit->better, PlantKind::kFourWheel);
  EXPECT_EQ(fit->windows, 12);

  Validation validation;
  validation.tyres = fit;
  const ScratchFile file("validation.json", validation_text(validation, {"validate", {}, {}}));
  const auto read = read_tyres(file.path());
  ASSERT_TRUE(read) << read.error().faults.front().message;
  EXPECT_EQ(read->tyres.friction, fit->tyres.friction);
  EXPECT_EQ(read->tyres.cornering_per_rad, fit->tyres.cornering_per_rad);
  EXPECT_EQ(*read->friction->std_error, *fit->friction->std_error);
  EXPECT_EQ(read->better, fit->better);
  EXPECT_EQ(read->held_out.size(), 3U);
}

TEST(TyreFit, AVehicleWithoutTyresIsPredictedByTheModel) {
  const Model model = identified();
  const Plant<double> plant = model.plant().value();
  DrivingLog log = driven({});
  const LogSignals signals(log);
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  replay<double>(
      signals, 0, log.rows(), resolved_beside_friction(plant, 1e-3), nullptr, 1e-3, {},
      [&](std::size_t row, const State<double>& s) {
        log[LogChannel::kHeading]->value[row] = s.psi_rad + radians(1.0) * normal(random);
        log[LogChannel::kSpeed]->value[row] = s.u_mps + 0.02 * normal(random);
        log[LogChannel::kYawRate]->value[row] = s.r_radps + radians(0.5) * normal(random);
      });
  std::vector<Finding> findings;
  const auto fit = fitted(log, findings);
  if (fit) {
    EXPECT_EQ(fit->better, PlantKind::kModel);
  }
}

/// Logs at 50 Hz of controllers at 50 Hz and at 100 Hz, with the same alternating commands.
TEST(TyreFit, CommandsLostBetweenRowsWidenTheIntervals) {
  DrivingLog log = driven({.friction = 0.5, .stiffness = 7.0});
  for (std::size_t row = 0; row < log.rows(); ++row) {
    log.force_left[row] *= row % 2 == 0 ? 1.05 : 0.95;
    log.force_right[row] *= row % 2 == 0 ? 1.05 : 0.95;
  }
  std::vector<Finding> findings;
  Model model = identified();
  model.vehicle.sample_time_s = 0.02;
  const auto whole = fit_tyres({log}, model, findings).value();
  model.vehicle.sample_time_s = 0.01;
  const auto half = fit_tyres({log}, model, findings).value();
  ASSERT_TRUE(whole && whole->friction && whole->cornering_per_rad);
  ASSERT_TRUE(half && half->friction && half->cornering_per_rad);
  EXPECT_EQ(*half->friction->value, *whole->friction->value);
  EXPECT_EQ(*half->cornering_per_rad->value, *whole->cornering_per_rad->value);
  EXPECT_GT(*half->friction->std_error, *whole->friction->std_error);
  EXPECT_GT(*half->cornering_per_rad->std_error, *whole->cornering_per_rad->std_error);
}

TEST(TyreFit, NeedsBothKindsOfTurns) {
  for (const bool by_sides : {true, false}) {
    std::vector<Finding> findings;
    EXPECT_FALSE(fitted(driven({.by_sides = by_sides, .by_steering = !by_sides}), findings));
    EXPECT_EQ(codes(findings), std::vector<std::string>{"tyres-need-turns"});
  }
  std::vector<Finding> findings;
  EXPECT_FALSE(fitted(driven({.duration_s = 40.0}), findings));
  EXPECT_EQ(codes(findings), std::vector<std::string>{"tyres-need-turns"});
}

TEST(TyreFit, OtherDrivesAreRefused) {
  Model model = identified();
  model.vehicle.drive = awmr::Drive::kFrontWheel;
  std::vector<Finding> findings;
  EXPECT_FALSE(fit_tyres({driven({})}, model, findings));
}

}  // namespace
}  // namespace awmr::testing
