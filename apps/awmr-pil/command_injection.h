// Injects failures of the operator's line: generates the characters that arrive at the vehicle, and
// reads them with the code of the emitted sketches (emit/board/command_line.h).
#pragma once

#include <cstdint>
#include <string>

#include "awmr/control/safety.h"
#include "awmr/emit/board/arming.h"
#include "awmr/emit/board/command_line.h"
#include "pil_options.h"

namespace awmr::pil {

/// Simulated operator of one run, who sends the command KEEP every 0.3 s. When the failure begins,
/// other characters or none replace KEEP. With the injection STOP, one STOP arrives and the KEEP
/// commands continue.
class CheckedCommands {
 public:
  explicit CheckedCommands(cli::Injection injection) : injection_(injection) {}

  /// Executes one control step: reads the characters that arrive at times.now_ms, stores the time
  /// of the last accepted command in times.command_ms, and disarms at STOP. `fails`: the injected
  /// failure has begun.
  void step(bool fails, Arming& arming, InputTimes& times);

 private:
  cli::Injection injection_;
  CommandReader reader_;
  std::uint32_t sent_ms_ = 0, heard_ms_ = 0;
  bool has_sent_ = false, has_stopped_ = false;

  std::string sent(bool fails, std::uint32_t now_ms);
};

}  // namespace awmr::pil
