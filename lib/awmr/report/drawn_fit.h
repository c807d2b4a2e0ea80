/// What page and figures draw of an identification: the curve through steady runs with its band,
/// what is left over, and coast-downs by the model. Private to this folder.
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
  double value = 0.0;  ///< what holds this rate: tau_speed, or tau_turn in m
  /// Half of the 95 % confidence band at this rate; 0 where the law has no covariance.
  double half_band = 0.0;
};

/// What is left over of a row.
struct LeftOver {
  std::size_t trial = 0;  ///< which of the model's trials
  double percent = 0.0;   ///< (measured/predicted - 1) 100
};

/// Steady runs of one kind and the law of the model.
struct DrawnFit {
  std::vector<std::size_t> trials =
      {};                    ///< which of the model's trials are of this kind, never empty
  Resistance<double> law{};  ///< with what a dead zone takes, in `coulomb`
  std::vector<CurvePoint> curve = {};  ///< empty where the model does not know the law
  bool has_band = false;
  std::vector<LeftOver> left_over = {};  ///< empty where fewer than three rows are predicted
  double bound_percent = 0.0;            ///< 99 of 100 rows are within, if errors are normal
};

/// The runs of `kind`, kSurge or kTurning; none where the model was made without such.
std::optional<DrawnFit> drawn_fit(const Model& model, TrialKind kind);

/// A coast-down by the model: m' du/dt = -g1(u) from its initial speed to rest.
struct CoastdownCurve {
  double initial_speed_mps = 0.0;
  std::vector<double> t_s = {};
  std::vector<double> speed_mps = {};
};

/// For each initial speed of the model's coast-downs, of many for those at even ranks; empty where
/// there are none, or the model knows no g1 or m'.
std::vector<CoastdownCurve> coastdown_curves(const Model& model);

/// By trial of the model: whether a warning or an error is about its row.
std::vector<bool> doubtful_trials(const Model& model);

/// The three as the page draws them: {"surge", "turning", "coastdown"}, what there is of them.
Json fits_json(const Model& model);

}  // namespace awmr
