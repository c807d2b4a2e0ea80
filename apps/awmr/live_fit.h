/// Interim identification of a growing recording.
#pragma once

#include <string>

#include "awmr/trials/load.h"
#include "awmr/trials/recording.h"
#include "commands.h"
#include "live_screen.h"

namespace awmr::cli {

/// Describes the manoeuvre that would help most; empty if there is no recommendation.
std::string next_manoeuvre(const Model& model);

/// True if every requested parameter is known precisely enough.
bool has_enough(const LiveUpdate& update);

/// Checks and fits the recording so far as `identify` does, but within the time budget.
class LiveFit {
 public:
  LiveFit(const LiveCommand& command, Vehicle vehicle);

  /// Writes the recording first, so that the file remains if the program is killed.
  LiveUpdate update(const Recording& recording) const;

 private:
  void fit(LiveUpdate& update) const;

  TrialFiles files_;
  IdentifyOptions options_;
  double enough_;
};

}  // namespace awmr::cli
