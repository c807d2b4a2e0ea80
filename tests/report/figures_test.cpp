/// Print figures: content of the page for any numbers and names.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "awmr/report/figures/layout.h"
#include "awmr/report/figures/ticks.h"

namespace awmr::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

std::vector<std::string> texts(const Ticks& ticks) {
  std::vector<std::string> all;
  for (const Tick& tick : ticks.list) all.push_back(tick.text);
  return all;
}

TEST(Ticks, StandAtRoundNumbersWithARealMinusSign) {
  EXPECT_THAT(texts(ticks_in({-0.6, 1.1}, 5)), ElementsAre("\u22120.5", "0.0", "0.5", "1.0"));
  EXPECT_THAT(texts(ticks_in({3.0, 97.0}, 5)), ElementsAre("20", "40", "60", "80"));
}

TEST(Ticks, HaveAPowerOfTenInCommonWhereNumbersWouldBeLong) {
  const Ticks small = ticks_in({0.0, 4.2e-8}, 5);
  EXPECT_EQ(small.exponent, -9);
  EXPECT_THAT(texts(small), ElementsAre("0", "10", "20", "30", "40"));
  const Ticks large = ticks_in({-2.5e6, 2.5e6}, 5);
  EXPECT_EQ(large.exponent, 6);
  EXPECT_THAT(texts(large), ElementsAre("\u22122", "\u22121", "0", "1", "2"));
}

TEST(Ticks, AreWithinTheRangeNoMoreThanAskedForAndDifferentAtEveryScale) {
  for (int power = -90; power <= 90; ++power) {
    for (const double from : {-1.0, -0.37, 0.0, 0.99, 12.3}) {
      const double scale = std::pow(10.0, power);
      const Interval range{from * scale, (from + 0.731) * scale};
      for (int most = 2; most < 12; ++most) {
        const Ticks ticks = ticks_in(range, most);
        ASSERT_GE(ticks.list.size(), 1u) << power << " " << from << " " << most;
        ASSERT_LE(ticks.list.size(), static_cast<std::size_t>(most));
        for (std::size_t i = 0; i < ticks.list.size(); ++i) {
          // A tick at an end of the range may be off by rounding.
          EXPECT_GE(ticks.list[i].value, range.lo - 1e-12 * scale);
          EXPECT_LE(ticks.list[i].value, range.hi + 1e-12 * scale);
          if (i == 0) continue;
          EXPECT_NE(ticks.list[i].text, ticks.list[i - 1].text);
        }
      }
    }
  }
}

Figure figure_of(std::vector<double> x, std::vector<double> y) {
  return {
      .name = "some",
      .meaning = "Some numbers",
      .x = {"t", "s"},
      .panels = {
          {.y = {"u_{x}", "m/s"},
           .series = {
               {.name = "line", .shape = SeriesShape::kLine, .role = Role::kModel, .x = x, .y = y},
               {.name = "points",
                .shape = SeriesShape::kPoints,
                .role = Role::kMeasured,
                .x = std::move(x),
                .y = std::move(y)}}}}};
}

/// Left, right, top and bottom of a horizontal label; the height is the font size.
struct Box {
  double left, right, top, bottom;
  bool meets(const Box& other) const {
    return left < other.right && other.left < right && top < other.bottom && other.top < bottom;
  }
};

Box box_of(const Label& label) {
  const double width = width_of(label.runs);
  const double before = label.anchor == Anchor::kStart    ? 0.0
                        : label.anchor == Anchor::kMiddle ? 0.5 * width
                                                          : width;
  if (label.upwards) {
    return {label.at.x - kTextSizePt, label.at.x + 0.3 * kTextSizePt, label.at.y - (width - before),
            label.at.y + before};
  }
  return {label.at.x - before, label.at.x + width - before, label.at.y - 0.75 * kTextSizePt,
          label.at.y + 0.1 * kTextSizePt};
}

/// Every label is on the page, and no two overlap.
void expect_legible(const Drawing& drawing) {
  std::vector<Box> boxes;
  for (const Layer& layer : drawing.layers) {
    for (const Mark& mark : layer.marks) {
      const auto* label = std::get_if<Label>(&mark);
      if (label == nullptr || width_of(label->runs) == 0.0) continue;
      const Box box = box_of(*label);
      EXPECT_GE(box.left, 0.0) << label->runs[0].text;
      EXPECT_LE(box.right, drawing.width_pt) << label->runs[0].text;
      EXPECT_GE(box.top, 0.0) << label->runs[0].text;
      EXPECT_LE(box.bottom, drawing.height_pt) << label->runs[0].text;
      for (const Box& other : boxes) EXPECT_FALSE(box.meets(other)) << label->runs[0].text;
      boxes.push_back(box);
    }
  }
  EXPECT_GT(boxes.size(), 2u);
}

/// Every point of a series is on the page.
void expect_on_page(const Drawing& drawing) {
  for (const Layer& layer : drawing.layers) {
    for (const Mark& mark : layer.marks) {
      const auto* outline = std::get_if<Outline>(&mark);
      if (outline == nullptr) continue;
      for (const PagePoint& p : outline->points) {
        ASSERT_TRUE(p.x >= 0.0 && p.x <= drawing.width_pt) << layer.name << p.x;
        ASSERT_TRUE(p.y >= 0.0 && p.y <= drawing.height_pt) << layer.name << p.y;
      }
    }
  }
}

TEST(Figures, OddNumbersAreDrawnLegibly) {
  const std::vector<std::pair<std::vector<double>, std::vector<double>>> odd{
      {{}, {}},
      {{1.0}, {2.0}},
      {{0.0}, {0.0}},
      {{1.0, 2.0, 3.0}, {5.0, 5.0, 5.0}},
      {{0.0, 1.0}, {1e9, 1e9 + 1e-3}},
      {{0.0, 1e100}, {-1e100, 1e100}},
      {{0.0, 1e-99}, {-1e-99, 1e-99}},
      {{1e-308, 2e-308}, {0.0, 5e-324}},
      {{123456.0, 123457.0}, {-0.001234, -0.001233}},
      {{-5.0, 5.0, -5.0}, {1e4, 2e4, 1e4}}};
  for (const auto& [x, y] : odd) {
    for (const bool equal : {false, true}) {
      Figure figure = figure_of(x, y);
      figure.equal_axes = equal;
      const auto drawing = layout(figure);
      ASSERT_TRUE(drawing) << to_text(drawing.error());
      expect_legible(*drawing);
      expect_on_page(*drawing);
      EXPECT_TRUE(drawing_pdf(*drawing));
    }
  }
}

TEST(Figures, NumbersThatCannotBeDrawnAreRefusedByName) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(),
                           std::numeric_limits<double>::infinity(), -1e101}) {
    const auto drawing = layout(figure_of({0.0, 1.0}, {0.0, bad}));
    ASSERT_FALSE(drawing);
    EXPECT_THAT(to_text(drawing.error()), HasSubstr("figure some"));
    EXPECT_THAT(to_text(drawing.error()), HasSubstr("\"line\""));
    EXPECT_EQ(exit_code(drawing.error()), 2);
  }
}

TEST(Figures, EqualAxesAreEqual) {
  Figure figure = figure_of({0.0, 10.0, 10.0, 0.0}, {0.0, 0.0, 3.0, 3.0});
  figure.equal_axes = true;
  const auto drawing = layout(figure);
  ASSERT_TRUE(drawing);
  for (const Layer& layer : drawing->layers) {
    if (layer.name != "line") continue;
    const std::vector<PagePoint>& p = std::get<Outline>(layer.marks[0]).points;
    // Ten metres to the right are as long as ten thirds of three metres upwards.
    EXPECT_NEAR((p[1].x - p[0].x) / 10.0, (p[1].y - p[2].y) / 3.0, 1e-9);
  }
}

TEST(Figures, ManyPointsAreThinnedAndThePeakStays) {
  std::vector<double> x(50000);
  std::vector<double> y(50000);
  for (std::size_t i = 0; i < x.size(); ++i) {
    x[i] = static_cast<double>(i);
    y[i] = static_cast<double>(i * 7919 % 1000) / 1000.0;
  }
  y[777] = 9.0;
  Figure figure = figure_of(x, y);
  figure.panels[0].series.erase(figure.panels[0].series.begin());
  const auto drawing = layout(figure);
  ASSERT_TRUE(drawing);
  double highest = 1e9;
  for (const Layer& layer : drawing->layers) {
    if (layer.kind != "series") continue;
    EXPECT_LE(layer.marks.size(), 2000u);
    for (const Mark& mark : layer.marks) {
      highest = std::min(highest, std::get<Disc>(mark).centre.y);
    }
  }
  // Five percent of margin above the peak, which is nine tenths above all others.
  EXPECT_LT(highest, 0.2 * drawing->height_pt);
}

TEST(Figures, NamesOfAnyLengthAndBytesStayOnThePageAndInTheirPlace) {
  Figure figure{.name = "ranges",
                .meaning = "a </title><script>boom()</script> \x01\xff \u202e",
                .x = {.quantity = "difference", .unit = "%", .zero = true},
                .panels = {{.y = {}, .series = {}}}};
  figure.panels[0].y.rows = {std::string(5000, 'W'), "<b>&\"", "\xc3", "ψ"};
  figure.panels[0].series = {{.name = std::string(3000, 'x') + "</g>",
                              .shape = SeriesShape::kRanges,
                              .role = Role::kModel,
                              .x = {1.0, 2.0, 3.0, 4.0},
                              .y = {0.0, 1.0, 2.0, 3.0},
                              .low = {0.5, 1.5, 2.5, 3.5},
                              .high = {1.5, 2.5, 3.5, 4.5}},
                             {.name = "sample",
                              .shape = SeriesShape::kTicks,
                              .role = Role::kMinor,
                              .x = {-1.0},
                              .y = {2.0}}};
  const auto drawing = layout(figure);
  ASSERT_TRUE(drawing);
  expect_legible(*drawing);
  expect_on_page(*drawing);
  const std::string svg = drawing_svg(*drawing);
  EXPECT_THAT(svg, Not(HasSubstr("<script>")));
  EXPECT_THAT(svg, Not(HasSubstr("<b>")));
  EXPECT_EQ(svg.find_first_of("\x01\xff"), std::string::npos);
}

TEST(Figures, IndicesAndExponentsAreSetAsSuch) {
  const std::vector<TextRun> runs = text_runs("τ_{speed} (10^{3} m)");
  ASSERT_EQ(runs.size(), 5u);
  EXPECT_EQ(runs[1].text, "speed");
  EXPECT_EQ(runs[1].shift, Shift::kIndex);
  EXPECT_EQ(runs[3].shift, Shift::kExponent);
  EXPECT_EQ(runs[4].text, " m)");
  EXPECT_EQ(text_runs("u_{open").size(), 1u);
}

TEST(Figures, AreTheSameBytesAgainWithoutADate) {
  const auto first = drawing_pdf(*layout(figure_of({0.0, 1.0}, {2.0, 3.0})));
  const auto second = drawing_pdf(*layout(figure_of({0.0, 1.0}, {2.0, 3.0})));
  ASSERT_TRUE(first && second);
  EXPECT_EQ(*first, *second);
  EXPECT_THAT(*first, ::testing::StartsWith("%PDF-"));
  EXPECT_THAT(*first, Not(HasSubstr("CreationDate")));
  EXPECT_THAT(*first, HasSubstr("/FontFile"));
}

}  // namespace
}  // namespace awmr::testing
