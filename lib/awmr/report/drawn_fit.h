/// Data of the identification charts of page and figures: the curve through steady runs with its
/// band, residuals, and modelled coast-downs. Private to report/.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "awmr/core/json.h"
#include "awmr/model/model.h"

namespace awmr {

/// One point of the curve through steady runs: the input over the steady rate.
struct CurvePoint {
  double rate = 0.0;   ///< u in m/s or r in rad/s
  double value = 0.0;  ///< input for this steady rate: tau_speed, or tau_turn in m
  /// Half width of the 95 % confidence band at this rate, in the unit of `value`; 0 if the model has
  /// no covariance of the law.
  double half_band = 0.0;
};

/// Relative residual of a trial.
struct LeftOver {
  std::size_t trial = 0;  ///< index of the model's trial
  double percent = 0.0;   ///< (measured/predicted - 1) 100
};

/// Steady runs of one kind of trial, and the resistance law of the model.
struct DrawnFit {
  std::vector<std::size_t> trials =
      {};                              ///< indices of the model's trials of this kind, never empty
  Resistance<double> law{};            ///< its `coulomb` includes the effect of a dead zone
  std::vector<CurvePoint> curve = {};  ///< empty if the model does not have the law
  bool has_band = false;               ///< true: the curve has a confidence band
  /// Residuals; empty if fewer than three rows are predicted.
  std::vector<LeftOver> left_over = {};
  double bound_percent = 0.0;  ///< limit that contains 99 of 100 residuals if errors are normal
};

/// Returns the runs of `kind`, kSurge or kTurning, with their curve; empty if the model has none.
std::optional<DrawnFit> drawn_fit(const Model& model, TrialKind kind);

/// A modelled coast-down: m' du/dt = -g1(u) from its initial speed to rest.
struct CoastdownCurve {
  double initial_speed_mps = 0.0;
  std::vector<double> t_s = {};
  std::vector<double> speed_mps = {};
};

/// Computes one curve for each initial speed of the model's coast-downs; of many speeds, eight evenly
/// chosen ones. Empty if there are no coast-downs, or if the model has no g1 or m'.
std::vector<CoastdownCurve> coastdown_curves(const Model& model);

/// For each trial of the model: true if a warning or an error refers to its row.
std::vector<bool> doubtful_trials(const Model& model);

/// The fits and coast-downs as the page needs them: {"surge", "turning", "coastdown"}, as far as the
/// model has them.
Json fits_json(const Model& model);

}  // namespace awmr
