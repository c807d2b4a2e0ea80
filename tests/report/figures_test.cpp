/// Files of print figures.
#include "awmr/report/figures/figure.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

namespace awmr::testing {
namespace {

using ::testing::HasSubstr;

Figure figure_of(std::vector<double> x, std::vector<double> y, const std::string& name = "line") {
  return {.name = "some",
          .meaning = "Some numbers",
          .x = {"t", "s"},
          .panels = {{.y = {"u_{x}", "m/s"},
                      .series = {{.name = "band",
                                  .shape = SeriesShape::kBand,
                                  .role = Role::kModel,
                                  .x = {0.5},
                                  .low = {-1.0},
                                  .high = {2.0}},
                                 {.name = name,
                                  .shape = SeriesShape::kLine,
                                  .role = Role::kMeasured,
                                  .x = std::move(x),
                                  .y = std::move(y)}}}}};
}

TEST(Figures, ACsvHasARowForEachPoint) {
  EXPECT_EQ(figure_csv(figure_of({0.1, 1e-300}, {2.0, -5e99})).value(),
            "panel,series,name,x,y,low,high\n"
            "0,0,band,0.5,,-1,2\n"
            "0,1,line,0.1,2,,\n"
            "0,1,line,1e-300,-5e+99,,\n");
}

TEST(Figures, NamesWithCommasAndFormulasAreQuoted) {
  EXPECT_THAT(figure_csv(figure_of({0.0}, {1.0}, "a,b")).value(), HasSubstr("0,1,\"a,b\",0,1,,\n"));
  EXPECT_THAT(figure_csv(figure_of({0.0}, {1.0}, "=A1")).value(), HasSubstr("0,1,'=A1,0,1,,\n"));
}

TEST(Figures, NumbersThatCannotBeDrawnAreRefusedByName) {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    const auto csv = figure_csv(figure_of({0.0, 1.0}, {0.0, bad}));
    ASSERT_FALSE(csv);
    EXPECT_THAT(to_text(csv.error()), HasSubstr("figure some"));
    EXPECT_THAT(to_text(csv.error()), HasSubstr("\"line\""));
    EXPECT_EQ(exit_code(csv.error()), 2);
  }
}

TEST(Figures, AxesSeriesAndCirclesAreInTheJson) {
  Figure figure = figure_of({0.0}, {1.0});
  figure.circles = {{1.0, 2.0, 0.5}};
  const auto json = nlohmann::json::parse(figures_text({figure, figure}));
  EXPECT_EQ(json.at("schema"), "awmr.figures/1");
  ASSERT_EQ(json.at("figures").size(), 2u);
  const auto& one = json.at("figures").at(0);
  EXPECT_EQ(one.at("x").at("unit"), "s");
  EXPECT_EQ(one.at("circles").at(0).at("radius"), 0.5);
  const auto& series = one.at("panels").at(0).at("series");
  EXPECT_EQ(series.at(0).at("shape"), "band");
  EXPECT_EQ(series.at(1).at("role"), "measured");
}

}  // namespace
}  // namespace awmr::testing
