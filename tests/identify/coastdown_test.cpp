/// Identification of m' from coast-downs: exact curves, several runs, motors that go off at an
/// unknown time, no surge trial, curves together with stop times.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "awmr/identify/planning/synthetic.h"
#include "awmr/model/steady.h"
#include "identify/synthetic.h"
#include "support/paper_vehicle.h"

namespace awmr::testing {
namespace {

Plant<double> plant(const Truth& t) {
  Plant<double> plant = paper_plant();
  plant.surge = {.alpha = t.a1, .beta = t.b1};
  plant.yaw = {.alpha = t.a3, .beta = t.b3};
  plant.mass_norm = t.mass_norm;
  plant.inertia_norm = t.mass_norm * 0.196;
  return plant;
}

/// u(t)^(1-b) = u0^(1-b) - (1-b)(a/m') t                                         [paper (58)]
double closed_form(const Truth& t, double u0, double time_s) {
  const double s = 1.0 - t.b1;
  const double base = std::pow(u0, s) - s * t.a1 / t.mass_norm * time_s;
  return base > 0.0 ? std::pow(base, 1.0 / s) : 0.0;
}

CoastCurve exact_curve(const Truth& t, double u0, double plateau_s) {
  CoastCurve curve{"curve.csv", 2, {}, {}};
  for (int i = 0; i < 150; ++i) {
    const double time_s = 0.01 * i;
    curve.t_s.push_back(5.0 + time_s);
    curve.speed_mps.push_back(closed_form(t, u0, std::max(0.0, time_s - plateau_s)));
  }
  return curve;
}

TrialData surge_only(const Truth& t, double sigma, std::uint64_t seed) {
  TrialData data = synthetic(t, sigma, seed);
  data.turning.reset();
  data.coastdown.reset();
  return data;
}

TEST(CoastDown, AnExactCurveGivesTheMass) {
  for (const Truth& t : kTruths) {
    TrialData data = surge_only(t, 0.0, 1);
    data.curves = {exact_curve(t, 1.5, 0.0), exact_curve(t, 0.9, 0.0)};
    const auto result = identify(vehicle(), data, {}, {});
    ASSERT_TRUE(result);
    EXPECT_TRUE(result->refused.empty());
    EXPECT_NEAR(*result->model[ParameterId::kMassNorm].value / t.mass_norm, 1.0, 1e-8);
    EXPECT_EQ(result->model[ParameterId::kMassNorm].method, "coast-down curve");
  }
}

TEST(CoastDown, CurvesOfFourRowsGiveTheMass) {
  for (const Truth& t : kTruths) {
    TrialData data = surge_only(t, 0.0, 1);
    for (const double u0 : {1.5, 1.2, 0.9}) {
      CoastCurve curve{"curve.csv", 2, {}, {}};
      for (int i = 0; i < 4; ++i) {
        curve.t_s.push_back(0.1 * i);
        curve.speed_mps.push_back(closed_form(t, u0, 0.1 * i));
      }
      data.curves.push_back(curve);
    }
    const auto result = identify(vehicle(), data, {}, {});
    ASSERT_TRUE(result);
    ASSERT_TRUE(result->model[ParameterId::kMassNorm].value);
    EXPECT_NEAR(*result->model[ParameterId::kMassNorm].value / t.mass_norm, 1.0, 1e-6);
  }
}

TEST(CoastDown, FindsTheMomentOfMotorsOffInACurveRecordedFromBefore) {
  const Truth& t = kTruths[1];
  TrialData data = surge_only(t, 0.0, 1);
  data.curves = {exact_curve(t, 1.5, 0.4037)};
  const auto result = identify(vehicle(), data, {}, {});
  ASSERT_TRUE(result);
  EXPECT_NEAR(*result->model[ParameterId::kMassNorm].value / t.mass_norm, 1.0, 1e-6);
}

TEST(CoastDown, TheClosedFormIsTheIntegratedOneForOtherFamiliesToo) {
  // Resistance c + alpha u: u(t) = (u0 + c/alpha) e^(-alpha t/m') - c/alpha until rest. The fit
  // integrates the motion by RK4 with steps of 2 ms.
  const double alpha = 1.1, c = 0.2, m = 0.3, u0 = 1.4;
  TrialData data;
  data.surge = TrialSet<SurgeRow>{"surge.csv", {}, 0};
  for (int i = 1; i <= 10; ++i) {
    data.surge->rows.push_back({i + 1, c + alpha * 0.15 * i, 0.15 * i, {}, {}});
  }
  CoastCurve curve{"curve.csv", 2, {}, {}};
  for (int i = 0; i < 100; ++i) {
    const double time_s = 0.01 * i;
    curve.t_s.push_back(time_s);
    curve.speed_mps.push_back(
        std::max(0.0, (u0 + c / alpha) * std::exp(-alpha * time_s / m) - c / alpha));
  }
  data.curves = {curve};
  IdentifyOptions options;
  options.surge_family.family = Family::kCoulombLinear;
  const auto result = identify(vehicle(), data, options, {});
  ASSERT_TRUE(result);
  // Tolerance: the vehicle stops in the middle of an integration step h, which causes an error of
  // about c h/m' = 1e-3 m/s in one of the hundred rows.
  EXPECT_NEAR(*result->model[ParameterId::kMassNorm].value / m, 1.0, 1e-3);
}

TEST(CoastDown, HasAMuchSmallerErrorThanAStopTime) {
  const Truth& t = kTruths[0];
  TrialData stop = surge_only(t, 0.02, 7);
  stop.coastdown = TrialSet<StopTimeRow>{
      "stop.csv", {{2, 1.6, *stop_time_s(plant(t).surge, t.mass_norm, 1.6)}}, 0};
  TrialData curve = surge_only(t, 0.02, 7);
  Random random(1, 1);
  curve.curves = {simulate_coastdown(plant(t), 1.6, 2.0, 100.0, 0.02, 0.0, random)};
  const auto by_stop = identify(vehicle(), stop, {}, {});
  const auto by_curve = identify(vehicle(), curve, {}, {});
  ASSERT_TRUE(by_stop && by_curve);
  const auto relative = [](const Model& m) {
    return *m[ParameterId::kMassNorm].std_error / *m[ParameterId::kMassNorm].value;
  };
  // The derivative d ln m'/d b1 is about -8 for m' from stop times, and below 1 for m' from the
  // curve.
  EXPECT_LT(relative(by_curve->model), 0.4 * relative(by_stop->model));
}

TEST(CoastDown, WithoutASurgeLawRefusesTheMassAndReportsTheRatio) {
  const Truth& t = kTruths[1];
  TrialData data;
  data.curves = {exact_curve(t, 1.5, 0.0)};
  const auto result = identify(vehicle(), data, {}, {});
  ASSERT_TRUE(result);
  EXPECT_THAT(result->refused,
              ::testing::ElementsAre(ParameterId::kMassNorm, ParameterId::kInertiaNorm));
  EXPECT_NEAR(*result->model[ParameterId::kSurgeBeta].value, t.b1, 1e-6);
  bool reported = false;
  for (const Finding& f : result->model.record.findings) {
    reported = reported || (f.code == "not-identifiable" &&
                            f.message.find("m'/a1 = 0.5556") != std::string::npos);
  }
  EXPECT_TRUE(reported);  // m'/a1 = 0.5/0.9
}

TEST(CoastDown, SetsAsideACurveWithoutADeceleration) {
  TrialData data = surge_only(kTruths[0], 0.0, 1);
  CoastCurve flat{"curve.csv", 2, {}, {}};
  Random random(3, 1);
  for (int i = 0; i < 100; ++i) {
    flat.t_s.push_back(0.01 * i);
    flat.speed_mps.push_back(1.0 + 0.01 * random.normal());
  }
  data.curves = {flat};
  const auto result = identify(vehicle(), data, {}, {});
  ASSERT_TRUE(result);
  EXPECT_THAT(result->refused,
              ::testing::ElementsAre(ParameterId::kMassNorm, ParameterId::kInertiaNorm));
}

/// Three coast-downs with m' = 0.5 and the resistance c1 + a1 u + q1 u^2, without a surge trial.
TrialData curves_alone(const Resistance<double>& law) {
  Plant<double> vehicle = plant(kTruths[0]);
  vehicle.surge = law;
  vehicle.mass_norm = 0.5;
  TrialData data;
  for (std::uint64_t run = 0; run < 3; ++run) {
    Random random(7, run);
    data.curves.push_back(simulate_coastdown(vehicle, 1.6, 2.0, 100.0, 0.01, 0.0, random));
  }
  return data;
}

const EstimatorParameter* found(const Model& model, const std::string& family,
                                const std::string& name) {
  for (const EstimatorReport& report : model.record.reports) {
    for (const EstimatorParameter& p : report.parameters) {
      if (report.family == family && p.name == name) return &p;
    }
  }
  return nullptr;
}

TEST(CoastDown, AloneGivesTheRatiosOfTheRequestedFamily) {
  const TrialData data = curves_alone({.alpha = 0.8, .beta = 1.0, .coulomb = 0.4});
  IdentifyOptions options;
  options.surge_family = {.family = Family::kCoulombLinear, .requested = true};
  const auto result = identify(vehicle(), data, options, {});
  ASSERT_TRUE(result);
  const auto* mass = found(result->model, "coulomb-linear", "mass_norm/surge.alpha");
  const auto* coulomb = found(result->model, "coulomb-linear", "surge.coulomb/surge.alpha");
  ASSERT_TRUE(mass && coulomb);
  // Tolerance: four standard errors; each is a few per cent.
  EXPECT_NEAR(mass->value, 0.5 / 0.8, 4.0 * *mass->std_error);
  EXPECT_NEAR(coulomb->value, 0.4 / 0.8, 4.0 * *coulomb->std_error);
  EXPECT_LT(*mass->std_error, 0.1 * mass->value);
  EXPECT_EQ(found(result->model, "coulomb-linear", "surge.beta"), nullptr);
  EXPECT_FALSE(result->model[ParameterId::kSurgeBeta].value);
  EXPECT_FALSE(result->model[ParameterId::kMassNorm].value);
}

TEST(CoastDown, AloneReportsAnInadequatePowerLaw) {
  const auto inadequate = [](const Model& model) {
    return std::any_of(model.record.findings.begin(), model.record.findings.end(),
                       [](const Finding& f) { return f.code == "power-law-inadequate"; });
  };
  const TrialData coulomb = curves_alone({.alpha = 0.8, .beta = 1.0, .coulomb = 0.4});
  EXPECT_TRUE(inadequate(identify(vehicle(), coulomb, {}, {})->model));
  const TrialData power = curves_alone({.alpha = 1.3, .beta = 0.7});
  const auto plain = identify(vehicle(), power, {}, {});
  EXPECT_FALSE(inadequate(plain->model));
  const auto* mass = found(plain->model, "power", "mass_norm/surge.alpha");
  EXPECT_NEAR(mass->value, 0.5 / 1.3, 4.0 * *mass->std_error);
  // The family `auto` selects the best family, whose report comes first.
  IdentifyOptions options;
  options.surge_family = {.family = std::nullopt, .requested = true};
  const auto chosen = identify(vehicle(), coulomb, options, {});
  EXPECT_TRUE(chosen->model.record.reports.front().family.starts_with("coulomb"));
}

TEST(CoastDown, CombinesBothKindsAndReportsAContradiction) {
  const Truth& t = kTruths[1];
  TrialData data = surge_only(t, 0.01, 2);
  Random random(2, 1);
  data.curves = {simulate_coastdown(plant(t), 1.5, 1.5, 100.0, 0.02, 0.0, random)};
  const double stop_s = *stop_time_s(plant(t).surge, t.mass_norm, 1.5);
  data.coastdown = TrialSet<StopTimeRow>{"stop.csv", {{2, 1.5, stop_s, 0.01}}, 0};
  const auto agree = identify(vehicle(), data, {}, {});
  ASSERT_TRUE(agree);
  EXPECT_EQ(agree->model[ParameterId::kMassNorm].method, "stop time and coast-down curve");
  EXPECT_TRUE(agree->model[ParameterId::kMassNorm].ci95->contains(t.mass_norm));
  const auto disagreement = [](const Model& model) {
    return std::any_of(model.record.findings.begin(), model.record.findings.end(),
                       [](const Finding& f) { return f.code == "estimates-disagree"; });
  };
  EXPECT_FALSE(disagreement(agree->model));
  data.coastdown->rows[0].stop_time_s *= 2.0;
  EXPECT_TRUE(disagreement(identify(vehicle(), data, {}, {})->model));
}

TEST(CoastDown, JointFitImprovesTheExponent) {
  const Truth& t = kTruths[0];
  TrialData data = surge_only(t, 0.03, 9);
  Random random(9, 1);
  for (int i = 0; i < 3; ++i) {
    data.curves.push_back(simulate_coastdown(plant(t), 1.6, 1.0, 100.0, 0.01, 0.0, random));
  }
  IdentifyOptions joint;
  joint.joint = true;
  const auto apart = identify(vehicle(), data, {}, {});
  const auto together = identify(vehicle(), data, joint, {});
  ASSERT_TRUE(apart && together);
  for (const ParameterId id : {ParameterId::kSurgeBeta, ParameterId::kMassNorm}) {
    EXPECT_LT(*together->model[id].std_error, *apart->model[id].std_error) << info(id).name;
    const Interval& ci = *together->model[id].ci95;
    const double truth = id == ParameterId::kSurgeBeta ? t.b1 : t.mass_norm;
    EXPECT_TRUE(ci.contains(truth)) << info(id).name << " [" << ci.lo << ", " << ci.hi << "]";
  }
}

TEST(CoastDown, CorrelatedNoiseWidensTheInterval) {
  const Truth& t = kTruths[0];
  TrialData data = surge_only(t, 0.0, 1);
  Random random(4, 1);
  data.curves = {simulate_coastdown(plant(t), 1.6, 2.0, 100.0, 0.02, 0.1, random)};
  const auto result = identify(vehicle(), data, {}, {});
  ASSERT_TRUE(result);
  EXPECT_TRUE(std::any_of(result->model.record.findings.begin(),
                          result->model.record.findings.end(),
                          [](const Finding& f) { return f.code == "coloured-residuals"; }));
}

/// Surge runs with errors of the force differ from the other error models at low speeds.
TEST(CoastDown, DoesNotAskForACurveThatWasGiven) {
  const Truth& t = kTruths[0];
  for (std::uint64_t seed = 1; seed < 30; ++seed) {
    TrialData data = surge_only(t, 0.2, seed);
    Random random(4, seed);
    data.curves = {simulate_coastdown(plant(t), 1.6, 2.0, 100.0, 0.002, 0.0, random)};
    const auto result = identify(vehicle(), data, {}, {});
    ASSERT_TRUE(result);
    for (const Finding& f : result->model.record.findings) {
      if (f.code != "noise-model") continue;
      EXPECT_THAT(f.message, ::testing::Not(::testing::HasSubstr("coast-down curve")));
      EXPECT_THAT(f.message, ::testing::HasSubstr("surge runs, which"));
      return;
    }
  }
  FAIL() << "no data with the finding noise-model";
}

/// Errors of a simulated speed sensor.
struct SpeedSensor {
  double lag_s = 0.0;       ///< time constant of a filter; 0: none
  double lead_s = 0.0;      ///< duration of the record before the motors go off
  double lowest_mps = 0.0;  ///< readings below this are 0
  int hold = 1;             ///< rows for which a reading is repeated
  double noise_mps = 0.01;
};

/// Curve recorded at 50 Hz for `duration_s` from motors-off. `speed(t)`: speed after the time t.
template <class Speed>
CoastCurve recorded(Speed speed, double duration_s, const SpeedSensor& sensor, std::uint64_t run) {
  constexpr double kRow_s = 0.02;
  constexpr int kSteps = 40;
  constexpr double kStep_s = kRow_s / kSteps;
  Random random(11, run);
  CoastCurve curve{"curve.csv", 2, {}, {}};
  double y = speed(0.0);
  for (int i = 0; i * kRow_s < sensor.lead_s + duration_s; ++i) {
    double reading = y + sensor.noise_mps * random.normal();
    if (reading < sensor.lowest_mps) reading = 0.0;
    if (i % sensor.hold != 0) reading = curve.speed_mps.back();
    curve.t_s.push_back(kRow_s * i);
    curve.speed_mps.push_back(reading);
    for (int n = 0; n < kSteps; ++n) {
      const double middle_s = kRow_s * i + kStep_s * (n + 0.5) - sensor.lead_s;
      const double u = speed(std::max(0.0, middle_s));
      y = sensor.lag_s > 0.0 ? u + (y - u) * std::exp(-kStep_s / sensor.lag_s)
                             : speed(std::max(0.0, middle_s + 0.5 * kStep_s));
    }
  }
  return curve;
}

/// Surge runs and three curves of the vehicle `t`.
TrialData with_sensor(const Truth& t, const SpeedSensor& sensor, std::uint64_t seed = 1) {
  TrialData data = surge_only(t, 0.01, seed);
  for (const double u0 : {1.6, 1.5, 1.4}) {
    data.curves.push_back(recorded([&](double s) { return closed_form(t, u0, s); }, 2.0, sensor,
                                   10 * seed + data.curves.size()));
  }
  return data;
}

bool reports(const Model& model, const std::string& code) {
  return std::ranges::any_of(model.record.findings,
                             [&](const Finding& f) { return f.code == code; });
}

/// Expects that m' is within `errors` standard errors of the truth.
void expect_mass(const Model& model, const Truth& t, double errors) {
  const Estimate& mass = model[ParameterId::kMassNorm];
  ASSERT_TRUE(mass.value && mass.std_error);
  EXPECT_NEAR(*mass.value, t.mass_norm, errors * *mass.std_error);
  EXPECT_LT(*mass.std_error, 0.05 * t.mass_norm);
}

TEST(CoastDown, FindsTheFilterOfTheSpeed) {
  const Truth& t = kTruths[1];  // m'/a1 = 0.56 s
  for (const SpeedSensor& sensor : {SpeedSensor{.lag_s = 0.05, .lead_s = 0.5}, SpeedSensor{0.2}}) {
    const TrialData data = with_sensor(t, sensor);
    IdentifyOptions options;
    options.joint = sensor.lead_s == 0.0;
    const auto result = identify(vehicle(), data, options, {});
    ASSERT_TRUE(result);
    EXPECT_TRUE(reports(result->model, "sensor-lag")) << sensor.lag_s;
    expect_mass(result->model, t, 3.0);
    const auto* lag = found(result->model, "", "lag.speed_mps");
    ASSERT_TRUE(lag);
    EXPECT_NEAR(lag->value, sensor.lag_s, 3.0 * *lag->std_error);
  }
}

TEST(CoastDown, FindsNoFilterInUnfilteredCurves) {
  const Truth& t = kTruths[1];
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const auto result = identify(
        vehicle(), with_sensor(t, {.lead_s = 0.1 * static_cast<double>(seed % 3)}, seed), {}, {});
    ASSERT_TRUE(result);
    EXPECT_FALSE(reports(result->model, "sensor-lag")) << seed;
    EXPECT_FALSE(reports(result->model, "model-inadequate")) << seed;
    expect_mass(result->model, t, 3.0);
  }
}

TEST(CoastDown, FindsMotorsOffAfterThreeRows) {
  const Truth& t = kTruths[1];
  const auto result = identify(vehicle(), with_sensor(t, {.lead_s = 0.07}), {}, {});
  ASSERT_TRUE(result);
  EXPECT_FALSE(reports(result->model, "sensor-lag"));
  expect_mass(result->model, t, 3.0);
}

TEST(CoastDown, WithdrawsTheIntervalIfFilterAndMotionCanBeExchanged) {
  // u = e^(-t/0.5), filtered with T = 0.2 s, is the same curve as u = e^(-t/0.2) with T = 0.5 s.
  const Truth t{1.0, 1.0, 0.2, 1.2, 0.5};
  TrialData data = surge_only(t, 0.01, 3);
  for (const std::size_t run : {0, 1, 2}) {
    data.curves.push_back(recorded([](double s) { return 1.5 * std::exp(-2.0 * s); }, 2.5,
                                   {.lag_s = 0.2, .lead_s = 0.5}, run));
  }
  const auto result = identify(vehicle(), data, {}, {});
  ASSERT_TRUE(result);
  EXPECT_TRUE(reports(result->model, "sensor-lag"));
  EXPECT_TRUE(result->model[ParameterId::kMassNorm].value);
  EXPECT_FALSE(result->model[ParameterId::kMassNorm].ci95);
  EXPECT_FALSE(result->model[ParameterId::kInertiaNorm].ci95);
}

TEST(CoastDown, UsesEachReadingOfASlowSensorOnce) {
  const Truth& t = kTruths[1];
  const auto result = identify(vehicle(), with_sensor(t, {.lead_s = 0.5, .hold = 6}), {}, {});
  ASSERT_TRUE(result);
  EXPECT_TRUE(reports(result->model, "held-samples"));
  EXPECT_FALSE(reports(result->model, "sensor-lag"));
  expect_mass(result->model, t, 3.0);
}

TEST(CoastDown, DoesNotTakeASpeedCutOffForAStop) {
  const Truth& t = kTruths[1];
  const auto result = identify(vehicle(), with_sensor(t, {.lowest_mps = 0.3}), {}, {});
  ASSERT_TRUE(result);
  EXPECT_TRUE(reports(result->model, "speed-cut-off"));
  expect_mass(result->model, t, 3.0);
  const auto whole = identify(vehicle(), with_sensor(t, {.lowest_mps = 0.02}), {}, {});
  ASSERT_TRUE(whole);
  EXPECT_FALSE(reports(whole->model, "speed-cut-off"));
}

/// Timed surge runs and two coast-down curves of a vehicle with m' = 0.42 and g1 = 0.1 + 0.75 u. The
/// times have errors of 0.1 s, so that the AICc of the power law and of Coulomb and linear friction
/// differ by less than 1.
TrialData undecided_runs_and_curves() {
  constexpr double kCoulomb = 0.1;
  constexpr double kLinear = 0.75;
  constexpr double kMassNorm = 0.42;
  constexpr double kDistance_m = 10.0;
  TrialData data;
  data.surge = TrialSet<SurgeRow>{"surge.csv", {}, 0};
  double force = 0.8;
  for (const double elapsed_s : {10.47, 6.95, 4.88, 3.85, 3.2, 2.77, 2.51, 1.97, 1.96}) {
    data.surge->rows.push_back({static_cast<int>(data.surge->rows.size()) + 2, force,
                                kDistance_m / elapsed_s, kDistance_m, elapsed_s});
    force += 0.4;
  }
  for (const double u0 : {5.2, 4.68}) {
    const auto speed = [u0](double s) {
      const double rest = kCoulomb / kLinear;
      return std::max(0.0, (u0 + rest) * std::exp(-kLinear / kMassNorm * s) - rest);
    };
    data.curves.push_back(recorded(speed, 1.8, {}, data.curves.size()));
  }
  return data;
}

/// The same vehicle with 12 surge runs, without errors except for the rounding of the times to 0.1
/// ms, so that the runs alone reject the power law.
TrialData deciding_runs_and_curves() {
  TrialData data = undecided_runs_and_curves();
  data.surge->rows.clear();
  for (int i = 0; i < 12; ++i) {
    const double force = 0.3 + 0.3 * i;
    const double elapsed_s = 1e-4 * std::round(1e4 * 10.0 / ((force - 0.1) / 0.75));
    data.surge->rows.push_back({i + 2, force, 10.0 / elapsed_s, 10.0, elapsed_s});
  }
  return data;
}

TEST(CoastDown, OneFindingNamesTheFamilyIfTheSurgeRunsRejectThePowerLaw) {
  const auto result = identify(vehicle(), deciding_runs_and_curves(), {}, {});
  ASSERT_TRUE(result);
  EXPECT_TRUE(reports(result->model, "power-law-inadequate"));
  EXPECT_FALSE(reports(result->model, "family-by-coastdown"));
  EXPECT_FALSE(result->model[ParameterId::kSurgeAlpha].ci95);
  IdentifyOptions options;
  options.surge_family = {.family = Family::kCoulombLinear, .requested = true};
  const auto followed = identify(vehicle(), deciding_runs_and_curves(), options, {});
  ASSERT_TRUE(followed);
  EXPECT_FALSE(reports(followed->model, "power-law-inadequate"));
  EXPECT_FALSE(reports(followed->model, "family-by-coastdown"));
  EXPECT_TRUE(followed->model[ParameterId::kSurgeAlpha].ci95);
}

TEST(CoastDown, DecidesBetweenFamiliesThatTheSurgeRunsLeaveOpen) {
  IdentifyOptions options;
  options.surge_family = {.family = std::nullopt, .requested = true};
  const auto result = identify(vehicle(), undecided_runs_and_curves(), options, {});
  ASSERT_TRUE(result);
  EXPECT_EQ(result->model.surge_family, Family::kCoulombLinear);
  EXPECT_TRUE(reports(result->model, "family-by-coastdown"));
  EXPECT_FALSE(reports(result->model, "model-inadequate"));
  const Estimate& mass = result->model[ParameterId::kMassNorm];
  ASSERT_TRUE(mass.value && mass.ci95);
  EXPECT_LT(mass.ci95->lo, 0.42);
  EXPECT_GT(mass.ci95->hi, 0.42);
}

TEST(CoastDown, WithdrawsTheIntervalsOfAPowerLawThatTheCurvesReject) {
  const auto result = identify(vehicle(), undecided_runs_and_curves(), {}, {});
  ASSERT_TRUE(result);
  EXPECT_EQ(result->model.surge_family, Family::kPower);
  EXPECT_TRUE(reports(result->model, "family-by-coastdown"));
  EXPECT_FALSE(result->model[ParameterId::kMassNorm].ci95);
  EXPECT_FALSE(result->model[ParameterId::kSurgeAlpha].ci95);
}

TEST(CoastDown, WithdrawsTheIntervalOfCurvesThatTheLawDoesNotDescribe) {
  // The speed falls along a straight line, as with a brake.
  TrialData data = surge_only(kTruths[1], 0.01, 4);
  for (const std::size_t run : {0, 1, 2}) {
    data.curves.push_back(
        recorded([](double s) { return 1.5 - 0.75 * s; }, 1.9, {.lead_s = 0.5}, run));
  }
  const auto result = identify(vehicle(), data, {}, {});
  ASSERT_TRUE(result);
  EXPECT_TRUE(reports(result->model, "model-inadequate"));
  EXPECT_TRUE(result->model[ParameterId::kMassNorm].value);
  EXPECT_FALSE(result->model[ParameterId::kMassNorm].ci95);
}

}  // namespace
}  // namespace awmr::testing
