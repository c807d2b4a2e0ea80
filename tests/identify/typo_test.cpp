/// Tables with one mistake, fitted by every method and family: each fit ends with a value or a
/// refusal with a message, and all results are finite.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "identify/synthetic.h"

namespace awmr::testing {
namespace {

/// The tables of datasets/paper: surge tau_speed and speed, turning tau_turn and yaw rate.
TrialData paper_tables() {
  TrialData data;
  data.surge = TrialSet<SurgeRow>{"surge.csv", {}, 0};
  data.turning = TrialSet<TurningRow>{"turning.csv", {}, 0};
  data.coastdown = TrialSet<StopTimeRow>{"coastdown.csv", {}, 0};
  const double surge[][4] = {{0.2, 0.12, 10.0, 79.16}, {0.4, 0.28, 10.0, 35.3},
                             {0.6, 0.39, 10.0, 25.5},  {0.8, 0.55, 10.0, 18.0},
                             {1.0, 0.72, 10.0, 13.9},  {1.2, 0.88, 10.0, 11.3},
                             {1.4, 1.03, 10.0, 9.26},  {1.6, 1.26, 10.0, 7.9},
                             {1.8, 1.49, 10.0, 6.7},   {2.0, 1.66, 10.0, 6.0}};
  int line = 2;
  for (const auto& row : surge) {
    data.surge->rows.push_back({line++, row[0], row[1], row[2], row[3]});
  }
  const double turning[][4] = {{0.02, 0.038, 1.0, 83.34},
                               {0.042, 0.088, 1.0, 71.0},
                               {0.064, 0.15, 1.0, 41.54},
                               {0.086, 0.22, 1.0, 29.37},
                               {0.1, 0.265, 1.0, 23.9}};
  for (const auto& row : turning) {
    data.turning->rows.push_back({line++, 0.3, 0.35, row[0], row[1], row[2], row[3]});
  }
  data.coastdown->rows.push_back({line, 1.66, 0.573, 0.0005});
  return data;
}

/// A complete coast-down of the same vehicle, 2 s at 50 Hz.
CoastCurve coast_curve() {
  CoastCurve curve;
  curve.file = "curve.csv";
  curve.line = 2;
  for (int i = 0; i < 100; ++i) {
    const double t_s = 0.02 * i;
    curve.t_s.push_back(t_s);
    curve.speed_mps.push_back(std::pow(std::max(0.0, 1.0 - 0.9 * t_s), 8.0) + 1e-3 * (i % 3));
  }
  return curve;
}

std::vector<IdentifyOptions> ways() {
  std::vector<IdentifyOptions> all(1);
  for (const ErrorModel noise : {ErrorModel::kForce, ErrorModel::kSpeed, ErrorModel::kTime}) {
    IdentifyOptions options;
    options.method = Method::kNonlinear;
    options.noise = noise;
    all.push_back(options);
  }
  for (const Family family : values_in(kFamilyNames)) {
    IdentifyOptions options;
    options.surge_family.family = family;
    options.yaw_family.family = family;
    all.push_back(options);
  }
  IdentifyOptions any;
  any.surge_family.family.reset();
  any.yaw_family.family.reset();
  all.push_back(any);
  for (const Loss loss : {Loss::kHuber, Loss::kCauchy, Loss::kTukey}) {
    IdentifyOptions options;
    options.method = Method::kNonlinear;
    options.loss = loss;
    all.push_back(options);
  }
  return all;
}

bool finite(const Estimate& e) {
  return (!e.value || std::isfinite(*e.value)) && (!e.std_error || std::isfinite(*e.std_error)) &&
         (!e.ci95 || (std::isfinite(e.ci95->lo) && std::isfinite(e.ci95->hi)));
}

/// Expects an error message, or a model whose numbers are finite and whose refused parameters have
/// a finding.
void expect_value_or_refusal(const TrialData& data, const IdentifyOptions& options) {
  const auto result = identify(vehicle(), data, options, {});
  if (!result) {
    EXPECT_FALSE(to_text(result.error()).empty());
    return;
  }
  const Model& model = result->model;
  for (const ParameterInfo& parameter : parameter_table()) {
    EXPECT_TRUE(finite(model[parameter.id])) << parameter.name;
  }
  for (const auto& row : model.covariance.matrix) {
    for (const double x : row) EXPECT_TRUE(std::isfinite(x));
  }
  for (const EstimatorReport& report : model.record.reports) {
    for (const LeaveOneOut& without : report.leave_one_out) {
      for (const double x : without.values) EXPECT_TRUE(std::isfinite(x));
    }
  }
  if (result->refused.empty()) return;
  const bool reported = std::ranges::any_of(model.record.findings, [](const Finding& f) {
    return f.code == "not-identifiable" && f.severity == Severity::kError;
  });
  EXPECT_TRUE(reported);
}

/// References to all numbers of the tables.
std::vector<std::function<double&(TrialData&)>> cells(const TrialData& data) {
  std::vector<std::function<double&(TrialData&)>> all;
  for (std::size_t i = 0; i < data.surge->rows.size(); ++i) {
    all.emplace_back([i](TrialData& d) -> double& { return d.surge->rows[i].tau_speed; });
    all.emplace_back([i](TrialData& d) -> double& { return d.surge->rows[i].speed_mps; });
    all.emplace_back([i](TrialData& d) -> double& { return *d.surge->rows[i].elapsed_s; });
  }
  for (std::size_t i = 0; i < data.turning->rows.size(); ++i) {
    all.emplace_back([i](TrialData& d) -> double& { return d.turning->rows[i].tau_turn_m; });
    all.emplace_back([i](TrialData& d) -> double& { return d.turning->rows[i].yaw_rate_radps; });
    all.emplace_back([i](TrialData& d) -> double& { return *d.turning->rows[i].elapsed_s; });
  }
  all.emplace_back([](TrialData& d) -> double& { return d.coastdown->rows[0].stop_time_s; });
  all.emplace_back([](TrialData& d) -> double& { return d.coastdown->rows[0].initial_speed_mps; });
  return all;
}

double mutated(double value, int how) {
  switch (how) {
    case 0:
      return 10.0 * value;
    case 1:
      return 0.1 * value;
    case 2:
      return 1e308;
    case 3:
      return 5e-324;
    default:
      return -value;
  }
}
constexpr int kMutations = 5;

TEST(Typo, ACellTenTimesTooLargeGivesAValueOrARefusal) {
  for (const IdentifyOptions& options : ways()) {
    TrialData data = paper_tables();
    data.turning->rows.front().tau_turn_m = 0.2;
    expect_value_or_refusal(data, options);
  }
}

TEST(Typo, RefusesATableThatFallsWithTheForce) {
  TrialData data = paper_tables();
  std::vector<SurgeRow>& rows = data.surge->rows;
  for (std::size_t i = 0; i < rows.size() / 2; ++i) {
    std::swap(rows[i].speed_mps, rows[rows.size() - 1 - i].speed_mps);
  }
  for (const IdentifyOptions& options : ways()) expect_value_or_refusal(data, options);
  const auto result = identify(vehicle(), data, {}, {});
  ASSERT_TRUE(result);
  EXPECT_FALSE(result->model[ParameterId::kSurgeBeta].value);
  EXPECT_FALSE(result->refused.empty());
}

class TypoInACell : public ::testing::TestWithParam<int> {};

/// Changes one cell at a time (a mutation) and fits the tables. Each mutation is fitted by only one
/// of the methods, in turn, because all combinations would take an hour. One mutation in eight is
/// also fitted with the alternative families and leave-one-out. Test parameter n: only every n-th
/// mutation is used.
TEST_P(TypoInACell, EndsWithAValueOrARefusalByEveryMethodAndFamily) {
  const TrialData paper = paper_tables();
  const auto all = cells(paper);
  const std::vector<IdentifyOptions> every = ways();
  std::size_t turn = 0;
  int tried = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (int how = 0; how < kMutations; ++how) {
      if (tried++ % GetParam() != 0) continue;
      SCOPED_TRACE(::testing::Message() << "cell " << i << ", mutation " << how);
      TrialData data = paper;
      double& cell = all[i](data);
      cell = mutated(cell, how);
      IdentifyOptions options = every[turn % every.size()];
      options.side_by_side = turn++ % 8 == 0;
      expect_value_or_refusal(data, options);
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Short, TypoInACell, ::testing::Values(4));
/// Fits every mutation of every cell.
INSTANTIATE_TEST_SUITE_P(Long, TypoInACell, ::testing::Values(1));

TEST(Typo, AcceptsColumnsScaledToTheLimitsOfDouble) {
  const std::vector<IdentifyOptions> every = ways();
  std::size_t turn = 0;
  for (const double scale : {1e308, 1e-308, 5e-324, 1e150, 1e-150}) {
    TrialData surge = paper_tables();
    for (SurgeRow& row : surge.surge->rows) row.speed_mps *= scale;
    TrialData turning = paper_tables();
    for (TurningRow& row : turning.turning->rows) row.tau_turn_m *= scale;
    for (int i = 0; i < 3; ++i) {
      expect_value_or_refusal(surge, every[turn++ % every.size()]);
      expect_value_or_refusal(turning, every[turn++ % every.size()]);
    }
  }
}

class TypoInACurve : public ::testing::TestWithParam<int> {};

/// Changes one sample of a coast-down curve. Test parameter n: only every n-th fit is run.
TEST_P(TypoInACurve, EndsWithAValueOrARefusal) {
  int tried = 0;
  for (const bool joint : {false, true}) {
    for (const bool with_surge : {true, false}) {
      if (joint && !with_surge) continue;
      for (const std::size_t at : {0UL, 50UL}) {
        for (int how = 0; how < kMutations; ++how) {
          for (const Family family : {Family::kPower, Family::kCoulombPower}) {
            if (tried++ % GetParam() != 0) continue;
            TrialData data = paper_tables();
            if (!with_surge) data.surge.reset();
            data.curves.push_back(coast_curve());
            double& cell = data.curves[0].speed_mps[at];
            cell = mutated(cell, how);
            IdentifyOptions options;
            options.joint = joint;
            options.surge_family.family = family;
            expect_value_or_refusal(data, options);
          }
        }
      }
    }
  }
}
/// With n = 3, each mutation, sample, family and kind of fit occurs.
INSTANTIATE_TEST_SUITE_P(Short, TypoInACurve, ::testing::Values(3));
INSTANTIATE_TEST_SUITE_P(Long, TypoInACurve, ::testing::Values(1));

}  // namespace
}  // namespace awmr::testing
