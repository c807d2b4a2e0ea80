// Injects failures of the operator's line: generates its characters and reads them as the sketches
// do (control/command_line.h).
#pragma once

#include <cstdint>
#include <string>

#include "awmr/control/arming.h"
#include "awmr/control/command_line.h"
#include "awmr/control/safety.h"
#include "pil_options.h"

namespace awmr::pil {

/// Simulated operator of one run, who sends KEEP every 0.3 s until the line fails.
class CheckedCommands {
 public:
  explicit CheckedCommands(cli::Injection injection) : injection_(injection) {}

  /// Executes one step: stores the time of the last complete command in `times`, and disarms at
  /// STOP. `fails`: true while the line fails.
  void step(bool fails, Arming& arming, InputTimes& times);

 private:
  cli::Injection injection_;
  CommandReader reader_;
  std::uint32_t sent_ms_ = 0, heard_ms_ = 0;
  bool has_sent_ = false, has_stopped_ = false;

  std::string sent(bool fails, std::uint32_t now_ms);
};

}  // namespace awmr::pil
