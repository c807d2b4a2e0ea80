#include "awmr/tune/tune_json.h"

#include <utility>

namespace awmr {
namespace {

constexpr NumberRule kGoalLimit{.min = 0.0, .max = 1e9, .min_excluded = true};

}  // namespace

TuningGoal read_goal(JsonObject json) {
  TuningGoal goal;
  JsonObject limits = json.object("at_most");
  for (const std::string& figure : run_figure_names()) {
    if (const auto most = limits.optional_number(figure, kGoalLimit)) {
      goal.at_most.push_back({figure, *most});
    }
  }
  limits.reject_unknown_keys();
  if (goal.at_most.empty()) {
    json.fault("at_most", "names no figure that runs are judged by");
  }
  goal.share =
      json.optional_number("share", {.min = kLeastShare, .max = kMostShare}).value_or(goal.share);
  if (json.has("mode")) goal.mode = json.choice("mode", kYawModeNames);
  goal.is_soft = json.optional_boolean("soft").value_or(false);
  json.reject_unknown_keys();
  return goal;
}

Json goal_json(const TuningGoal& goal) {
  Json json = {{"at_most", Json::object()}, {"share", goal.share}, {"soft", goal.is_soft}};
  for (const GoalLimit& limit : goal.at_most) json["at_most"][limit.figure] = limit.most;
  if (goal.mode) json["mode"] = name_of(*goal.mode);
  return json;
}

Json quantiles_json(const std::vector<JudgedGains>& judged) {
  Json json = Json::object();
  for (const JudgedGains& one : judged) {
    Json& entry = json[std::string(name_of(one.mode))][one.gains];
    entry["completed_share"] = one.completed_share;
    for (const JudgedFigure& figure : one.figures) {
      entry[figure.name] = {
          {"median", figure.median}, {"q95", figure.q95}, {"tail_mean", figure.tail_mean}};
    }
  }
  return json;
}

Json goals_json(const std::vector<JudgedGoal>& goals) {
  Json json = Json::array();
  for (const JudgedGoal& judged : goals) {
    Json limits = Json::object();
    for (const GoalLimit& limit : judged.goal.at_most) limits[limit.figure] = limit.most;
    json.push_back({{"at_most", std::move(limits)},
                    {"share", judged.goal.share},
                    {"soft", judged.goal.is_soft},
                    {"mode", name_of(judged.mode)},
                    {"gains", judged.gains},
                    {"held", judged.held},
                    {"runs", judged.runs},
                    {"ci95", {judged.ci95.lo, judged.ci95.hi}},
                    {"verdict", name_in(kGoalVerdictNames, judged.verdict)}});
  }
  return json;
}

}  // namespace awmr
