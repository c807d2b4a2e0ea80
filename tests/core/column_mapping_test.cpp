#include <gmock/gmock.h>

#include "awmr/core/csv.h"
#include "core/faults.h"

namespace awmr::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

void expect_mapping(std::string_view text, const ColumnMapping& expected) {
  const auto mapping = parse_column(text);
  ASSERT_TRUE(mapping) << to_text(mapping.error());
  EXPECT_EQ(mapping->name, expected.name) << text;
  EXPECT_EQ(mapping->source, expected.source) << text;
  EXPECT_EQ(mapping->scale, expected.scale) << text;
  EXPECT_EQ(mapping->offset, expected.offset) << text;
}

TEST(ColumnMapping, TakesAnotherName) {
  expect_mapping("speed_mps=V", {"speed_mps", "V", 1.0, 0.0});
}

TEST(ColumnMapping, TakesAQuotedSourceWithScaleAndOffset) {
  expect_mapping("yaw_rate_radps=\"W (IMU)\"*0.01745+0",
                 {"yaw_rate_radps", "W (IMU)", 0.01745, 0.0});
  expect_mapping("x=\"a \"\"b\"\" *+= c\" * 2e-3 + -7", {"x", "a \"b\" *+= c", 2e-3, -7.0});
}

TEST(ColumnMapping, TakesTheSameWithoutQuotesAsAShellLeavesIt) {
  expect_mapping("yaw_rate_radps=W (IMU)*0.01745+0", {"yaw_rate_radps", "W (IMU)", 0.01745, 0.0});
}

TEST(ColumnMapping, TakesAnOffsetWithoutAScale) {
  expect_mapping("t_s=t+1.5", {"t_s", "t", 1.0, 1.5});
  expect_mapping("t_s=t+-1.5", {"t_s", "t", 1.0, -1.5});
}

TEST(ColumnMapping, TakesANegativeOffsetWhereItIsClear) {
  expect_mapping("x=a*2-3", {"x", "a", 2.0, -3.0});
  expect_mapping("x=\"a\"-3", {"x", "a", 1.0, -3.0});
  expect_mapping("x=a-3", {"x", "a-3", 1.0, 0.0});
}

TEST(ColumnMapping, TakesSignsAndExponents) {
  expect_mapping("x=a*-1", {"x", "a", -1.0, 0.0});
  expect_mapping("x=a*1e+2+1e+1", {"x", "a", 100.0, 10.0});
}

TEST(ColumnMapping, ReadsBackWhatAnOutputNamesAsItsOption) {
  expect_mapping("x=a*" + format_number(-0.5) + "+" + format_number(-2e-7),
                 {"x", "a", -0.5, -2e-7});
}

TEST(ColumnMapping, RefusesInvalidMappings) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"speed_mps", "no '='"},    {"=V", "NAME is empty"},  {"run.csv:=V", "NAME is empty"},
      {":x=V", "FILE is empty"},  {"x=", "EXPRESSION is"},  {"x=a*0", "scale of 0"},
      {"x=a*0x10", "scale of 0"}, {"x=a*0+b", "scale of 0"}};
  for (const auto& [text, words] : cases) {
    const auto mapping = parse_column(text);
    ASSERT_FALSE(mapping) << text;
    EXPECT_EQ(exit_code(mapping.error()), 2);
    EXPECT_THAT(faults_of(mapping), ElementsAre(HasSubstr(words))) << text;
    EXPECT_THAT(faults_of(mapping), ElementsAre(HasSubstr("expected NAME=EXPRESSION")));
  }
}

}  // namespace
}  // namespace awmr::testing
