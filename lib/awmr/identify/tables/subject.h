/// Subject of a table fit: the resistance to be fitted (surge or yaw), with its runs and
/// parameters. Private to identify/.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/identify/tables/steady_fit.h"
#include "awmr/model/model.h"
#include "awmr/trials/trials.h"

namespace awmr {

/// A default-constructed Subject has the names of the surge law.
struct Subject {
  FitSubject name = FitSubject::kSurge;  ///< surge or yaw
  ParameterId alpha = ParameterId::kSurgeAlpha;
  ParameterId beta = ParameterId::kSurgeBeta;
  ParameterId coulomb = ParameterId::kSurgeCoulomb;
  ParameterId quadratic = ParameterId::kSurgeQuadratic;
  std::vector<Family> families;  ///< families to compare; the first is the power law
  Interval beta_range;           ///< accepted exponents
  std::string file;              ///< file of the runs, for findings
  std::vector<SteadyPoint> points;
};

/// Surge resistance g1 from the surge runs: tau_speed = g1(u).                  [paper (45)-(54)]
Subject surge_subject(const Vehicle& vehicle, const TrialSet<SurgeRow>& runs);
/// Yaw resistance g3 from the turning runs: tau_turn = g3(r), after subtracting the wheels' dead
/// zone F'0.                                                                    [paper (61)-(63)]
Subject yaw_subject(const Vehicle& vehicle, const TrialSet<TurningRow>& runs, double dead_zone);

/// Converts turning rows to points. Subtracts the dead zone F'0 from the magnitude of each wheel
/// force F' and reduces tau_turn in the same ratio. Omits rows whose forces are within the dead
/// zone.
std::vector<SteadyPoint> turning_points(const std::vector<TurningRow>& rows, double dead_zone);

/// The model parameter that belongs to a coordinate of the fit.
ParameterId parameter_of(const Subject& subject, TransformedParameter c);

/// Parameter value, standard error and 95 % interval of one coordinate. `interval`: used in place
/// of the Student's t interval if present.
Estimate estimate_of(const SteadyFit& fit, TransformedParameter c,
                     const std::optional<Interval>& interval, const std::string& method);

/// Report of a fit for /estimates of model.json. `noise`: name of the quantity that has the error.
EstimatorReport report_of(const Subject& subject, const SteadyFit& fit, Family family,
                          Estimator estimator, std::string_view noise);

}  // namespace awmr
