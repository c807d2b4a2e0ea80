/// Quick selection of the resistance families with which a log fit begins. Private to identify/.
#pragma once

#include <vector>

#include "awmr/identify/logs/family_fit.h"

namespace awmr {

/// A surge family and a yaw family.
struct Families {
  Family surge = Family::kPower;
  Family yaw = Family::kPower;
  bool operator==(const Families&) const = default;
};

/// The pairs of families that differ from `from` in the yaw family (`of_yaw`) or the surge family.
std::vector<Families> other_families(const Families& from, bool of_yaw);

/// Axes whose family may be changed.
struct OpenAxes {
  bool surge = true;
  bool yaw = false;
  bool has(bool of_yaw) const { return of_yaw ? yaw : surge; }
  bool any() const { return surge || yaw; }
};

/// Fits all families of the open axes roughly (fit_roughly()), starting at the optimum of `first`,
/// and the same families with a delay of the commands or a lag of the motors, because families can
/// compensate for these. Changes one family or adds one of these terms at a time as long as
/// LogFit::relative_error decreases by more than 2 %, at most eight times. Returns the last rough
/// fit if the excess of its relative error above 1 is less than 0.7 times that of the families of
/// `first`, else the rough fit of these families.
FamilyFit likely_families(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                          const FamilyFit& first, const OpenAxes& open);

/// Fits the families of `rough`, starting at its optimum, but without its delay and lag. Searches
/// delays and command errors, and tests the candidate terms of `power_law`.
FamilyFit refine(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                 const FamilyFit& rough);

}  // namespace awmr
