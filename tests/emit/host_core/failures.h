// Failures of sensors, actuators, wiring and operator, as changes of the simulated world.
#pragma once
#include <awmr/control/crc.h>

#include "world.h"

struct Failure {
  const char* name;
  std::function<void(World&)> inject;
  std::function<void(World&)> mend = [](World&) {};
};

/// Wraps `text` as a framed command: "#SEQUENCE TEXT*CRC".
inline std::string frame(int sequence, const std::string& text) {
  const std::string body = std::to_string(sequence & 255) + " " + text;
  const unsigned crc = awmr::crc16_of(reinterpret_cast<const uint8_t*>(body.data()), body.size());
  char line[64];
  snprintf(line, sizeof line, "#%s*%04X\n", body.c_str(), crc);
  return line;
}

/// True during the last fraction `share` of each period, for failures that come in bursts.
inline bool is_in_burst(const World& w, uint32_t period_ms, double share) {
  return w.elapsed_ms % period_ms >= (1 - share) * period_ms;
}

/// Failures that the table of hazards in SAFETY.md lists.
inline const std::vector<Failure>& hazards() {
  static const std::vector<Failure> all = {
      {"compass-silent", [](World& w) { w.compass_answers = false; },
       [](World& w) { w.compass_answers = true; }},
      {"compass-frozen", [](World& w) { w.compass_frozen = true; },
       [](World& w) { w.compass_frozen = false; }},
      {"compass-jump", [](World& w) { w.compass_offset = 1.0; },
       [](World& w) { w.compass_offset = 0; }},
      {"compass-stuck", [](World& w) { w.compass_stuck = true, w.stuck_psi = w.psi; },
       [](World& w) { w.compass_stuck = false; }},
      {"gyro-silent", [](World& w) { w.gyro_answers = false; },
       [](World& w) { w.gyro_answers = true; }},
      {"gyro-frozen", [](World& w) { w.gyro_frozen = true; },
       [](World& w) { w.gyro_frozen = false; }},
      {"gyro-range", [](World& w) { w.gyro_gain = 2, w.registers[0x681B] = 0; },
       [](World& w) { w.gyro_gain = 1, w.registers[0x681B] = 8; }},
      {"gyro-drift", [](World& w) { w.gyro_bias += 0.15; }, [](World& w) { w.gyro_bias -= 0.15; }},
      {"gps-silent", [](World& w) { w.gps_answers = false; },
       [](World& w) { w.gps_answers = true; }},
      {"gps-no-fix", [](World& w) { w.gps_void = true; }, [](World& w) { w.gps_void = false; }},
      {"gps-empty", [](World& w) { w.gps_empty = true; }, [](World& w) { w.gps_empty = false; }},
      {"gps-damaged", [](World& w) { w.gps_bad_sum = true; },
       [](World& w) { w.gps_bad_sum = false; }},
      {"gps-repeated", [](World& w) { w.gps_repeats = true; },
       [](World& w) { w.gps_repeats = false; }},
      {"gps-late", [](World& w) { w.gps_delay_ms = 2000; },
       [](World& w) { w.gps_delay_ms = 0, w.on_the_way.clear(); }},
      {"gps-jump", [](World& w) { w.gps_jump_m = 20; }, [](World& w) { w.gps_jump_m = 0; }},
      {"gps-position-frozen",
       [](World& w) { w.gps_still = true, w.still_x = w.x, w.still_y = w.y; },
       [](World& w) { w.gps_still = false; }},
      {"gps-speed-zero", [](World& w) { w.gps_speed_gain = 0, w.gps_speed_noise = 0; },
       [](World& w) { w.gps_speed_gain = 1, w.gps_speed_noise = 0.05; }},
      {"motors-reversed", [](World& w) { w.motor_sign = -1; }, [](World& w) { w.motor_sign = 1; }},
      {"sides-swapped", [](World& w) { w.sides_swapped = true; },
       [](World& w) { w.sides_swapped = false; }},
      {"gyro-reversed", [](World& w) { w.gyro_gain = -1; }, [](World& w) { w.gyro_gain = 1; }},
      {"steering-stuck", [](World& w) { w.servo_stuck = 0; },
       [](World& w) { w.servo_stuck = NAN; }},
      {"servo-reversed", [](World& w) { w.servo_sign = -1; }, [](World& w) { w.servo_sign = 1; }},
      {"compass-turning", [](World& w) { w.compass_rate = 0.0436; },
       [](World& w) { w.compass_rate = w.compass_offset = 0; }},
      {"command-silence", [](World& w) { w.keeps = false; }, [](World& w) { w.keeps = true; }},
      {"command-noise", [](World& w) { w.keep = "x"; },
       [](World& w) { w.say("\n"), w.keep = "KEEP\n"; }},
      {"command-unknown", [](World& w) { w.keep = "STEP 1\n"; },
       [](World& w) { w.keep = "KEEP\n"; }},
      {"command-repeated-frame", [](World& w) { w.keep = frame(9, "KEEP"); },
       [](World& w) { w.keep = "", w.keeps = false; }},
      {"stop", [](World& w) { w.say("STOP\n"); }},
      {"stop-in-noise", [](World& w) { w.say("\xff....stop"); }, [](World& w) { w.say("\n"); }},
  };
  return all;
}

/// Further failures of sensors, actuators and operator that begin during the drive.
inline const std::vector<Failure>& further_failures() {
  static const std::vector<Failure> all = {
      {"left-motor-dead", [](World& w) { w.left_gain = 0; }},
      {"servo-stuck-turned", [](World& w) { w.servo_stuck = 0.2; }},
      {"gps-speed-half", [](World& w) { w.gps_speed_gain = 0.5; }},
      {"gps-speed-double", [](World& w) { w.gps_speed_gain = 2; }},
      {"gps-speed-stuck", [](World& w) { w.gps_speed_stuck = 0.3; }},
      {"gps-utc-back", [](World& w) { w.utc_s -= 3600; }},
      {"gps-once-a-second", [](World& w) { w.gps_period_ms = 1000; }},
      {"compass-hard-iron", [](World& w) { w.hard_iron = 300; }},
      {"command-storm", [](World& w) { w.keep_period_ms = 1, w.keep = "\xff\x01S 3"; }},
      {"left-motor-half", [](World& w) { w.left_gain = 0.5; }},
      {"left-motor-double", [](World& w) { w.left_gain = 2; }},
      {"left-motor-stuck", [](World& w) { w.left_stuck = w.left_force; }},
      {"motors-half", [](World& w) { w.left_gain = w.right_gain = 0.5; }},
      {"servo-stuck-as-it-is", [](World& w) { w.servo_stuck = w.servo_rad; }},
      {"imu-bursts",
       [](World& w) {
         w.each_ms = [](World& v) {
           v.compass_answers = !is_in_burst(v, 4000, 0.1);
           v.gyro_answers = !is_in_burst(v, 700, 0.1);
         };
       }},
      {"gps-bursts",
       [](World& w) { w.each_ms = [](World& v) { v.gps_answers = !is_in_burst(v, 4000, 0.1); }; }},
      {"compass-creeping", [](World& w) { w.compass_rate = 0.0035; }},
      {"gps-frozen",
       [](World& w) {
         w.gps_still = true, w.still_x = w.x, w.still_y = w.y, w.gps_speed_stuck = fabs(w.u);
       }},
      {"gps-speed-held", [](World& w) { w.gps_speed_stuck = fabs(w.u); }},
      {"gps-speed-held-to-stop", [](World& w) { w.gps_speed_stuck = fabs(w.u), w.say("S 0\n"); }},
      {"gps-west-frozen", [](World& w) { w.gps_west_still = true, w.still_y = w.y; }},
      {"command-in-noise",
       [](World& w) {
         w.keeps = false;
         w.each_ms = [](World& v) {
           if (v.elapsed_ms % 300 == 0) v.say("\xff\x80K\n");
         };
       }},
      {"command-old-frames",
       [](World& w) {
         w.keeps = false;
         w.each_ms = [](World& v) {
           if (v.elapsed_ms % 300 == 0) v.say(frame(++v.sequence % 20, "KEEP"));
         };
       }},
      {"operators-two",
       [](World& w) {
         w.keeps = false;
         w.sequence = 100;
         w.each_ms = [](World& v) {
           if (v.elapsed_ms % 300 == 0) v.say(frame(v.sequence - 100, "KEEP"));
           if (v.elapsed_ms % 300 == 150) v.say(frame(++v.sequence, "KEEP"));
         };
       }},
  };
  return all;
}

/// Wrong wiring, mounting and calibration: from the start on.
inline const std::vector<Failure>& wrong_wirings() {
  constexpr double kPi = 3.14159265358979;
  static const std::vector<Failure> all = {
      {"motors-reversed", [](World& w) { w.motor_sign = -1; }},
      {"sides-swapped", [](World& w) { w.sides_swapped = true; }},
      {"servo-reversed", [](World& w) { w.servo_sign = -1; }},
      {"moments-reversed", [](World& w) { w.servo_sign = -1, w.sides_swapped = true; }},
      {"gyro-reversed", [](World& w) { w.gyro_gain = -1; }},
      {"gyro-reversed-sides-swapped", [](World& w) { w.gyro_gain = -1, w.sides_swapped = true; }},
      {"gyro-reversed-servo-reversed", [](World& w) { w.gyro_gain = -1, w.servo_sign = -1; }},
      {"gyro-reversed-moments-reversed",
       [](World& w) { w.gyro_gain = -1, w.servo_sign = -1, w.sides_swapped = true; }},
      {"imu-upside-down", [](World& w) { w.gyro_gain = -1, w.compass_left_sign = -1; }},
      {"gyro-half", [](World& w) { w.gyro_gain = 0.5; }},
      {"gyro-double", [](World& w) { w.gyro_gain = 2; }},
      {"gyro-times-57", [](World& w) { w.gyro_gain = 57.3; }},
      {"gyro-over-57", [](World& w) { w.gyro_gain = 1 / 57.3; }},
      {"gyro-other-axis", [](World& w) { w.gyro_gain = 0; }},
      {"gps-frozen-at-rest",
       [](World& w) {
         w.gps_still = true, w.still_x = w.x, w.still_y = w.y, w.gps_speed_stuck = 0;
       }},
      {"compass-mirrored", [](World& w) { w.compass_left_sign = -1; }},
      {"compass-mirrored-ahead", [](World& w) { w.compass_ahead_sign = -1; }},
      {"compass-axes-swapped", [](World& w) { w.compass_axes_swapped = true; }},
      {"compass-off-45", [](World& w) { w.compass_offset = 0.25 * kPi; }},
      {"compass-off-90", [](World& w) { w.compass_offset = 0.5 * kPi; }},
  };
  return all;
}
