/// The model under construction: the values set by each kind of trial, with their covariance.
/// Private to identify/.
#pragma once

#include <optional>

#include "awmr/identify/coastdown/mass.h"
#include "awmr/identify/logs/log_stage.h"
#include "awmr/identify/tables/subject_fit.h"
#include "awmr/identify/uncertainty/joint_covariance.h"
#include "awmr/model/model.h"

namespace awmr {

/// A model and the covariance of its fitted parameters. Later evidence replaces earlier evidence.
struct MainValues {
  Model& model;
  JointCovariance covariance = {};
};

/// Sets the values of vehicle.json: sway resistance and servo.
void set_given(const Vehicle& vehicle, Model& model);

/// A fitted resistance law with its family. Precondition: `fit` has one.
void set_law(const Subject& subject, const SubjectFit& fit, MainValues& values);

/// Sets m' from coast-downs, and I'z from m'; also b1, if there are curves but no surge law.
/// Precondition: set_law() was called with the surge fit, if there is one.
void set_mass(const MassResult& mass, const std::optional<SteadyFit>& surge, MainValues& values);

/// Sets the values of the logs. `yaw_family`: of the logs' fit.
void set_logs(const LogStage& logs, MainValues& values);

}  // namespace awmr
