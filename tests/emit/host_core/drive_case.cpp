// Runs one case of SAFETY.md with a sketch: drives it in the simulated world, injects a failure at
// t = 10 s, and prints the result.
#include <algorithm>

#include "failures.h"
#include "sketch.h"

namespace {

/// Sends the command that starts the drive.
const char* start_command = "S 1.0\n";

/// Commands that are sent after the failure begins, and duration of the drive that follows.
struct Drive {
  const char* commands = "";
  double watch_s = 15;
};
const std::map<std::string, Drive> kDrives = {{"compass-stuck", {"H 90\n"}},
                                              {"gps-speed-zero", {"", 60}},
                                              {"sides-swapped", {"M 0\nH 60\n"}},
                                              {"gyro-reversed", {"H 60\n"}},
                                              {"steering-stuck", {"M 1\nH 120\n", 60}},
                                              {"servo-reversed", {"M 1\nH 90\n", 40}},
                                              {"compass-turning", {"", 40}}};

/// Starts the sketch, leaves it time for its sensors, arms it and runs it for `armed_s`.
void start_and_arm(double armed_s, double start_s = 3) {
  setup();
  world.run(start_s);
  world.say("ARM\n");
  world.run(armed_s);
}

/// Records when the vehicle was first disarmed with its motors off, and the first sensor fault.
/// Call it once per ms.
struct FirstStop {
  double t = 0;
  double stopped_s = -1;  ///< -1: never
  int cause = 0;
  void watch() {
    t += 0.001;
    if (stopped_s < 0 && !safety.is_armed() && !world.is_driven()) stopped_s = t;
    if (cause == 0) cause = awmr_board::sensor_fault(imu, gps);
  }
};

/// Prints name=value pairs. Times in s after the injection, -1: never.
void run_case(const Failure& one) {
  World& w = world;
  const auto found = kDrives.find(one.name);
  const Drive drive = found == kDrives.end() ? Drive() : found->second;
  start_and_arm(0.2);
  w.say(start_command);
  w.run(6.8);
  const bool drove = w.is_driven() && w.u > 0.3;
  one.inject(w);
  w.say(drive.commands);
  double x0 = w.x, y0 = w.y, away = 0, fastest = 0;
  bool drives_again = false;
  FirstStop stop;
  w.run(drive.watch_s, [&] {
    stop.watch();
    fastest = std::max(fastest, fabs(w.u));
    away = std::max(away, hypot(w.x - x0, w.y - y0));
    if (stop.stopped_s >= 0 && (safety.is_armed() || w.is_driven())) drives_again = true;
  });
  const bool is_off = !w.is_driven();
  one.mend(w);
  w.run(25, [&] { drives_again = drives_again || (stop.stopped_s >= 0 && w.is_driven()); });
  if (w.keep.empty()) w.say(frame(10, "ARM"));
  w.say("ARM\n");
  w.run(0.1);
  const bool rearmed = safety.is_armed();
  printf(
      "case=%s drove=%d stopped_s=%.2f off=%d drives_again=%d cause=%d away_m=%.2f "
      "fastest_mps=%.2f rearmed=%d\n",
      one.name, drove, stop.stopped_s, is_off, drives_again, stop.cause, away, fastest, rearmed);
}

/// Arms the vehicle at rest with a commanded speed of 0. It is then pushed by hand at `pushed_mps`,
/// or only its GPS has noise.
void hold_still(double pushed_mps, double noise_mps) {
  World& w = world;
  w.gps_speed_noise = noise_mps;
  start_and_arm(1);
  const double before = w.u = pushed_mps, x0 = w.x, y0 = w.y;
  double fastest = 0, driven_s = 0;
  w.run(60, [&] {
    fastest = std::max(fastest, fabs(w.u));
    if (w.left() + w.right() != 0) driven_s += 0.001;
  });
  printf("pushed_mps=%.2f fastest_mps=%.3f end_mps=%.3f moved_m=%.2f driven_s=%.2f armed=%d\n",
         before, fastest, w.u, hypot(w.x - x0, w.y - y0), driven_s, safety.is_armed());
}

/// Stands on a slope, armed at speed 0, after a drive of 10 s or from rest. Prints the speed that
/// the vehicle reaches in a minute, and for how long the motors drive it in its direction of
/// motion.
void stand_on_slope(double pull, bool drives_first) {
  World& w = world;
  start_and_arm(0.2);
  if (drives_first) {
    w.say("S 0.5\n");
    w.run(10);
    w.say("S 0\n");
  }
  w.slope = pull;
  double fastest = 0, driven_on_s = 0, t = 0;
  w.run(60, [&] {
    t += 0.001;
    fastest = std::max(fastest, fabs(w.u));
    // In the first 5 s, the slope may reverse the motion while the motors still brake the old one.
    if (t > 5 && (w.left() + w.right()) * w.u > 1e-6 && fabs(w.u) > 0.3) driven_on_s += 0.001;
  });
  printf("fastest_mps=%.3f end_mps=%.3f driven_on_s=%.3f armed=%d\n", fastest, w.u, driven_on_s,
         safety.is_armed());
}

/// Drives with a fault from the start: the compass is off by `offset_deg`, or the servo is
/// reversed. Then a heading 90 deg away is commanded.
void drive_wrong(double offset_deg, double servo_sign) {
  World& w = world;
  w.compass_offset = offset_deg / 57.29578;
  w.servo_sign = servo_sign;
  start_and_arm(0.2);
  if (servo_sign < 0) w.say("M 1\n");
  w.say(start_command);
  w.run(5);
  w.say("H 90\n");
  FirstStop stop;
  w.run(60, [&] { stop.watch(); });
  printf("stopped_s=%.2f cause=%d away_m=%.2f\n", stop.stopped_s, stop.cause, hypot(w.x, w.y));
}

/// The vehicle is turned by hand at `rate` until t = 6 s. Prints whether the vehicle could be armed
/// while it turned and at rest, and the heading error at rest.
void start_turning(double rate) {
  World& w = world;
  w.forced_turn = rate;
  start_and_arm(3);
  const bool armed_turning = safety.is_armed();
  w.forced_turn = 0;
  w.run(4);
  w.say("ARM\n");
  w.run(0.1);
  const double error = remainder(imu.psi_rad - w.psi, 2 * 3.14159265358979);
  printf("armed_turning=%d armed_still=%d heading_error_deg=%.2f\n", armed_turning,
         safety.is_armed(), error * 57.29578);
}

/// Arms the vehicle after it was turned by hand `turns` times in one direction.
void turn_often(double turns) {
  World& w = world;
  setup();
  w.run(3);
  w.forced_turn = 3;
  double largest = 0;
  w.run(turns * 2 * 3.14159265358979 / 3,
        [&] { largest = std::max(largest, fabs(static_cast<double>(imu.psi_rad))); });
  w.forced_turn = 0;
  w.run(20);
  w.say("ARM\n");
  w.run(1);
  printf("largest_rad=%.4f armed=%d fault=%d\n", largest, safety.is_armed(), output.fault);
}

/// Drives for `seconds` after start_command(), then holds speed 0 for a minute.
void drive_and_stop(double seconds) {
  World& w = world;
  start_and_arm(0.2);
  w.say(start_command);
  bool was_armed = true;
  double slowest = 0, fastest = 0, ended_s = -1, end_x = 0, end_y = 0, t = 0;
  const auto watch = [&] {
    t += 0.001;
    slowest = std::min(slowest, w.u);
    fastest = std::max(fastest, w.u);
    if (was_armed && !safety.is_armed() && ended_s < 0) ended_s = t;
    was_armed = safety.is_armed();
  };
  w.run(seconds, watch);
  w.say("S 0\n");
  end_x = w.x, end_y = w.y;
  w.run(60, watch);
  printf(
      "slowest_mps=%.3f fastest_mps=%.3f ended_s=%.1f end_mps=%.3f rolled_m=%.2f reason=%d "
      "driven=%d\n",
      slowest, fastest, ended_s, w.u, hypot(w.x - end_x, w.y - end_y),
      static_cast<int>(safety.reason()), w.is_driven());
}

/// Drives forward, then turns by 180 deg in differential mode, in which one side drives backward.
void reverse_a_side() {
  World& w = world;
  start_and_arm(0.2);
  w.say("M 0\n");
  w.say("S 0.3\n");
  w.run(5);
  w.say("H 170\n");
  w.run(5);
  printf("reversals=%d driven_reversals=%d\n", w.reversals, w.driven_reversals);
}

/// Arms, drives, and stops by the last of 14 commands that arrive in one packet on a line that is
/// already full. The GPS sentences are `phase_ms` late.
void fill_the_lines(uint32_t phase_ms) {
  World& w = world;
  w.gps_delay_ms = phase_ms;
  start_and_arm(0.2, 10);  // 10 s, because the calibration at rest takes a fixed number of steps
  const bool was_armed = safety.is_armed();
  w.say("S 0.8\n");
  w.run(20);
  const bool drove = safety.is_armed() && w.u > 0.3;
  w.keep = "KEEP\nKEEP\n", w.keep_period_ms = 1;  // 10 characters per ms; the line takes 11.5
  w.run(3);
  w.keeps = false;
  std::string packet;
  for (int i = 0; i < 13; ++i) packet += "KEEP\n";
  w.say(packet + "STOP\n");
  w.run(0.1);
  printf("armed=%d drove=%d off=%d lost=%d\n", was_armed, drove,
         !safety.is_armed() && !w.is_driven(), Serial.lost + Serial1.lost);
}

}  // namespace

int main(int argc, char** argv) {
  if (is_route(argv[0])) start_command = "G\n";
  const std::string what = argc > 1 ? argv[1] : "list";
  const double number = argc > 2 ? atof(argv[2]) : 0;
  if (what == "list") {
    for (const Failure& one : hazards()) printf("%s\n", one.name);
    return 0;
  }
  if (what == "hold") return hold_still(number, argc > 3 ? atof(argv[3]) : 0.05), 0;
  if (what == "slope") return stand_on_slope(number, argc > 3), 0;
  if (what == "wrong") return drive_wrong(number, argc > 3 ? atof(argv[3]) : 1), 0;
  if (what == "turning") return start_turning(number), 0;
  if (what == "lines") return fill_the_lines(static_cast<uint32_t>(number)), 0;
  if (what == "reverse") return reverse_a_side(), 0;
  if (what == "turns") return turn_often(number), 0;
  if (what == "drive") {
    if (argc > 3) world.mass_factor = atof(argv[3]);
    if (argc > 4) world.gps_delay_ms = static_cast<uint32_t>(atoi(argv[4]));
    if (argc > 5) world.slope = atof(argv[5]);
    return drive_and_stop(number), 0;
  }
  if (argc > 2) world.start_ms = static_cast<uint32_t>(strtoul(argv[2], nullptr, 10));
  if (what == "none") return run_case({"none", [](World&) {}}), 0;
  for (const Failure& one : hazards()) {
    if (one.name == what) return run_case(one), 0;
  }
  return 2;
}
