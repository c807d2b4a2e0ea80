#include "awmr/core/nearest.h"

#include <gtest/gtest.h>

#include <vector>

namespace awmr::testing {
namespace {

const std::vector<std::string> kNames = {"tau_speed", "speed_mps", "t_s", "mass_kg"};

TEST(Nearest, FindsOneLetterWrongMissingOrTooMany) {
  EXPECT_EQ(nearest("mass_kq", kNames), "mass_kg");
  EXPECT_EQ(nearest("tau_sped", kNames), "tau_speed");
  EXPECT_EQ(nearest("speedd_mps", kNames), "speed_mps");
  EXPECT_EQ(nearest("ts", kNames), "t_s");
}

TEST(Nearest, FindsTheWordItself) { EXPECT_EQ(nearest("t_s", kNames), "t_s"); }

TEST(Nearest, IsEmptyWhereNothingIsNear) {
  EXPECT_EQ(nearest("colour", kNames), "");
  EXPECT_EQ(nearest("", kNames), "");
  EXPECT_EQ(nearest("x", {}), "");
}

TEST(Nearest, AThirdOfTheWordMayDiffer) {
  const std::vector<std::string> one = {"abcdef"};
  EXPECT_EQ(nearest("abcdxx", one), "abcdef");
  EXPECT_EQ(nearest("abcxxx", one), "");
}

TEST(Nearest, TakesTheFirstOfEquallyNearOnes) {
  EXPECT_EQ(nearest("axc", std::vector<std::string>{"abc", "adc"}), "abc");
}

}  // namespace
}  // namespace awmr::testing
