/// Subject of a fit of steady runs, surge or yaw, and its entry in /estimates. Private to
/// identify/.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/identify/tables/steady_fit.h"
#include "awmr/model/model.h"
#include "awmr/trials/trials.h"

namespace awmr {

/// One resistance law, the names of its parameters and the runs that measure it.
struct Subject {
  FitSubject name = FitSubject::kSurge;  ///< surge or yaw
  ParameterId alpha = ParameterId::kSurgeAlpha;
  ParameterId beta = ParameterId::kSurgeBeta;
  ParameterId coulomb = ParameterId::kSurgeCoulomb;
  ParameterId quadratic = ParameterId::kSurgeQuadratic;
  std::vector<Family> families;  ///< applicable ones; the first is the power law
  Interval beta_range;           ///< accepted exponents; bounds of a fit
  std::string file;              ///< of the runs, for findings
  std::vector<SteadyPoint> points;
};

/// g1: tau_speed = g1(u), from the surge runs.                                  [paper (45)-(54)]
Subject surge_subject(const Vehicle& vehicle, const TrialSet<SurgeRow>& runs);
/// g3: tau_turn = g3(r), from the turning runs after subtracting the wheels' dead zone F'0.
///                                                                              [paper (61)-(63)]
Subject yaw_subject(const Vehicle& vehicle, const TrialSet<TurningRow>& runs, double dead_zone);

/// Subtracts the dead zone F'0 from each F', and reduces tau_turn by the same factor. Rows within
/// the dead zone are left out.
std::vector<SteadyPoint> turning_points(const std::vector<TurningRow>& rows, double dead_zone);

/// The parameter of the model that a coordinate of the fit belongs to.
ParameterId parameter_of(const Subject& subject, TransformedParameter c);

/// Value, standard error and 95 % interval of one coordinate: Student's t, or the given interval.
Estimate estimate_of(const SteadyFit& fit, TransformedParameter c,
                     const std::optional<Interval>& interval, const std::string& method);

/// A fit as an entry of /estimates. `noise`: name of the quantity with the error.
EstimatorReport report_of(const Subject& subject, const SteadyFit& fit, Family family,
                          Estimator estimator, std::string_view noise);

}  // namespace awmr
