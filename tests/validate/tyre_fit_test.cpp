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

/// A controller at 100 Hz whose commands alternate, and its log with every other row.
TEST(TyreFit, CommandsLostBetweenRowsWidenTheIntervals) {
  LogDrive drive{.friction = 0.5, .stiffness = 7.0};
  drive.row_s = 0.01;
  drive.alternating = 0.3;
  DrivingLog log = every_other_row(driven(drive));
  std::vector<Finding> findings;
  const auto fit = fitted(log, findings);
  ASSERT_TRUE(fit && fit->friction && fit->cornering_per_rad);
  EXPECT_TRUE(fit->friction->ci95->contains(0.5)) << *fit->friction->value;
  EXPECT_TRUE(fit->cornering_per_rad->ci95->contains(7.0)) << *fit->cornering_per_rad->value;
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
