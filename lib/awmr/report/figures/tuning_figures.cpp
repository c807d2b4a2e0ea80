#include <algorithm>

#include "awmr/report/figures/figures_of.h"

namespace awmr {
namespace {

/// Step curve of the best objective so far, up to the last evaluation.
Series stairs_of(const Json& history, const char* name, Role role) {
  Series stairs{.name = name, .shape = SeriesShape::kLine, .role = role};
  for (const Json& step : history.at("best")) {
    const double evaluation = step.at("evaluation");
    if (!stairs.y.empty()) {
      stairs.x.push_back(evaluation);
      stairs.y.push_back(stairs.y.back());
    }
    stairs.x.push_back(evaluation);
    stairs.y.push_back(step.at("objective"));
  }
  if (stairs.y.empty()) return stairs;
  stairs.x.push_back(history.at("evaluations"));
  stairs.y.push_back(stairs.y.back());
  return stairs;
}

/// Curves of the searches whose history is in gains.json.
std::vector<Series> searches_of(const Json& gains) {
  std::vector<Series> all;
  const auto& search = gains.at("search").get_ref<const Json::object_t&>();
  const bool robust = gains.contains("robust");
  if (search.count("history") > 0) {
    all.push_back(stairs_of(search.at("history"), robust ? "robust" : "nominal", Role::kModel));
  }
  if (robust && gains.at("robust").contains("nominal_history")) {
    all.push_back(stairs_of(gains.at("robust").at("nominal_history"), "nominal", Role::kPredicted));
  }
  std::erase_if(all, [](const Series& one) { return one.x.empty(); });
  return all;
}

/// Name of the baseline, the gains whose objective is defined as 1. In older files without
/// `source`, the baseline is the paper's gains.
std::string baseline_name(const Json& gains) {
  const bool is_named = gains.contains("baseline") && gains.at("baseline").contains("source");
  return is_named && gains.at("baseline").at("source") != "paper" ? "baseline"
                                                                  : "the paper's gains";
}

}  // namespace

void add_tuning_figures(const Json& data, FiguresOfResults& all) {
  std::vector<Series> searches;
  if (data.contains("gains") && data.at("gains").contains("search")) {
    searches = searches_of(data.at("gains"));
  }
  if (searches.empty()) {
    all.lacking.push_back(
        "tuning_history: there is no gains.json with the history of a search (awmr tune)");
    return;
  }
  double last = 0.0;
  for (const Series& one : searches) last = std::max(last, one.x.back());
  searches.push_back({.name = baseline_name(data.at("gains")),
                      .shape = SeriesShape::kLine,
                      .role = Role::kReference,
                      .x = {0.0, last},
                      .y = {1.0, 1.0}});
  all.figures.push_back(
      {.name = "tuning_history",
       .meaning =
           "Best objective found so far over the number of evaluations; the objective of the "
           "baseline is 1",
       .x = {"evaluation"},
       .panels = {{.y = {"objective, best so far"}, .series = searches}}});
}

}  // namespace awmr
