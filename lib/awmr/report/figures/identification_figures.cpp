#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "awmr/report/drawn_fit.h"
#include "awmr/report/figures/figures_of.h"

namespace awmr {
namespace {

/// Words and axes for the figures of one kind of trial.
struct KindWords {
  TrialKind kind;
  const char* name;        ///< kind of the trial in file names
  const char* resistance;  ///< resistance in texts: "surge", "yaw"
  Axis rate;
  Axis input;
};

const std::vector<KindWords>& kinds() {
  static const std::vector<KindWords> kKinds{
      {TrialKind::kSurge, "surge", "surge", {"u", "m/s"}, {"τ_{speed}"}},
      {TrialKind::kTurning, "yaw", "yaw", {"r", "rad/s"}, {"τ_{turn}", "m"}}};
  return kKinds;
}

/// Adds the measured runs as two series, with and without a warning; omits empty series.
void add_measured(const Model& model, const DrawnFit& fit, std::vector<Series>& series) {
  const std::vector<bool> doubtful = doubtful_trials(model);
  Series good{.name = "measured", .shape = SeriesShape::kPoints, .role = Role::kMeasured};
  Series odd{.name = "measured, doubtful", .shape = SeriesShape::kPoints, .role = Role::kDoubtful};
  for (const std::size_t i : fit.trials) {
    Series& one = doubtful[i] ? odd : good;
    one.x.push_back(model.record.trials[i].measured);
    one.y.push_back(model.record.trials[i].input);
  }
  for (Series& one : {std::ref(good), std::ref(odd)}) {
    if (!one.x.empty()) series.push_back(std::move(one));
  }
}

Figure resistance_figure(const Model& model, const DrawnFit& fit, const KindWords& words) {
  Figure figure{.name = fmt::format("{}_resistance", words.name),
                .meaning = fmt::format("Steady runs and the identified {} resistance with the 95 % "
                                       "confidence band of the curve",
                                       words.resistance),
                .x = words.rate,
                .panels = {{.y = words.input, .series = {}}}};
  std::vector<Series>& series = figure.panels[0].series;
  Series band{.name = "95 % confidence band", .shape = SeriesShape::kBand, .role = Role::kModel};
  Series line{.name = "fit", .shape = SeriesShape::kLine, .role = Role::kModel};
  for (const CurvePoint& p : fit.curve) {
    line.x.push_back(p.rate);
    line.y.push_back(p.value);
    band.low.push_back(std::max(0.0, p.value - p.half_band));
    band.high.push_back(p.value + p.half_band);
  }
  band.x = line.x;
  add_measured(model, fit, series);
  if (!line.x.empty()) series.push_back(std::move(line));
  if (fit.has_band) series.push_back(std::move(band));
  return figure;
}

Figure residual_figure(const Model& model, const DrawnFit& fit, const KindWords& words) {
  Series left{.name = "measured", .shape = SeriesShape::kPoints, .role = Role::kMeasured};
  for (const LeftOver& one : fit.left_over) {
    left.x.push_back(model.record.trials[one.trial].measured);
    left.y.push_back(one.percent);
  }
  const auto [least, most] = std::minmax_element(left.x.begin(), left.x.end());
  const double bound = fit.bound_percent;
  Series band{.name = fmt::format("99 % of normal errors, ±{:.3g} %", bound),
              .shape = SeriesShape::kBand,
              .role = Role::kMinor,
              .x = {*least, *most},
              .y = {},
              .low = {-bound, -bound},
              .high = {bound, bound}};
  return {.name = fmt::format("{}_residuals", words.name),
          .meaning = fmt::format("Relative residuals of the {} runs (measured/predicted - 1)",
                                 words.resistance),
          .x = words.rate,
          .panels = {{.y = {.quantity = "residual", .unit = "% of the prediction", .zero = true},
                      .series = {std::move(left), std::move(band)}}}};
}

Figure coastdown_figure(const Model& model, const std::vector<CoastdownCurve>& curves) {
  Figure figure{.name = "coastdown",
                .meaning = "Coast-downs by the model and the measured stops",
                .x = {"t", "s"},
                .panels = {{.y = {"u", "m/s"}, .series = {}}}};
  for (const CoastdownCurve& curve : curves) {
    figure.panels[0].series.push_back({.name = "model",
                                       .shape = SeriesShape::kLine,
                                       .role = Role::kModel,
                                       .x = curve.t_s,
                                       .y = curve.speed_mps});
  }
  Series stops{.name = "stop, measured", .shape = SeriesShape::kPoints, .role = Role::kMeasured};
  for (const TrialPoint& trial : model.record.trials) {
    if (trial.kind != TrialKind::kCoastdown) continue;
    stops.x.push_back(trial.measured);
    stops.y.push_back(0.0);
  }
  figure.panels[0].series.push_back(std::move(stops));
  return figure;
}

}  // namespace

void add_identification_figures(const Model& model, FiguresOfResults& all) {
  for (const KindWords& words : kinds()) {
    const auto fit = drawn_fit(model, words.kind);
    if (!fit) {
      all.lacking.push_back(fmt::format("{0}_resistance, {0}_residuals: model.json has no {1} runs",
                                        words.name, name_in(kTrialKindNames, words.kind)));
      continue;
    }
    all.figures.push_back(resistance_figure(model, *fit, words));
    if (!fit->left_over.empty()) {
      all.figures.push_back(residual_figure(model, *fit, words));
    } else {
      all.lacking.push_back(
          fmt::format("{}_residuals: fewer than three runs have a prediction", words.name));
    }
  }
  const std::vector<CoastdownCurve> curves = coastdown_curves(model);
  if (!curves.empty()) {
    all.figures.push_back(coastdown_figure(model, curves));
  } else {
    all.lacking.push_back("coastdown: model.json has no coast-downs, or no surge resistance or m'");
  }
}

}  // namespace awmr
