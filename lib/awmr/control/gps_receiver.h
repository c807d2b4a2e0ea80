/// A GPS from the characters of its port to a position and a speed that are believed. Freestanding
/// C++14.
///
/// The work on a sentence is spread over the steps, so that none is much longer than another:
///   1. Its characters are read, at most kCharactersPerStep in a step.
///   2. Its numbers are converted, and the fix is believed or not.
///   3. Position and speed are published, for the autopilot to use in this step.
///   4. The displacement is compared with the speed, 5. with the command.
/// Where the next sentence ends before that, a fix of step 2 is left out and the rest is done at once.
#pragma once

#include "awmr/control/gps_check.h"

namespace awmr {

/// Position in the plane of the autopilot.
struct GpsPlace {
  float x_m, y_m;
};

class GpsReceiver {
 public:
  float x_m = 0.0F;
  float y_m = 0.0F;
  float speed_mps = 0.0F;  ///< without a sign
  uint32_t time_ms = 0;    ///< when the sentence of the above came, valid once has_fix()

  /// As GpsCheck::begin().
  void begin(float speed_max_mps, uint32_t timeout_ms, uint32_t now_ms) {
    check_.begin(speed_max_mps, timeout_ms, now_ms);
  }
  bool has_fix() const { return has_fix_; }
  /// Why fixes are not believed; kSensorGood: they are.
  SensorFault fault(uint32_t now_ms) const { return check_.fault(now_ms); }

  /// Once in each step. `port` has available() and read(), as Arduino's Stream; `project` makes a
  /// GpsPlace of a GpsFix.
  template <class Port, class Projection>
  void read(Port& port, Projection& project, const GpsContext& at, uint32_t now_ms) {
    work(project, at);
    for (uint8_t i = 0; port.available() > (i < kCharactersPerStep ? 0 : kCharactersLeft); ++i) {
      take(static_cast<char>(port.read()), now_ms);
    }
  }

 private:
  /// A port of 38,400 baud gives 39 characters in 10 ms, a sentence has 72. Those that are left have
  /// to fit into the port's 64 together with the next 39.
  static constexpr uint8_t kCharactersPerStep = 26;
  static constexpr uint8_t kCharactersLeft = 24;
  enum class Work : uint8_t { kNone, kFix, kPublish, kMotion };

  RmcReader reader_;
  GpsCheck check_;
  RmcNumbers numbers_ = {};           // of the sentence that is worked on
  GpsPlace believed_ = {0.0F, 0.0F};  // not published yet, valid with Work::kPublish
  float believed_mps_ = 0.0F;
  uint32_t sentence_ms_ = 0;
  Work due_ = Work::kNone;
  bool has_fix_ = false;

  void take(char c, uint32_t now_ms) {
    if (!reader_.take(c)) return;
    const GpsSentence kind = reader_.kind();
    if (kind != GpsSentence::kFix) return check_.take_unusable(kind, now_ms);
    if (due_ == Work::kPublish) publish();
    check_.finish_motion();
    numbers_ = reader_.numbers();
    sentence_ms_ = now_ms;
    due_ = Work::kFix;
  }

  template <class Projection>
  void work(Projection& project, const GpsContext& at) {
    switch (due_) {
      case Work::kNone:
        break;
      case Work::kFix: {
        const GpsFix fix = to_fix(numbers_);
        believed_ = project(fix);
        believed_mps_ = fix.speed_mps;
        const bool is_believed =
            check_.accept_fix(fix, believed_.x_m, believed_.y_m, sentence_ms_, at);
        due_ = is_believed ? Work::kPublish : Work::kNone;
        break;
      }
      case Work::kPublish:
        publish();
        due_ = Work::kMotion;
        break;
      case Work::kMotion:
        if (!check_.check_motion()) due_ = Work::kNone;
        break;
    }
  }

  void publish() {
    x_m = believed_.x_m;
    y_m = believed_.y_m;
    speed_mps = believed_mps_;
    time_ms = sentence_ms_;
    has_fix_ = true;
  }
};

}  // namespace awmr
