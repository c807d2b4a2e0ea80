// A drive with failures, step by step: sensor checks, commands, arming and complete autopilot steps
// from random raw readings. Chip and host must give the same bits: safety_chip_test.cpp.
#pragma once

#include "awmr.h"
#include "awmr/control/flash.h"
#include "awmr/emit/board/arming.h"
#include "awmr/emit/board/command_line.h"
#include "awmr/emit/board/gps_receiver.h"
#include "awmr/emit/board/heading_check.h"

namespace safety_sequence {

const uint16_t kSteps = 1600;
// Timer ticks per control step of 10 ms, and characters that a port of 38,400 baud receives per
// tick.
const uint8_t kTicksPerStep = 4;
const uint8_t kCharactersPerTick = 10;

struct Limits {
  static constexpr float speed_max_mps = AWMR_SPEED_MAX_MPS;
  static constexpr float on_course_rad = AWMR_ON_COURSE_RAD;
  static constexpr float off_course_mrad = AWMR_OFF_COURSE_MRAD;
  static constexpr uint32_t timeout_ms = AWMR_SPEED_TIMEOUT_MS;
  static constexpr bool spreads_work = true;
};

struct Sequence {
  awmr::HeadingCheck heading;
  awmr::GpsReceiver<Limits> gps;
  awmr::CommandReader commands;
  awmr::Arming arming;
  awmr_input input;
  awmr_output output;
  uint32_t seed, now_ms, utc_ms, hash;
  int16_t word;
  int16_t field[3];
  char sentence[80];
  uint8_t arrived, taken;  // characters that arrived at the port, and that were read from it
  uint8_t causes[awmr::kSensorFaultCount];  // steps with each sensor fault, at most 255
  uint8_t disarmed;                         // how often the vehicle was disarmed
};

inline uint32_t draw(Sequence& s) {
  s.seed = s.seed * 1664525UL + 1013904223UL;
  return s.seed >> 16;
}
inline void put(Sequence& s, float value) { s.hash = (s.hash ^ awmr::bits_of(value)) * 16777619UL; }

inline void begin(Sequence& s) {
  s = Sequence();
  s.seed = 1;
  s.hash = 2166136261UL;
  s.now_ms = 0xFFFFE000UL;  // the clock wraps during the drive
  s.utc_ms = 43200000UL;
  s.heading.begin(s.now_ms);
  s.heading.turn.begin(2.6e-4F, 0.01F);
  s.gps.begin(s.now_ms);
  s.input.mode = AWMR_COMBINED;
  s.input.speed_unsigned = 1;
}

// True while the failure `which` (0 to 5) acts: in the first 120 steps of its own block of 200
// steps, blocks 2 to 7.
inline bool fails(uint16_t step, uint8_t which) {
  return step >= 400 && step % 200 < 120 && step / 200 == static_cast<uint16_t>(which + 2);
}

inline void sense(Sequence& s, uint16_t step) {
  s.heading.take_gyro(s.word, s.now_ms);
  s.heading.take_range(!fails(step, 1));
  s.heading.calibration.take(s.word, 2.6e-4F, true, 0.0F);
  if (!fails(step, 2)) {
    s.heading.take_field(s.field[0], s.field[1], s.field[2], s.now_ms);
  }
  s.heading.turn.take(s.word, s.output.tau_turn_m);
  s.heading.step.take(fails(step, 3) && step % 200 < 30 ? 0.5F : 0.01F, 0.01F);
}

// Returns a character of a text. On the chip the texts are in flash, to leave the RAM to the
// firmware.
inline char character(const char* place) {
#ifdef __AVR__
  return static_cast<char>(pgm_read_byte(place));
#else
  return *place;
#endif
}
inline char digit(int value) {
  return static_cast<char>(value < 10 ? '0' + value : 'A' + value - 10);
}

// Puts a GPS sentence with time, position and checksum on the line.
inline void say_fix(Sequence& s, uint16_t step) {
  static const char kPattern[] AWMR_IN_FLASH =
      "$GPRMC,120000.00,A,4806.0000000,N,01130.0000000,E,1.900,,230394,,,A*";
  char* text = s.sentence;
  for (uint8_t i = 0; i < sizeof kPattern; ++i) text[i] = character(kPattern + i);
  const uint32_t ticks = s.utc_ms / 10 % 6000;
  text[11] = static_cast<char>('0' + ticks / 1000);
  text[12] = static_cast<char>('0' + ticks / 100 % 10);
  text[14] = static_cast<char>('0' + ticks / 10 % 10);
  const uint32_t place =
      static_cast<uint32_t>(step) * 55 + draw(s) % 100 + (fails(step, 4) ? 200000 : 0);
  uint32_t rest = place;
  for (uint8_t i = 30; i > 23; --i, rest /= 10) text[i] = static_cast<char>('0' + rest % 10);
  uint8_t sum = 0;
  uint8_t end = 1;
  for (; text[end] != '*'; ++end) sum = static_cast<uint8_t>(sum ^ static_cast<uint8_t>(text[end]));
  text[++end] = digit(sum >> 4);
  text[++end] = digit(sum & 15);
  text[++end] = '\n';
  text[++end] = '\0';
}

struct Port {
  Sequence& s;
  int available() const { return s.arrived - s.taken; }
  int read() { return s.sentence[s.taken++]; }
};

// A tick of the timer: reads the characters that have arrived since the last one.
inline void receive(Sequence& s) {
  for (uint8_t i = 0; i < kCharactersPerTick && s.sentence[s.arrived] != '\0'; ++i) ++s.arrived;
  Port port = {s};
  s.gps.receive(port, s.now_ms);
}

// Draws the sensor readings of this step, and executes the timer ticks since the last step.
inline void prepare(Sequence& s, uint16_t step) {
  if (!fails(step, 0)) s.word = static_cast<int16_t>(static_cast<int16_t>(draw(s) % 21) - 10);
  for (uint8_t i = 0; i < 3; ++i) s.field[i] = static_cast<int16_t>(i * 100 + draw(s) % 9);
  if (step % 20 == 0) {
    s.arrived = s.taken = 0;
    if (!fails(step, 5)) s.utc_ms = 43200000UL + 10UL * step;  // else the UTC repeats
    say_fix(s, step);
  }
  for (uint8_t tick = 0; tick < kTicksPerStep; ++tick) receive(s);
}

struct Projection {
  awmr::GpsPlace operator()(const awmr::GpsFix& fix) const {
    return {static_cast<float>(fix.lat_e7 - 481000000L) * 0.0111319491F,
            static_cast<float>(115000000L - fix.lon_e7) * 0.0074342F};
  }
};

inline void read_gps(Sequence& s) {
  const awmr::GpsContext at = {0.0F, s.output.psi_ref_rad, 1, s.arming.is_armed()};
  Projection projection;
  s.gps.step(projection, at);
  s.input.position_is_fix = 1;
  s.input.fix_ms = s.gps.time_ms - 200;
  s.input.x_m = s.gps.x_m;
  s.input.y_m = s.gps.y_m;
  s.input.u_mps = s.gps.speed_mps;
  s.input.speed_ms = s.gps.has_fix() ? s.gps.time_ms : s.now_ms - AWMR_SPEED_TIMEOUT_MS - 1;
}

inline void listen(Sequence& s, uint16_t step) {
  static const char kArm[] AWMR_IN_FLASH = "ARM\n";
  static const char kKeep[] AWMR_IN_FLASH = "KEEP\n";
  static const char kSpeed[] AWMR_IN_FLASH = "....S 1\n";
  const char* text = step % 200 == 150   ? kArm
                     : step % 20 == 0    ? kKeep
                     : step % 200 == 199 ? kSpeed
                                         : 0;
  for (const char* c = text; c != 0 && character(c) != '\0'; ++c) {
    if (s.commands.take(character(c)) != awmr::CommandVerdict::kTaken) continue;
    s.input.command_ms = s.now_ms;
    if (s.commands.word == awmr::CommandWord::kArm) s.arming.arm(s.output.fault, 0);
  }
}

inline void step(Sequence& s, uint16_t number) {
  s.now_ms += 10;
  read_gps(s);
  sense(s, number);
  listen(s, number);
  awmr::SensorFault cause = s.heading.fault(s.now_ms);
  if (cause == awmr::kSensorGood) {
    s.input.heading_ms = s.now_ms;
    cause = s.gps.fault(s.now_ms);
  }
  s.input.now_ms = s.now_ms;
  s.input.r_radps = 2.6e-4F * static_cast<float>(s.word);
  s.input.u_ref_mps = s.arming.is_armed() ? 1.0F : 0.0F;
  if (!s.arming.is_armed()) s.input.command_ms = s.now_ms - AWMR_COMMAND_TIMEOUT_MS - 1;
}

inline void finish(Sequence& s) {
  awmr::SensorFault cause = s.heading.fault(s.now_ms);
  if (cause == awmr::kSensorGood) cause = s.gps.fault(s.now_ms);
  if (s.causes[cause] < 255) ++s.causes[cause];
  if (s.arming.observe(s.output.fault, cause)) ++s.disarmed;
  put(s, s.output.force_left);
  put(s, s.output.force_right);
  put(s, s.output.steering_rad);
  put(s, static_cast<float>(s.output.fault * 16 + cause));
}

}  // namespace safety_sequence
