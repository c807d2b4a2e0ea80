#include "command_injection.h"

#include <fmt/format.h>

#include "awmr/control/crc.h"

namespace awmr::pil {
namespace {

using cli::Injection;

constexpr std::uint32_t kPeriod_ms = 300;  ///< time between two commands of the operator

std::string frame(unsigned sequence, const std::string& text) {
  const std::string body = fmt::format("{} {}", sequence, text);
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(body.data());
  return fmt::format("#{}*{:04X}\n", body, crc16_of(bytes, body.size()));
}

/// Returns the characters that replace the operator's KEEP on a line with this failure; may be
/// empty.
std::string failed_line(Injection injection) {
  switch (injection) {
    case Injection::kCommandNoise:
      return "x";
    case Injection::kCommandUnknown:
      return "STEP 1\n";
    case Injection::kCommandRepeatedFrame:
      return frame(9, "KEEP");
    default:
      return "";
  }
}

}  // namespace

void CheckedCommands::step(bool fails, Arming& arming, InputTimes& times) {
  for (const char c : sent(fails, times.now_ms)) {
    if (reader_.take(c) != CommandVerdict::kTaken) continue;
    heard_ms_ = times.now_ms;
    if (reader_.word == CommandWord::kStop) arming.disarm(DisarmReason::kStop);
  }
  times.command_ms = heard_ms_;
}

std::string CheckedCommands::sent(bool fails, std::uint32_t now_ms) {
  if (fails && !has_stopped_) {
    has_stopped_ = true;
    if (injection_ == Injection::kStop) return "STOP\n";
    if (injection_ == Injection::kStopInNoise) return "\xFF....stop";
  }
  if (has_sent_ && now_ms - sent_ms_ < kPeriod_ms) return "";
  has_sent_ = true;
  sent_ms_ = now_ms;
  const bool is_stop = injection_ == Injection::kStop || injection_ == Injection::kStopInNoise;
  return fails && !is_stop ? failed_line(injection_) : "KEEP\n";
}

}  // namespace awmr::pil
