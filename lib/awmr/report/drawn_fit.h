/// Data for the charts of the identification, which the page and the print figures share: the curve
/// through the steady runs with its confidence band, residuals, and modelled coast-downs. Private
/// to report/.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "awmr/core/json/json.h"
#include "awmr/model/model.h"

namespace awmr {

/// One point of the resistance curve that was fitted to steady runs.
struct CurvePoint {
  double rate = 0.0;   ///< steady rate: speed u, m/s, or yaw rate r, rad/s
  double value = 0.0;  ///< input for this steady rate: tau_speed, or tau_turn in m
  /// Half width of the 95 % confidence band at this rate, in the unit of `value`; 0 if the model
  /// has no covariance of the law.
  double half_band = 0.0;
};

/// Relative residual of a steady run.
struct LeftOver {
  std::size_t trial = 0;  ///< index in the model's list of trials
  double percent = 0.0;   ///< (measured/predicted - 1) 100
};

/// Steady runs of one kind of trial, and the resistance law of the model.
struct DrawnFit {
  /// Indices of the runs of this kind in the model's list of trials; never empty.
  std::vector<std::size_t> trials = {};
  Resistance<double> law{};            ///< law; for surge, `coulomb` includes the dead zone
  std::vector<CurvePoint> curve = {};  ///< fitted curve; empty if the model does not have the law
  bool has_band = false;               ///< true: the curve has a confidence band
  /// Residuals of the runs; empty if the model predicts fewer than three of them.
  std::vector<LeftOver> left_over = {};
  double bound_percent = 0.0;  ///< 99 % of normally distributed residuals are within +- this, %
};

/// Runs of `kind` (kSurge or kTurning) with curve and residuals; empty without such runs.
std::optional<DrawnFit> drawn_fit(const Model& model, TrialKind kind);

/// A modelled coast-down, m' du/dt = -g1(u) (u: speed, g1: surge resistance, m': normalised mass).
/// It begins at the measured initial speed, and ends at 1.1 times the measured or the predicted
/// stop time, whichever is longer.
struct CoastdownCurve {
  double initial_speed_mps = 0.0;
  std::vector<double> t_s = {};
  std::vector<double> speed_mps = {};
};

/// Computes one curve for each initial speed of the model's coast-downs, or for eight evenly chosen
/// speeds if there are more than eight. Empty if there is no coast-down, or if the model lacks the
/// surge resistance g1 or the mass m'.
std::vector<CoastdownCurve> coastdown_curves(const Model& model);

/// Returns a flag for each trial of the model: true if a warning or an error refers to its row.
std::vector<bool> doubtful_trials(const Model& model);

/// The fits and coast-downs as JSON for the page: {"surge", "turning", "coastdown"}. A kind of
/// steady run that the model does not have is left out.
Json fits_json(const Model& model);

}  // namespace awmr
