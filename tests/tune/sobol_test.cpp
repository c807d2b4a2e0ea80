/// Sobol indices: functions with known indices, and the tuned loop's.
#include "awmr/tune/sobol.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "awmr/core/random.h"
#include "support/uncertain_model.h"
#include "tune/paper_model.h"

namespace awmr::testing {
namespace {

using ::testing::HasSubstr;

using Function = std::function<double(const std::vector<double>&)>;

/// Indices of a function of `inputs` numbers, each uniform in [-pi, pi].
std::vector<SobolIndex> indices_of(const Function& f, std::size_t inputs, std::size_t samples) {
  Random random(11, 1);
  const auto drawn = [&] {
    std::vector<double> x(inputs);
    for (double& one : x) one = std::numbers::pi * (2.0 * random.uniform() - 1.0);
    return x;
  };
  std::vector<double> of_a, of_b;
  std::vector<std::vector<double>> of_mixed(inputs);
  for (std::size_t j = 0; j < samples; ++j) {
    const std::vector<double> a = drawn();
    const std::vector<double> b = drawn();
    of_a.push_back(f(a));
    of_b.push_back(f(b));
    for (std::size_t i = 0; i < inputs; ++i) {
      std::vector<double> mixed = a;
      mixed[i] = b[i];
      of_mixed[i].push_back(f(mixed));
    }
  }
  return sobol_indices(of_a, of_b, of_mixed, 5);
}

TEST(Sobol, IndicesOfIshigamisFunctionAreTheKnownOnes) {
  // sin x1 + a sin^2 x2 + b x3^4 sin x1; T. Ishigami, T. Homma, 1990.
  constexpr double kA = 7.0, kB = 0.1, kPi = std::numbers::pi;
  const auto found = indices_of(
      [](const std::vector<double>& x) {
        return std::sin(x[0]) + kA * std::sin(x[1]) * std::sin(x[1]) +
               kB * std::pow(x[2], 4) * std::sin(x[0]);
      },
      3, 20000);
  const double pi4 = std::pow(kPi, 4);
  const double variance = kA * kA / 8.0 + kB * pi4 / 5.0 + kB * kB * pi4 * pi4 / 18.0 + 0.5;
  const double first[] = {0.5 * std::pow(1.0 + kB * pi4 / 5.0, 2) / variance,
                          kA * kA / 8.0 / variance, 0.0};
  const double together = 8.0 * kB * kB * pi4 * pi4 / 225.0 / variance;
  const double total[] = {first[0] + together, first[1], together};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(found[i].first, first[i], 0.03) << i;
    EXPECT_NEAR(found[i].total, total[i], 0.03) << i;
    EXPECT_TRUE(found[i].first_ci95.contains(found[i].first));
    EXPECT_TRUE(found[i].total_ci95.contains(found[i].total));
    EXPECT_LT(found[i].total_ci95.hi - found[i].total_ci95.lo, 0.1);
  }
}

TEST(Sobol, IndicesOfASumAreItsShares) {
  const auto found = indices_of(
      [](const std::vector<double>& x) { return 2.0 * x[0] + x[1] + 0.0 * x[2]; }, 3, 4000);
  const double shares[] = {0.8, 0.2, 0.0};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(found[i].first, shares[i], 0.05);
    EXPECT_NEAR(found[i].total, shares[i], 0.02);
  }
}

TEST(Sobol, AConstantInputHasIndexZero) {
  for (const double constant : {3.0, 1.38, 0.1, 44.1}) {
    for (const SobolIndex& index : indices_of([&](const auto&) { return constant; }, 2, 64)) {
      EXPECT_EQ(index.first, 0.0);
      EXPECT_EQ(index.total, 0.0);
      EXPECT_EQ(index.first_ci95.hi, 0.0);
    }
  }
}

TEST(Sensitivity, OfTheTunedLoopNamesWhatWasAssumed) {
  TuneOptions options;
  options.global_evaluations = 80;
  options.local_evaluations = 20;
  options.evaluation_draws = 0;
  options.draws = 1;
  options.sensitivity = 64;
  const Result<Tuning> tuning = tune(uncertain_model(), options);
  ASSERT_TRUE(tuning) << to_text(tuning.error());
  ASSERT_TRUE(tuning->robust->sensitivity);
  const GlobalSensitivity& found = *tuning->robust->sensitivity;
  EXPECT_EQ(found.figures.size(), 3U * std::size(kYawModes));
  EXPECT_EQ(found.inputs.back(), "noise realisation");
  for (const SensitiveFigure& figure : found.figures) {
    ASSERT_EQ(figure.by_input.size(), found.inputs.size());
    double totals = 0.0;
    for (const SobolIndex& index : figure.by_input) totals += index.total;
    if (figure.deviation > 0.0) {
      EXPECT_GT(totals, 0.8) << figure.name;  // together they explain all of it
    }
  }
  const std::string text =
      gains_text(*tuning, options, {.command = "tune", .options = {}, .inputs = {}});
  EXPECT_THAT(text, HasSubstr("\"sensitivity\""));
  // The gains equal those without sensitivity analysis.
  options.sensitivity = 0;
  EXPECT_EQ(tune(uncertain_model(), options)->gains.heading.mu, tuning->gains.heading.mu);
}

TEST(Sensitivity, RefusesSettingsWithoutMeaning) {
  TuneOptions options;
  options.sensitivity = 5;
  EXPECT_THAT(to_text(tune(uncertain_model(), options).error()), HasSubstr("neither 0 nor"));
  options.sensitivity = 64;
  options.nominal = true;
  EXPECT_THAT(to_text(tune(uncertain_model(), options).error()),
              HasSubstr("which nominal disables"));
  options.nominal = false;
  options.sensitivity = kMaxSobolSamples;
  options.scenarios = {default_tuning_scenario(paper_model()).value()};
  options.scenarios.front().duration_s = 18000.0;
  EXPECT_THAT(to_text(tune(uncertain_model(), options).error()), HasSubstr("steps"));
}

}  // namespace
}  // namespace awmr::testing
