/// Random values: a written value reads back as the float nearest to the double.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <limits>

#include "emit/paper_robot.h"

namespace awmr::testing {
namespace {

/// Any positive normal float, uniform over the exponents.
double any_positive_float() {
  const auto bits = *rc::gen::inRange<std::uint32_t>(0x00800000U, 0x7F800000U);
  float value = 0.0F;
  std::memcpy(&value, &bits, sizeof value);
  return static_cast<double>(value);
}

/// Generates a double between two neighbouring floats.
double any_positive_double() {
  const double value = any_positive_float();
  const double share = *rc::gen::inRange(0, 1000) / 1000.0;
  return std::min(value * (1.0 + share * 0x1p-23),
                  static_cast<double>(std::numeric_limits<float>::max()));
}

TEST(ParamsValues, ReadBackAsTheNearestFloat) {
  EXPECT_TRUE(rc::check([] {
    Model model = paper_robot();
    for (const ParameterId id : {ParameterId::kSurgeAlpha, ParameterId::kSurgeBeta,
                                 ParameterId::kYawAlpha, ParameterId::kMassNorm}) {
      model[id].value = any_positive_double();
    }
    const std::string header = params_header(model, kPaperGains, paper_inputs()).value();
    for (const auto& [name, value] : expected_macros(model, kPaperGains)) {
      std::string text = macro_text(header, name);
      if (text.starts_with("(")) text = text.substr(1, text.size() - 2);
      char* end = nullptr;
      const float read = std::strtof(text.c_str(), &end);
      RC_ASSERT(read == static_cast<float>(value));
      RC_ASSERT(std::string(end) == "f");
      // A floating literal of C has a point or an exponent.
      RC_ASSERT(text.find_first_of(".e") != std::string::npos);
    }
  }));
}

TEST(ParamsValues, AreAcceptedExactlyWhereT2IsBelowT1) {
  EXPECT_TRUE(rc::check([] {
    const auto factor = [] { return 1e-3 * *rc::gen::inRange(1, 100000); };
    Gains<double> gains = kPaperGains;
    gains.heading = {.lambda = factor(), .mu = factor(), .epsilon = factor()};
    const double t1_s = 1.0 / gains.heading.lambda;
    const double t2_s = gains.heading.epsilon / (2.0 * gains.heading.mu);
    // The check in float32 has five roundings: three inputs and two products. Within 5 * 2^-24 of
    // the limit, its result may differ from that in double.
    if (std::abs(t2_s / t1_s - 1.0) < 5.0 * 0x1p-24) return;
    const auto header = params_header(paper_robot(), gains, paper_inputs());
    RC_ASSERT(header.has_value() == (t2_s < t1_s));
  }));
}

}  // namespace
}  // namespace awmr::testing
