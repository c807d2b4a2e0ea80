/// Interim identification of a recording that is still growing, for `awmr live`.
#pragma once

#include <string>

#include "awmr/trials/recording.h"
#include "commands.h"
#include "live_screen.h"
#include "live_stream.h"

namespace awmr::cli {

/// Records a drive, meanwhile checks and fits the data repeatedly, and at the end identifies the
/// model.
struct LiveCommand {
  IdentifyCommand identify;  ///< options of the identification; execute() sets its logs
  StreamSource source = {};
  std::optional<fs::path> record = {};  ///< file of the recording; default: next to the model
  double every_s = 5.0;                 ///< interval between two updates of the display, > 0
  double budget_s = 5.0;                ///< time limit of an interim fit, > 0
  /// Target precision, > 0: a parameter is known well enough if the half width of its 95 %
  /// interval, divided by the value of the parameter, is at most this. For an exponent or another
  /// parameter that may be 0, the half width is not divided (Precision::half_width).
  double enough = 0.1;
  /// True: the recording ends as soon as every parameter is known well enough (`enough`).
  bool until_enough = false;
  double duration_s = 0.0;  ///< end the recording after this time; 0: no limit
  /// The recording ends after this time without data; 0: no limit.
  double idle_s = 0.0;
};

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
