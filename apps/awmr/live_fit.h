/// What a recording says so far, while it still grows.
#pragma once

#include <string>

#include "awmr/trials/load.h"
#include "awmr/trials/recording.h"
#include "commands.h"
#include "live_screen.h"

namespace awmr::cli {

/// The manoeuvre that would help most, in words; none where nothing can be said.
std::string next_manoeuvre(const Model& model);

/// Every parameter asked for is known well enough.
bool has_enough(const LiveUpdate& update);

/// The recording so far, checked and fitted within the budget: what `identify` would make of it.
class LiveFit {
 public:
  LiveFit(const LiveCommand& command, Vehicle vehicle);

  /// Writes the recording first: whatever ends this program, the file stays.
  LiveUpdate update(const Recording& recording) const;

 private:
  void fit(LiveUpdate& update) const;

  TrialFiles files_;
  IdentifyOptions options_;
  double enough_;
};

}  // namespace awmr::cli
