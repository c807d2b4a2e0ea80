#include <gtest/gtest.h>

#include <set>
#include <string>

#include "awmr/model/parameters.h"

namespace awmr::testing {
namespace {

TEST(Parameters, AreInTheOrderOfTheirIds) {
  for (std::size_t i = 0; i < kParameterCount; ++i) {
    EXPECT_EQ(static_cast<std::size_t>(parameter_table()[i].id), i);
    EXPECT_EQ(&info(parameter_table()[i].id), &parameter_table()[i]);
  }
}

TEST(Parameters, HaveThePlacesOfTheContract) {
  std::vector<std::string> pointers;
  for (const ParameterInfo& parameter : parameter_table()) pointers.emplace_back(parameter.pointer);
  EXPECT_EQ(pointers, (std::vector<std::string>{
                          "/surge/alpha", "/surge/beta", "/yaw/alpha", "/yaw/beta", "/sway/alpha",
                          "/mass_norm", "/inertia_norm", "/steering/time_constant_s",
                          "/surge/coulomb", "/surge/quadratic", "/yaw/coulomb", "/yaw/quadratic",
                          "/wheel/dead_zone", "/motor/back_emf_s_per_m"}));
}

TEST(Parameters, AreNamedAsTheirPlaceWithDots) {
  for (const ParameterInfo& parameter : parameter_table()) {
    std::string expected(parameter.pointer.substr(1));
    for (char& c : expected) c = c == '/' ? '.' : c;
    EXPECT_EQ(parameter.name, expected);
    EXPECT_EQ(parameter_by_name(parameter.name), parameter.id);
    EXPECT_FALSE(parameter.symbol.empty() || parameter.unit.empty() || parameter.meaning.empty() ||
                 parameter.trial.empty())
        << parameter.name;
  }
}

TEST(Parameters, AreNotFoundByOtherNames) {
  for (const char* name :
       {"", "surge", "surge.alph", "surge.alpha ", "SURGE.ALPHA", "/surge/alpha"}) {
    EXPECT_FALSE(parameter_by_name(name)) << name;
  }
}

}  // namespace
}  // namespace awmr::testing
