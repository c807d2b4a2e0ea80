/// Functions that write the results of each kind of trial into the model, with their covariance.
/// Private to identify/.
#pragma once

#include <optional>

#include "awmr/identify/coastdown/mass.h"
#include "awmr/identify/logs/log_stage.h"
#include "awmr/identify/tables/subject_fit.h"
#include "awmr/identify/uncertainty/joint_covariance.h"
#include "awmr/model/model.h"

namespace awmr {

/// A model under construction and the covariance of its fitted parameters. Each function below
/// overwrites parameters that earlier calls have set.
struct MainValues {
  Model& model;
  JointCovariance covariance = {};
};

/// Sets the values that vehicle.json gives: sway resistance, back-EMF and servo time constant.
void set_given(const Vehicle& vehicle, Model& model);

/// Sets the parameters and the family of a resistance law. Precondition: `fit.chosen` is set.
void set_law(const Subject& subject, const SubjectFit& fit, MainValues& values);

/// Sets m' from coast-downs, and I'z from m'. Without a surge law, sets only b1, from a power-law
/// fit of the coast-down curves. `surge`: the surge law; absent if it is not identified.
/// Precondition: set_law() was called with the surge fit, if there is one.
void set_mass(const MassResult& mass, const std::optional<SteadyFit>& surge, MainValues& values);

/// Sets the values, the families and the covariance that the logs determine.
void set_logs(const LogStage& logs, MainValues& values);

}  // namespace awmr
