/// Column formulas: accepted, rejected, and the choice between three readings of a text by the
/// header.
#include "awmr/core/csv/column_expression.h"

#include <gmock/gmock.h>

#include <cmath>

#include "core/csv_text.h"
#include "core/faults.h"

namespace awmr::testing {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;
using ::testing::StartsWith;

double value_of(std::string_view text, const std::vector<double>& values = {}) {
  auto expression = ColumnExpression::parse(text);
  if (!expression) {
    ADD_FAILURE() << text << ": " << expression.error();
    return std::nan("");
  }
  EXPECT_EQ(expression->names().size(), values.size()) << text;
  return (*expression)(values);
}

TEST(ColumnExpression, IsArithmeticOverNames) {
  EXPECT_DOUBLE_EQ(value_of("(left + right)/2*0.1", {3.0, 5.0}), 0.4);
  EXPECT_DOUBLE_EQ(value_of("duty_l*battery_v/12", {0.5, 11.4}), 0.475);
  EXPECT_DOUBLE_EQ(value_of("-a^2", {3.0}), -9.0);
  EXPECT_DOUBLE_EQ(value_of("1e-3*t - 1.5E+2", {2000.0}), -148.0);
  EXPECT_DOUBLE_EQ(value_of("a - -a", {2.0}), 4.0);
  EXPECT_DOUBLE_EQ(value_of("0"), 0.0);
}

TEST(ColumnExpression, HasFunctionsAndPi) {
  EXPECT_DOUBLE_EQ(value_of("w*180/pi", {std::acos(-1.0)}), 180.0);
  EXPECT_DOUBLE_EQ(value_of("atan2(2*(w*z + x*y), 1 - 2*(y*y + z*z))", {1.0, 0.0, 0.0, 0.0}), 0.0);
  EXPECT_DOUBLE_EQ(value_of("min(max(p, 0), 1)", {1.7}), 1.0);
  EXPECT_DOUBLE_EQ(value_of("sqrt (a) + abs(b)", {9.0, -2.0}), 5.0);
}

TEST(ColumnExpression, NamesWithOtherCharactersAreQuoted) {
  const auto parsed =
      ColumnExpression::parse("`wheel speed/left` + \"V (km/h)\" + `pi` + a.b[2].c");
  ASSERT_TRUE(parsed) << parsed.error();
  EXPECT_THAT(parsed->names(), ElementsAre("wheel speed/left", "V (km/h)", "pi", "a.b[2].c"));
}

TEST(ColumnExpression, AColumnCountsOnceHoweverOftenItIsUsed) {
  const auto parsed = ColumnExpression::parse("a*a + b/a");
  ASSERT_TRUE(parsed);
  EXPECT_THAT(parsed->names(), ElementsAre("a", "b"));
}

TEST(ColumnExpression, RefusesInvalidFormulas) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"a=1", "= is not allowed"},
      {"a==1", "= is not allowed"},
      {"a<b", "< is not allowed"},
      {"a?b:c", "? is not allowed"},
      {"a;b", "; is not allowed"},
      {"a&&b", "& is not allowed"},
      {"'a'", "' is not allowed"},
      {"a[b]", "[ is not allowed"},
      {"a,b", "comma"},
      {"(a,b)", "comma"},
      {"1,5*a", "comma"},
      {"max((a,b))", "comma"},
      {"system(a)", "no function"},
      {"rnd(a)", "no function"},
      {"a.b(c)", "no function"},
      {"(a", "bracket is not closed"},
      {"a)", "no opening bracket"},
      {"`a", "is not closed"},
      {"``", "name is empty"},
      {"1e999*a", "not a finite number"},
      {"", "not a formula"},
      {"a b", "not a formula"},
      {"a*", "not a formula"},
      {"*a", "not a formula"},
      {"a 0x10", "not a formula"},
      {"max()", "not a formula"},
      {"sin(a,b)", "not a formula"},
      {"()", "not a formula"},
      {"2a", "not a formula"},
      {std::string(1001, '1'), "the limit is 1000"}};
  for (const auto& [text, words] : cases) {
    const auto parsed = ColumnExpression::parse(text);
    ASSERT_FALSE(parsed) << text;
    EXPECT_THAT(parsed.error(), HasSubstr(words)) << text;
  }
}

TEST(ColumnExpression, DeepBracketsAreBoundedByTheLength) {
  EXPECT_DOUBLE_EQ(value_of(std::string(499, '(') + "1" + std::string(499, ')')), 1.0);
}

TEST(ParseColumn, TakesEveryForm) {
  for (const char* text : {"speed_mps=V", "speed_mps=(left + right)/2*0.1", "steering_deg=0",
                           "force_left=duty_l*battery_v/12", "x_m=a*b", "x_m=a*2*3",
                           "yaw_rate_radps=W (IMU)*0.01745", "drive_2.csv:speed_mps=V/3.6"}) {
    EXPECT_TRUE(parse_column(text)) << text;
  }
  EXPECT_EQ(parse_column("runs/drive_2.csv:speed_mps=V/3.6")->file, "runs/drive_2.csv");
}

TEST(ParseColumn, RefusesInvalidMappings) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"x", "no '='"},           {"=a", "NAME is empty"},   {"x=", "EXPRESSION is empty"},
      {":x=a", "FILE is"},       {"f:=a", "NAME is"},       {"x=a*0", "scale of 0"},
      {"x=a*", "not a formula"}, {"x=*2", "not a formula"}, {"x=a*2=b", "not allowed"}};
  for (const auto& [text, words] : cases) {
    const auto mapping = parse_column(text);
    EXPECT_THAT(faults_of(mapping), ElementsAre(AllOf(HasSubstr(words), HasSubstr("NAME="))))
        << text;
  }
}

TEST(ParseColumn, WhatAnOutputNamesReadsBackTheSame) {
  for (const char* text : {"x=a*b/12", "f.csv:x=(a + b)/2", "x=0", "x=1.5e-3"}) {
    EXPECT_EQ(text_of(*parse_column(text)), text);
  }
  EXPECT_EQ(text_of(*parse_column("x=V")), "x=V*1+0");
  EXPECT_EQ(text_of(*parse_column("x=\"V (km/h)\" * 0.5")), "x=V (km/h)*0.5+0");
  for (const char* text :
       {"x=\"a*b\"*0.5+0", "x=\"a+b\"*2+1", "x=\"an \"\"inner\"\" quote\"*0.5+0"}) {
    EXPECT_EQ(text_of(*parse_column(text)), text);
  }
}

TEST(ParseColumn, ScalesAMappingForASuggestion) {
  EXPECT_EQ(scaled_expression(*parse_column("x=V*0.5"), 3.0), "\"V\"*1.5");
  EXPECT_EQ(scaled_expression(*parse_column("x=\"V (km/h)\"*0.5"), 3.0), "\"V (km/h)\"*1.5");
  EXPECT_EQ(scaled_expression(*parse_column("x=V (km/h)"), 3.0), "\"V (km/h)\"*3");
  EXPECT_EQ(scaled_expression(*parse_column("x=(a + b)/2"), 3.0), "((a + b)/2)*3");
  EXPECT_EQ(scaled_expression(*parse_column("x=a/b"), 3.0), "(a/b)*3");
  // 3 (0.5 V + 2) = 1.5 V + 6, and 3 (0.5 V - 2) + 1 = 1.5 V - 5.
  EXPECT_EQ(scaled_expression(*parse_column("x=V*0.5+2"), 3.0), "\"V\"*1.5+6");
  EXPECT_EQ(scaled_expression(*parse_column("x=\"V\"*0.5-2"), 3.0, 1.0), "\"V\"*1.5-5");
  EXPECT_EQ(scaled_expression(*parse_column("x=a/b"), 3.0, 1.0), "(a/b)*3+1");
}

/// Column x of a file with these mappings.
Result<CsvTable> x_of(std::string_view file, const std::vector<std::string>& mappings) {
  std::vector<ColumnMapping> parsed;
  for (const std::string& text : mappings) parsed.push_back(*parse_column(text));
  return read_text(file, {{"x"}, {"y", false}}, parsed);
}

void expect_x(std::string_view file, const std::string& mapping, std::vector<double> expected) {
  const auto table = x_of(file, {mapping});
  ASSERT_TRUE(table) << mapping << ": " << to_text(table.error());
  EXPECT_THAT(table->column("x"), ::testing::ElementsAreArray(expected)) << mapping;
  EXPECT_THAT(table->mapped, ElementsAre(0U)) << mapping;
}

TEST(CsvExpressions, AreEvaluatedByRow) {
  expect_x("l,r\n1,3\n2,6\n", "x=(l + r)/2*0.1", {0.2, 0.4});
  expect_x("l,r\n1,3\n2,6\n", "x=-7.5", {-7.5, -7.5});
  expect_x("`a,wheel speed/left\n1,3\n", "x=`wheel speed/left`*2", {6.0});
}

TEST(CsvExpressions, ATextThatEqualsAColumnsNameIsThatColumn) {
  expect_x("a,b,a-b,a*2\n5,3,100,200\n", "x=a-b", {100.0});
  expect_x("a,b,a-b,a*2\n5,3,100,200\n", "x=a*2", {200.0});
  expect_x("a,b\n5,3\n", "x=a-b", {2.0});
  expect_x("a,b\n5,3\n", "x=a*2", {10.0});
  expect_x("a,0\n5,3\n", "x=0", {3.0});
  expect_x("a-b,a\n7,5\n", "x=a-b*2", {14.0});
}

TEST(CsvExpressions, AnUnknownNameIsAFaultWithTheNearestOne) {
  EXPECT_THAT(faults_of(x_of("left,right\n1,2\n", {"x=(left + righ)/2"})),
              ElementsAre(AllOf(StartsWith("a.csv:1:1: "), HasSubstr("\"righ\" is missing"),
                                HasSubstr("did you mean \"right\"?"))));
  EXPECT_THAT(faults_of(x_of("x,left\n1,2\n", {"y=left*righ"})), SizeIs(1))
      << "also for a column that may be absent";
}

TEST(CsvExpressions, AResultThatIsNotFiniteIsAFaultWithItsInputs) {
  EXPECT_THAT(faults_of(x_of("a,b\n1,2\n1,0\n0,0\n", {"x=a/b"})),
              ElementsAre(AllOf(StartsWith("a.csv:3:1: "), HasSubstr("a/b is infinite"),
                                HasSubstr("a = 1, b = 0")),
                          AllOf(StartsWith("a.csv:4:1: "), HasSubstr("is not a number"))));
  EXPECT_THAT(faults_of(x_of("a\n-1\n", {"x=sqrt(a)"})), ElementsAre(HasSubstr("not a number")));
}

TEST(CsvExpressions, FaultsOfTheColumnsUsedAreThoseOfTheirCells) {
  EXPECT_THAT(faults_of(x_of("a,b\n1,fast\n,2\n", {"x=a+b"})),
              ElementsAre(AllOf(StartsWith("a.csv:2:3: "), HasSubstr("column b:")),
                          AllOf(StartsWith("a.csv:3:1: "), HasSubstr("is empty"))));
}

TEST(CsvExpressions, TheFilesOwnMappingComesBeforeTheOthers) {
  const auto table = x_of("a,b\n1,2\n", {"x=a", "a.csv:x=b", "b.csv:x=c"});
  ASSERT_TRUE(table) << to_text(table.error());
  EXPECT_THAT(table->column("x"), ElementsAre(2.0));
  EXPECT_THAT(table->mapped, ElementsAre(1U));
}

TEST(CsvExpressions, TheVehiclesMappingHasTheLowestPriority) {
  ColumnMapping vehicle = *parse_column("x=a");
  vehicle.standing = true;
  const auto both = read_text("a,b\n1,2\n", {{"x"}}, {vehicle, *parse_column("x=b")});
  ASSERT_TRUE(both);
  EXPECT_THAT(both->column("x"), ElementsAre(2.0));
  const auto other_file = read_text("a\n1\n", {{"x"}}, {vehicle, *parse_column("x=b")});
  ASSERT_TRUE(other_file);
  EXPECT_THAT(other_file->column("x"), ElementsAre(1.0));
}

}  // namespace
}  // namespace awmr::testing
