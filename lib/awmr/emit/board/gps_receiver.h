/// Converts the characters of a GPS port to a checked position and speed.
///
/// Characters are received between the control steps. The work on one sentence is spread over
/// several steps, so that each step takes about the same time:
///   1. Convert the numbers of the sentence.
///   2. Accept or reject the fix.
///   3. Publish position and speed, for the autopilot in this step.
///   4. Compare the displacement since the last fix with the commanded direction of travel.
///   5. Compare this displacement with the measured speed.
///   6. Compare this displacement with the heading.
///   7. Compare the heading with the commanded heading.
/// If the next fix arrives before step 2 of the current fix is done, the current fix is dropped. If
/// it arrives after step 2, the remaining steps of the current fix are done at once. With a long
/// sample time (spreads_work false), one step of the control loop does all of this work.
#pragma once

#include "awmr/emit/board/gps_check.h"

namespace awmr {

/// Position in the autopilot's world frame, m.
struct GpsPlace {
  float x_m, y_m;
};

template <class Limits = GpsLimits>
class GpsReceiver {
 public:
  float x_m = 0.0F;
  float y_m = 0.0F;
  float speed_mps = 0.0F;  ///< speed over ground, without a sign
  uint32_t time_ms = 0;    ///< arrival time of the sentence of the fix, valid once has_fix()

  constexpr explicit GpsReceiver(const Limits& limits = Limits()) : check_(limits) {}

  void begin(uint32_t now_ms) { check_.begin(now_ms); }
  bool has_fix() const { return has_fix_; }
  /// Returns the reason why the GPS must not be used; kSensorGood: the GPS can be used.
  SensorFault fault(uint32_t now_ms) const { return check_.fault(now_ms); }

  /// Reads all characters that have arrived at the port. Call it often enough that the port's
  /// buffer does not overflow, and never during step(). `port` has available() and read(), like
  /// Arduino's Stream.
  template <class Port>
  void receive(Port& port, uint32_t now_ms) {
    while (port.available() > 0) take(static_cast<char>(port.read()), now_ms);
  }

  /// Does the next part of the work on the fix, as listed at the top of this file. Call it once per
  /// control step. `project` converts a GpsFix to a GpsPlace.
  template <class Projection>
  void step(Projection& project, const GpsContext& at) {
    do {
      work(project, at);
    } while (!Limits::spreads_work && due_ != Work::kNone);
  }

 private:
  enum class Work : uint8_t { kNone, kFix, kAccept, kPublish, kMotion };

  RmcReader reader_;
  GpsCheck<Limits> check_;
  RmcNumbers numbers_ = {};  // numbers of the current sentence
  // position of the fix in the world frame, valid from Work::kAccept on
  GpsPlace believed_ = {0.0F, 0.0F};
  GpsFix fix_ = {};  // the fix in GPS coordinates, valid from Work::kAccept on
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
      case Work::kFix:
        fix_ = to_fix(numbers_);
        believed_ = project(fix_);
        due_ = Work::kAccept;
        break;
      case Work::kAccept:
        due_ = check_.accept_fix(fix_, believed_.x_m, believed_.y_m, sentence_ms_, at)
                   ? Work::kPublish
                   : Work::kNone;
        break;
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
    speed_mps = fix_.speed_mps;
    time_ms = sentence_ms_;
    has_fix_ = true;
  }
};

}  // namespace awmr
