/// Quick selection of the resistance families (forms of the resistance law) with which a log fit
/// begins. Private to identify/.
#pragma once

#include <vector>

#include "awmr/identify/logs/choice/family_fit.h"

namespace awmr {

struct Families {
  Family surge = Family::kPower;
  Family yaw = Family::kPower;
  bool operator==(const Families&) const = default;
};

/// Returns the pairs of families that differ from `from` only in the yaw family (if `of_yaw`) or
/// only in the surge family.
std::vector<Families> other_families(const Families& from, bool of_yaw);

/// Axes whose family the fit may change, because the user did not select it.
struct OpenAxes {
  bool surge = true;
  bool yaw = false;
  bool has(bool of_yaw) const { return of_yaw ? yaw : surge; }
  bool any() const { return surge || yaw; }
};

/// Selects families by rough fits (fit_roughly()), starting at the optimum of `first`. Each round
/// tries, for each open axis (surge or yaw), every family that the axis does not have yet; the axis
/// that was changed last is left out. A round also tries what a wrong family can imitate: a delay
/// of the commands, a lag of the motors (with back-EMF, also together with a force that remains
/// after a command of 0), a filter of speed or yaw rate, and ramps of the forces, if
/// a score test predicts that they lower the error by 1 %; and back-EMF if that is a candidate term
/// of `power_law`. The best change is kept if it lowers LogFit::relative_error by more than 2 %
/// (back-EMF: by a third). There are at most eight rounds.
///
/// E is the amount by which LogFit::relative_error exceeds 1, its value for sensor noise alone.
/// Returns the last rough fit if its E is less than 0.7 times the E of the rough fit with the
/// families of `first`. If it is not, returns the rough fit with the families of `first`.
FamilyFit likely_families(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                          const FamilyFit& first, const OpenAxes& open);

/// Fits the families and the back-EMF of the rough fit `rough`, starting at its optimum, with its
/// ramps and terms of single logs, but without its delay and lags. Then searches delays and command
/// errors, and tests the candidate terms of `power_law`.
FamilyFit refine(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                 const FamilyFit& rough);

}  // namespace awmr
