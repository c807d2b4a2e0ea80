#include "awmr/report/figures/figure.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "awmr/core/csv/csv_cell.h"
#include "awmr/core/json/json.h"
#include "awmr/core/name_table.h"
#include "awmr/report/report.h"

namespace awmr {
namespace {

constexpr const char* kSchema = "awmr.figures/1";

constexpr NameTable<SeriesShape, 5> kShapeNames{{{"line", SeriesShape::kLine},
                                                 {"points", SeriesShape::kPoints},
                                                 {"band", SeriesShape::kBand},
                                                 {"ticks", SeriesShape::kTicks},
                                                 {"ranges", SeriesShape::kRanges}}};
constexpr NameTable<Role, 9> kRoleNames{{{"measured", Role::kMeasured},
                                         {"doubtful", Role::kDoubtful},
                                         {"model", Role::kModel},
                                         {"predicted", Role::kPredicted},
                                         {"differential", Role::kDifferential},
                                         {"steering", Role::kSteering},
                                         {"combined", Role::kCombined},
                                         {"reference", Role::kReference},
                                         {"minor", Role::kMinor}}};

std::string cell_at(const std::vector<double>& values, std::size_t i) {
  return i < values.size() ? fmt::format("{}", values[i]) : std::string();
}

bool are_finite(const Series& series) {
  for (const auto* values : {&series.x, &series.y, &series.low, &series.high}) {
    for (const double value : *values) {
      if (!std::isfinite(value)) return false;
    }
  }
  return true;
}

Json axis_json(const Axis& axis) {
  return {
      {"quantity", axis.quantity}, {"unit", axis.unit}, {"zero", axis.zero}, {"rows", axis.rows}};
}

Json panel_json(const Panel& panel) {
  Json series = Json::array();
  for (const Series& one : panel.series) {
    series.push_back({{"name", one.name},
                      {"shape", name_in(kShapeNames, one.shape)},
                      {"role", name_in(kRoleNames, one.role)}});
  }
  return {{"y", axis_json(panel.y)}, {"series", std::move(series)}};
}

Json figure_json(const Figure& figure) {
  Json panels = Json::array();
  for (const Panel& panel : figure.panels) panels.push_back(panel_json(panel));
  Json circles = Json::array();
  for (const FigureCircle& circle : figure.circles) {
    circles.push_back({{"x", circle.x}, {"y", circle.y}, {"radius", circle.radius}});
  }
  return {
      {"name", figure.name},      {"meaning", figure.meaning},   {"equal_axes", figure.equal_axes},
      {"x", axis_json(figure.x)}, {"panels", std::move(panels)}, {"circles", std::move(circles)}};
}

void describe_axis(JsonObject json) {
  json.string("quantity");
  json.string("unit");
  json.boolean("zero");
  json.strings("rows");
  json.reject_unknown_keys();
}

void describe_figures(JsonObject& json) {
  json.schema(kSchema);
  for (JsonObject& figure : json.objects("figures")) {
    figure.string("name");
    figure.string("meaning");
    figure.boolean("equal_axes");
    describe_axis(figure.object("x"));
    for (JsonObject& panel : figure.objects("panels")) {
      describe_axis(panel.object("y"));
      for (JsonObject& series : panel.objects("series")) {
        series.string("name");
        series.choice("shape", kShapeNames);
        series.choice("role", kRoleNames);
        series.reject_unknown_keys();
      }
      panel.reject_unknown_keys();
    }
    for (JsonObject& circle : figure.objects("circles")) {
      for (const char* key : {"x", "y"}) circle.number(key);
      circle.number("radius", kPositive);
      circle.reject_unknown_keys();
    }
    figure.reject_unknown_keys();
  }
  json.reject_unknown_keys();
}

}  // namespace

Result<std::string> figure_csv(const Figure& figure) {
  std::string csv = "panel,series,name,x,y,low,high\n";
  for (std::size_t p = 0; p < figure.panels.size(); ++p) {
    const std::vector<Series>& all = figure.panels[p].series;
    for (std::size_t s = 0; s < all.size(); ++s) {
      const Series& series = all[s];
      if (!are_finite(series)) {
        return input_error(ErrorCode::kOutOfRange, "figure " + figure.name,
                           fmt::format("the figure's data \"{}\" have a number that is not finite; "
                                       "create the results again",
                                       series.name));
      }
      const std::string name = cell_of_text(series.name);
      for (std::size_t i = 0; i < series.x.size(); ++i) {
        fmt::format_to(std::back_inserter(csv), "{},{},{},{},{},{},{}\n", p, s, name, series.x[i],
                       cell_at(series.y, i), cell_at(series.low, i), cell_at(series.high, i));
      }
    }
  }
  return csv;
}

std::string figures_text(const std::vector<Figure>& figures) {
  Json list = Json::array();
  for (const Figure& figure : figures) list.push_back(figure_json(figure));
  return to_text(Json{{"schema", kSchema}, {"figures", std::move(list)}});
}

std::string figures_schema() {
  return json_schema_text(kSchema, "Print figures, drawn by plot.py", describe_figures);
}

}  // namespace awmr
