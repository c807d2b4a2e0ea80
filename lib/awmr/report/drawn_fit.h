/// Curve through steady runs with its band, residuals, and modelled coast-downs, for page and
/// figures. Private to this folder.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "awmr/core/json.h"
#include "awmr/model/model.h"

namespace awmr {

/// One point of the curve through steady runs, all in the unit of the trial's input.
struct CurvePoint {
  double rate = 0.0;   ///< u in m/s or r in rad/s
  double value = 0.0;  ///< input for this steady rate: tau_speed, or tau_turn in m
  /// Half width of the 95 % confidence band at this rate; 0 without a covariance of the law.
  double half_band = 0.0;
};

/// Residual of a row.
struct LeftOver {
  std::size_t trial = 0;  ///< index of the model's trial
  double percent = 0.0;   ///< (measured/predicted - 1) 100
};

/// Steady runs of one kind and the law of the model.
struct DrawnFit {
  std::vector<std::size_t> trials =
      {};                              ///< indices of the model's trials of this kind, never empty
  Resistance<double> law{};            ///< including the effect of a dead zone, in `coulomb`
  std::vector<CurvePoint> curve = {};  ///< empty if the model does not have the law
  bool has_band = false;
  std::vector<LeftOver> left_over = {};  ///< empty if fewer than three rows are predicted
  double bound_percent = 0.0;            ///< contains 99 of 100 rows if errors are normal
};

/// The runs of `kind`, kSurge or kTurning; none if the model has no such runs.
std::optional<DrawnFit> drawn_fit(const Model& model, TrialKind kind);

/// A modelled coast-down: m' du/dt = -g1(u) from its initial speed to rest.
struct CoastdownCurve {
  double initial_speed_mps = 0.0;
  std::vector<double> t_s = {};
  std::vector<double> speed_mps = {};
};

/// One curve per initial speed of the model's coast-downs, at even ranks if there are many. Empty
/// if there are none, or if the model has no g1 or m'.
std::vector<CoastdownCurve> coastdown_curves(const Model& model);

/// By trial of the model: true if a warning or an error refers to its row.
std::vector<bool> doubtful_trials(const Model& model);

/// All of the above in the form used by the page: {"surge", "turning", "coastdown"}, as far as
/// available.
Json fits_json(const Model& model);

}  // namespace awmr
