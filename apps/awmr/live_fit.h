/// Interim identification of a recording that is still growing, for `awmr live`.
#pragma once

#include <string>

#include "awmr/trials/recording.h"
#include "commands.h"
#include "live_screen.h"

namespace awmr::cli {

/// Describes the manoeuvre that would improve the model most; empty if there is no recommendation.
std::string next_manoeuvre(const Model& model);

/// True if the update has a model and no faults, and the half width of each requested parameter's
/// interval is at most LiveUpdate::enough.
bool has_enough(const LiveUpdate& update);

/// Checks and fits the rows recorded so far as `identify` does, but within LiveCommand::budget_s.
class LiveFit {
 public:
  LiveFit(const LiveCommand& command, Vehicle vehicle);

  /// Returns the interim result. Before that, writes the recording to its file, so that it remains
  /// if the program is killed.
  LiveUpdate update(const Recording& recording) const;

 private:
  void fit(LiveUpdate& update) const;

  Vehicle vehicle_;
  TrialFiles files_;
  IdentifyOptions options_;
  double enough_;
};

}  // namespace awmr::cli
