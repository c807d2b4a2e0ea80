/// Objective and metrics of gains, each recomputed from the runs.
#include "awmr/tune/objective.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "awmr/core/units.h"
#include "awmr/model/gains_file.h"
#include "awmr/simulate/simulate.h"
#include "awmr/tune/robust.h"
#include "tune/paper_model.h"

namespace awmr::testing {
namespace {

Scenario short_turn() {
  Scenario scenario;
  scenario.name = "turn";
  scenario.duration_s = 4.0;
  scenario.speed_mps = 1.0;
  scenario.guidance = HeadingSteps{{{0.0, radians(20.0)}}};
  return scenario;
}

/// Plants whose mass increases from one to the next; the first is the model's own.
ObjectiveSetting setting_of(int plants, double tail_share = 1.0) {
  const Model model = paper_model();
  ObjectiveSetting setting{.vehicles = {},
                           .vehicle = model.vehicle,
                           .weights = {},
                           .scenarios = {short_turn()},
                           .tail_share = tail_share,
                           .arithmetic = batch_arithmetic().value()};
  for (int i = 0; i < plants; ++i) {
    Plant<double> plant = model.plant().value();
    plant.mass_norm *= 1.0 + 0.2 * i;
    plant.inertia_norm *= 1.0 + 0.2 * i;
    setting.vehicles.push_back({plant, model.vehicle.wheel_force});
  }
  return setting;
}

/// Score of the paper's gains in the only scenario of the setting.
ModeScore score_of(const ObjectiveSetting& setting, std::size_t plant, YawMode mode) {
  const auto scores = run_all(setting, draw_noise(setting), std::span(&kPaperGains, 1)).front();
  const auto modes = yaw_modes(setting.vehicle);
  const auto place = std::find(modes.begin(), modes.end(), mode) - modes.begin();
  return scores.at(plant * modes.size() + static_cast<std::size_t>(place));
}

TEST(ModeScores, AreThoseOfTheRun) {
  const ObjectiveSetting setting = setting_of(2);
  const Controller<double> controller =
      make_controller(setting.vehicles[0].plant, setting.vehicle, kPaperGains);
  const ModeScore score = score_of(setting, 1, YawMode::kSteering);
  const awmr::Run run =
      simulate(setting.vehicles[1].plant, controller, setting.scenarios[0], YawMode::kSteering,
               {.sample_time_s = setting.vehicle.sample_time_s, .substeps = {}, .sample = 1});
  double squares = 0.0;
  double itae = 0.0;
  for (std::size_t i = 1; i < run.rows.size(); ++i) {
    const RunRow& a = run.rows[i - 1];
    const RunRow& b = run.rows[i];
    const double rate =
        degrees(b.steering_command_rad - a.steering_command_rad) / setting.vehicle.sample_time_s;
    squares += rate * rate;
    itae += 0.5 * setting.vehicle.sample_time_s *
            (a.t_s * std::abs(a.u_ref_mps - a.state.u_mps) +
             b.t_s * std::abs(b.u_ref_mps - b.state.u_mps));
  }
  const double rms = std::sqrt(squares / static_cast<double>(run.rows.size() - 1));
  EXPECT_GT(rms, 1.0);
  EXPECT_NEAR(score.metrics.steering_rate_rms_degps, rms, 1e-6 * rms);
  EXPECT_NEAR(score.metrics.speed_itae_m_s, itae, 1e-6 * itae);
  const double iae = *metrics_of(run, setting.scenarios[0], controller).heading_iae_degs;
  EXPECT_NEAR(*score.metrics.heading_iae_degs, iae, 1e-9 * iae);
}

/// Two headings, held for 1 and 3 s: an error of 0.5 deg has an ITAE of 0.5 (1 + 9)/2 = 2.5 deg
/// s^2.
TEST(UnsettledRuns, CountLongerTheFurtherTheyStayFromTheirHeading) {
  Scenario scenario;
  scenario.duration_s = 4.0;
  scenario.guidance = HeadingSteps{{{0.0, 0.0}, {1.0, 1.0}}};
  EXPECT_DOUBLE_EQ(unsettled_s(scenario, 0.0), 4.0);
  EXPECT_DOUBLE_EQ(unsettled_s(scenario, 2.5), 4.0);
  EXPECT_DOUBLE_EQ(unsettled_s(scenario, 7.5), 12.0);
}

TEST(ObjectiveTerms, AreRatiosAboveTheirFloors) {
  ModeScore score;
  ModeScore baseline;
  score.unsettled_s = 0.95;
  baseline.metrics.settling_time_s = 0.15;
  score.metrics.heading_itae_degs2 = 0.5;
  score.metrics.overshoot_deg = 1.5;
  score.metrics.control_variation = 0.05;
  score.metrics.control_effort = 0.004;
  score.metrics.speed_itae_m_s = 0.009;
  const auto by = [&](double ObjectiveWeights::*weight) {
    ObjectiveWeights weights{.settling = 0.0,
                             .itae = 0.0,
                             .overshoot = 0.0,
                             .control_variation = 0.0,
                             .effort = 0.0,
                             .speed_itae = 0.0};
    weights.*weight = 3.0;
    return objective_of(score, baseline, weights);
  };
  EXPECT_NEAR(by(&ObjectiveWeights::settling), (0.95 + 0.05) / (0.15 + 0.05), 1e-12);
  EXPECT_NEAR(by(&ObjectiveWeights::itae), (0.5 + 0.1) / 0.1, 1e-12);
  EXPECT_NEAR(by(&ObjectiveWeights::overshoot), (1.5 + 0.5) / 0.5, 1e-12);
  EXPECT_NEAR(by(&ObjectiveWeights::control_variation), (0.05 + 0.01) / 0.01, 1e-12);
  EXPECT_NEAR(by(&ObjectiveWeights::effort), (0.004 + 0.001) / 0.001, 1e-12);
  EXPECT_NEAR(by(&ObjectiveWeights::speed_itae), (0.009 + 0.001) / 0.001, 1e-12);
}

TEST(Objective, ScoresGainsThatDoNotSettleWhereTheBaselineDoes) {
  const Objective objective(setting_of(1), kPaperGains);
  ASSERT_TRUE(objective.baseline().scores[0].metrics.completed);
  Gains<double> dull = kPaperGains;
  dull.heading.lambda *= 0.02;
  const Evaluation evaluation = objective(dull);
  EXPECT_FALSE(evaluation.scores[0].metrics.completed);
  EXPECT_TRUE(evaluation.valid);
  EXPECT_GT(evaluation.objective, 1.0);
  EXPECT_THAT(objective.baseline().mode_activity, ::testing::Each(1.0));
}

TEST(Objective, OfSetsOfGainsTogetherIsThatOfEachAlone) {
  const Objective objective(setting_of(3), kPaperGains);
  std::vector<Gains<double>> gains(7, kPaperGains);
  for (std::size_t i = 0; i < gains.size(); ++i)
    gains[i].heading.mu *= 1.0 + 0.1 * static_cast<double>(i);
  const std::vector<Evaluation> together = objective(gains);
  ASSERT_EQ(together.size(), gains.size());
  for (std::size_t i = 0; i < gains.size(); ++i) {
    const Evaluation alone = objective(gains[i]);
    EXPECT_EQ(together[i].objective, alone.objective);
    EXPECT_EQ(together[i].mode_activity, alone.mode_activity);
  }
  EXPECT_EQ(together[0].objective, objective.baseline().objective);
}

TEST(Evaluated, AreTheOrderStatisticsOfAllPlantsButTheFirst) {
  const ObjectiveSetting setting = setting_of(6, 0.4);
  RobustTuning robust;
  evaluate_candidates(setting, {{"paper", kPaperGains}}, robust);
  ASSERT_EQ(robust.evaluated.size(), std::size(kYawModes));
  for (const EvaluatedGains& one : robust.evaluated) {
    std::vector<double> iae, variation;
    int completed = 0;
    for (std::size_t plant = 1; plant < 6; ++plant) {
      const ModeScore score = score_of(setting, plant, one.mode);
      iae.push_back(*score.metrics.heading_iae_degs);
      variation.push_back(score.metrics.control_variation);
      completed += score.metrics.completed ? 1 : 0;
    }
    EXPECT_EQ(one.completed_share, completed / 5.0);
    for (const EvaluatedFigure& figure : one.figures) {
      if (figure.name != "heading_iae_degs" && figure.name != "control_variation") continue;
      std::vector<double>& values = figure.name == "heading_iae_degs" ? iae : variation;
      std::sort(values.begin(), values.end());
      EXPECT_EQ(figure.median, values[2]);
      EXPECT_EQ(figure.q95, values[4]);
      EXPECT_DOUBLE_EQ(figure.tail_mean, 0.5 * (values[3] + values[4]));  // the worst 40 % of five
    }
  }
}

}  // namespace
}  // namespace awmr::testing
