/// Includes the whole library. A program that needs less includes the header of its task:
///
///     read a vehicle, a model, gains     model/vehicle_file.h, model/model_file.h, model/gains_file.h
///     check a vehicle's plausibility     model/plausibility.h
///     read trials                        trials/load.h
///     fit a model to them                identify/identify.h
///     rank the trials to record next     identify/planning/suggest.h
///     test planned trials by simulation  identify/planning/recover.h
///     search gains                       tune/tune.h, tune/tune_file.h
///     simulate the closed loop, metrics  simulate/simulate.h, simulate/metrics.h
///     validate a model on its trials     validate/validate.h
///     compare the yaw-control modes      compare/compare.h, compare/comparison_directory.h
///     write firmware                     emit/emit.h
///     write other programs' parameters   emit/export.h
///     make the report                    report/report.h
///
/// A function that can fail returns a Result (core/result.h): a value, or an error with all faults.
#pragma once

#include "awmr/compare/compare.h"
#include "awmr/compare/comparison_directory.h"
#include "awmr/core/result.h"
#include "awmr/emit/emit.h"
#include "awmr/emit/export.h"
#include "awmr/identify/identify.h"
#include "awmr/identify/planning/recover.h"
#include "awmr/identify/planning/suggest.h"
#include "awmr/model/gains_file.h"
#include "awmr/model/model_file.h"
#include "awmr/model/plausibility.h"
#include "awmr/model/vehicle_file.h"
#include "awmr/report/report.h"
#include "awmr/simulate/metrics.h"
#include "awmr/simulate/scenario_file.h"
#include "awmr/simulate/simulate.h"
#include "awmr/trials/load.h"
#include "awmr/tune/tune.h"
#include "awmr/tune/tune_file.h"
#include "awmr/validate/validate.h"
