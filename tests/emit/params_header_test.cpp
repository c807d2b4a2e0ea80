/// Text of awmr_params.h: its content, and refused inputs. compiled_header_test.cpp compiles it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <set>
#include <sstream>

#include "awmr/core/files/hash.h"
#include "emit/paper_robot.h"
#include "support/process.h"

namespace awmr::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::string paper_header() {
  return params_header(paper_robot(), kPaperGains, paper_inputs()).value();
}

std::vector<std::string> defined_names(const std::string& header) {
  std::vector<std::string> names;
  std::istringstream lines(header);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string directive;
    std::string name;
    if (words >> directive >> name && directive == "#define") names.push_back(name);
  }
  return names;
}

TEST(ParamsHeader, IsTheSameBytesWhenMadeAgain) { EXPECT_EQ(paper_header(), paper_header()); }

TEST(ParamsHeader, DefinesEveryMacroOnceAndNothingElse) {
  std::multiset<std::string> expected{"AWMR_PARAMS_H", "AWMR_PARAMS_SHA256"};
  for (const auto& [name, value] : expected_macros(paper_robot(), kPaperGains)) {
    expected.insert(name);
  }
  const std::string header = paper_header();
  std::multiset<std::string> found;
  for (const std::string& name : defined_names(header)) {
    if (!name.starts_with("AWMR_PARAMS_CHECK(")) found.insert(name);  // undefined again at the end
  }
  EXPECT_EQ(found, expected);
  EXPECT_THAT(header, HasSubstr("#undef AWMR_PARAMS_CHECK\n"));
}

TEST(ParamsHeader, WritesWholeNumbersAsFloatsAndNegativeOnesInParentheses) {
  const std::string header = paper_header();
  EXPECT_EQ(macro_text(header, "AWMR_HEADING_LAMBDA"), "3.0f");
  EXPECT_EQ(macro_text(header, "AWMR_WHEEL_FORCE_MIN"), "(-1.0f)");
  EXPECT_EQ(macro_text(header, "AWMR_SURGE_ALPHA"), "1.32679999f");  // printf("%.9g", 1.3268f)
}

/// The paper's gains, with others in steering mode.
ModeGains with_own_steering(double epsilon) {
  ModeGains gains(kPaperGains);
  gains.set(YawMode::kSteering, {{1.5, 20.0, epsilon}, {2.0, 1.0}});
  return gains;
}

TEST(ParamsHeader, HasTheGainsOfEachMode) {
  const std::string header =
      params_header(paper_robot(), with_own_steering(8.0), paper_inputs()).value();
  EXPECT_EQ(macro_text(header, "AWMR_HEADING_LAMBDA"), "3.0f");
  EXPECT_EQ(macro_text(header, "AWMR_HEADING_LAMBDA_DIFFERENTIAL"), "3.0f");
  EXPECT_EQ(macro_text(header, "AWMR_HEADING_LAMBDA_STEERING"), "1.5f");
  EXPECT_EQ(macro_text(header, "AWMR_SPEED_MU_STEERING"), "2.0f");
  EXPECT_EQ(macro_text(header, "AWMR_HEADING_LAMBDA_COMBINED"), "3.0f");
  EXPECT_THAT(header, HasSubstr("AWMR_PARAMS_CHECK(AWMR_T2_IS_BELOW_T1_STEERING,"));
  // T2 = epsilon/(2 mu) = 0.75 s, T1 = 1/lambda = 0.67 s
  const auto slow = params_header(paper_robot(), with_own_steering(30.0), paper_inputs());
  ASSERT_FALSE(slow);
  EXPECT_EQ(slow.error().faults.front().code, ErrorCode::kSlowReaching);
}

TEST(ParamsHeader, HasNoNegativeZero) {
  Model model = paper_robot();
  model[ParameterId::kYawBeta].value = -0.0;
  const std::string header = params_header(model, kPaperGains, paper_inputs()).value();
  EXPECT_EQ(macro_text(header, "AWMR_YAW_BETA"), "0.0f");
}

TEST(ParamsHeader, NamesUnitAndOriginAboveEachMacro) {
  const std::string header = paper_header();
  for (const auto& [name, value] : expected_macros(paper_robot(), kPaperGains)) {
    const std::size_t define = header.find("\n#define " + name + " ");
    ASSERT_NE(define, std::string::npos) << name;
    const std::size_t start = header.rfind('\n', define - 1) + 1;
    const std::string comment = header.substr(start, define - start);
    EXPECT_TRUE(comment.starts_with("/* ") && comment.ends_with(" */")) << name << ": " << comment;
    EXPECT_THAT(comment, ::testing::ContainsRegex("^/\\* [^ ]+, [^:]+: .+; .+ \\*/$")) << name;
  }
  EXPECT_THAT(header,
              HasSubstr("fitted, log-linear, std error 0.018 */\n#define AWMR_SURGE_ALPHA"));
  EXPECT_THAT(header, HasSubstr("given, vehicle.json, no std error */\n#define AWMR_SWAY_ALPHA"));
}

TEST(ParamsHeader, NamesItsInputsAndHashesThem) {
  const std::string header = paper_header();
  EXPECT_THAT(header, HasSubstr("model: model.json, SHA-256 " + std::string(64, 'a')));
  EXPECT_THAT(header, HasSubstr("gains: gains.json, SHA-256 " + std::string(64, 'b')));
  // The expected value is from another implementation, sha256sum of coreutils.
  const ProcessResult peer = run_process("printf '%064d%064d' 0 0 | tr 0 a | sha256sum");
  EmitInputs inputs = paper_inputs();
  inputs.gains_sha256 = inputs.model_sha256;
  EXPECT_EQ(params_sha256(inputs), peer.out.substr(0, 64));
  EXPECT_EQ(macro_text(header, "AWMR_PARAMS_SHA256"), '"' + params_sha256(paper_inputs()) + '"');
}

TEST(ParamsHeader, ChangesItsHashWhenModelAndGainsChangePlaces) {
  EmitInputs swapped = paper_inputs();
  std::swap(swapped.model_sha256, swapped.gains_sha256);
  EXPECT_NE(params_sha256(paper_inputs()), params_sha256(swapped));
}

TEST(ParamsHeader, KeepsNamesFromFilesInsideTheirComments) {
  Model model = paper_robot();
  model.vehicle.name = "a */ int x; /* b **/*/ \xC3\xA9\xE2\x80\xAE\n#error \\\n\?\?/ \x01 end";
  model[ParameterId::kMassNorm].method = "*/\n#define AWMR_MASS_NORM 1\n/*";
  EmitInputs inputs = paper_inputs();
  model.file = "* m \n.json";  // a file's name has no '/'
  inputs.gains_file = "*/ g \n.json";
  const std::string header = params_header(model, kPaperGains, inputs).value();
  EXPECT_TRUE(std::all_of(header.begin(), header.end(),
                          [](char c) { return c == '\n' || (c >= ' ' && c <= '~'); }));
  EXPECT_THAT(header, Not(HasSubstr("\n#error")));
  EXPECT_EQ(defined_names(header), defined_names(paper_header()));
  // Comments end where they should: openings and closings alternate and match.
  int depth = 0;
  for (std::size_t i = 0; i + 1 < header.size(); ++i) {
    if (header.compare(i, 2, "/*") == 0) {
      EXPECT_EQ(depth++, 0) << header.substr(i, 40);
    }
    if (header.compare(i, 2, "*/") == 0) {
      EXPECT_EQ(depth--, 1) << header.substr(i, 40);
    }
  }
}

TEST(ParamsHeader, NeedsEveryParameterAndNamesTheTrialThatIdentifiesIt) {
  Model model = paper_robot();
  model[ParameterId::kMassNorm].value.reset();
  model[ParameterId::kYawAlpha].value.reset();
  const auto header = params_header(model, kPaperGains, paper_inputs());
  ASSERT_FALSE(header);
  EXPECT_EQ(exit_code(header.error()), 2);
  const std::string message = to_text(header.error());
  EXPECT_THAT(message, HasSubstr("model.json:/mass_norm"));
  EXPECT_THAT(message, HasSubstr("coast-down"));
  EXPECT_THAT(message, HasSubstr("model.json:/yaw/alpha"));
}

struct BadValue {
  double value;
  std::string complaint;
};

void PrintTo(const BadValue& bad, std::ostream* out) { *out << bad.value; }

class BadValues : public ::testing::TestWithParam<BadValue> {};

TEST_P(BadValues, AreInputErrorsWithTheirPlace) {
  Model model = paper_robot();
  Gains<double> gains = kPaperGains;
  model[ParameterId::kInertiaNorm].value = GetParam().value;
  gains.speed.epsilon = GetParam().value;
  const auto header = params_header(model, gains, paper_inputs());
  ASSERT_FALSE(header);
  EXPECT_EQ(header.error().kind, ErrorKind::kInput);
  ASSERT_EQ(header.error().faults.size(), 2U) << "all faults at once";
  EXPECT_EQ(header.error().faults[0].place, "model.json:/inertia_norm/value");
  EXPECT_EQ(header.error().faults[1].place, "gains.json:/speed/epsilon");
  EXPECT_THAT(header.error().faults[0].message, HasSubstr(GetParam().complaint));
}

INSTANTIATE_TEST_SUITE_P(
    ParamsHeader, BadValues,
    ::testing::Values(BadValue{0.0, "above 0"}, BadValue{-1.0, "above 0"},
                      BadValue{1e39, "does not fit"}, BadValue{-1e39, "does not fit"},
                      BadValue{3.4028236e38, "does not fit"}, BadValue{1e-39, "does not fit"},
                      BadValue{1e-300, "does not fit"}, BadValue{std::nan(""), "does not fit"},
                      BadValue{HUGE_VAL, "does not fit"}));

TEST(ParamsHeader, RefusesAnExponentBelowZeroButTakesZero) {
  Model model = paper_robot();
  model[ParameterId::kSurgeBeta].value = 0.0;
  EXPECT_TRUE(params_header(model, kPaperGains, paper_inputs()));
  model[ParameterId::kSurgeBeta].value = -0.1;
  const auto header = params_header(model, kPaperGains, paper_inputs());
  ASSERT_FALSE(header);
  EXPECT_THAT(to_text(header.error()), HasSubstr("model.json:/surge/beta/value"));
}

TEST(ParamsHeader, RefusesWhenT2IsNotBelowT1) {
  // T1 = 1/lambda equals T2 = epsilon/(2 mu) at epsilon = 2 mu/lambda = 50, which is exact in
  // float32.
  Gains<double> gains = kPaperGains;
  gains.heading = {.lambda = 2.0, .mu = 50.0, .epsilon = 50.0};
  const auto at_the_limit = params_header(paper_robot(), gains, paper_inputs());
  ASSERT_FALSE(at_the_limit);
  EXPECT_EQ(exit_code(at_the_limit.error()), 1);
  EXPECT_THAT(to_text(at_the_limit.error()), HasSubstr("T2"));

  // This epsilon is below the limit in double, but equal to it in float32, in which the check of
  // the compiler computes.
  gains.heading.epsilon = std::nextafter(50.0, 0.0);
  EXPECT_FALSE(params_header(paper_robot(), gains, paper_inputs()));
  gains.heading.epsilon = static_cast<double>(std::nextafter(50.0F, 0.0F));
  EXPECT_TRUE(params_header(paper_robot(), gains, paper_inputs()));
}

TEST(ParamsHeader, RefusesLimitsThatAreEqualInFloat) {
  Model model = paper_robot();
  model.vehicle.wheel_force = {std::nextafter(0.5, 0.0), 0.5};
  const auto header = params_header(model, kPaperGains, paper_inputs());
  ASSERT_FALSE(header);
  EXPECT_THAT(to_text(header.error()), HasSubstr("model.json:/vehicle/wheel_force"));
}

TEST(ParamsHeader, RefusesASteeringStopAtARightAngle) {
  Model model = paper_robot();
  model.vehicle.steering_max_deg = 90.0;
  EXPECT_FALSE(params_header(model, kPaperGains, paper_inputs()));
}

}  // namespace
}  // namespace awmr::testing
