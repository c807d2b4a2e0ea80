// Runs failures and healthy drives for scripts/fault_matrix: each in a simulated world, until the
// vehicle is disarmed or for kWatch_s. Prints name=value pairs, one drive a line.
//
// usage: PROGRAM MODE SPEED SERVO_LAG MOTOR_LAG [NAME]...  every failure, or those named, in mode
//                                                          MODE at SPEED m/s
//        PROGRAM MODE SPEED SERVO_LAG MOTOR_LAG healthy SEED WANDER
//        a healthy drive whose GPS positions wander by up to WANDER m RMS, correlated over a minute
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>

#include "failures.h"
#include "sketch.h"

namespace {

constexpr double kPi = 3.14159265358979;
constexpr double kWatch_s = 300;
// At rest until the gyroscope's 100 samples are taken and the GPS has a fix.
constexpr double kStart_s = 2 + 120.0 * AWMR_SAMPLE_TIME_S;
bool follows_route = false;

struct Setting {
  int mode;
  double speed_mps, servo_lag_s, motor_lag_s;
};

/// Times at which a failure begins.
enum class Time {
  kWiring,   ///< before the start
  kStart,    ///< 1 s after the command to drive
  kSteady,   ///< 12 s after the command to drive
  kTurning,  ///< when the vehicle then turns faster than kTurning_radps, or after 100 s
};
constexpr double kTurning_radps = 0.05;
constexpr const char* kTimeNames[] = {"wiring", "start", "steady", "turning"};

/// Records a drive once per ms, from the failure on until the vehicle is at rest.
struct Record {
  double t = 0, path_m = 0, away_m = 0, fastest_mps = 0;
  double stopped_s = -1;  ///< when the motors went off; -1: never
  int cause = 0, fault = 0;
  double x0 = world.x, y0 = world.y;
  bool is_over() const { return stopped_s >= 0 && (fabs(world.u) < 0.01 || t > stopped_s + 30); }
  void watch() {
    const World& w = world;
    t += 0.001;
    if (cause == 0) cause = awmr_board::sensor_fault(imu, gps);
    path_m += 0.001 * fabs(w.u);
    fastest_mps = std::max(fastest_mps, fabs(w.u));
    away_m = std::max(away_m, hypot(w.x - x0, w.y - y0));
    if (stopped_s < 0 && !safety.is_armed()) stopped_s = t, fault = output.fault;
  }
};

double wrapped_deg(double rad) { return remainder(rad, 2 * kPi) * 57.29578; }

std::string text_of(const char* format, double a) {
  char text[64];
  snprintf(text, sizeof text, format, a);
  return text;
}

/// Sends a command: the first one as plain text, later ones as frames.
void command(const std::string& text) {
  world.say(world.sequence > 0 ? frame(world.sequence += 2, text) : text + "\n");
}

/// Starts the sketch at rest and arms it. Returns true if it is armed.
bool start_and_arm() {
  setup();
  world.run(kStart_s);
  world.say("ARM\n");
  world.run(0.2);
  return safety.is_armed();
}

/// Commands a heading 90 deg to the left, and returns it.
double turn_left() {
  const double goal = remainder(imu.psi_rad + 0.5 * kPi, 2 * kPi);
  if (!follows_route) command(text_of("H %.1f", goal * 57.29578));
  return goal;
}

void wait_until_turning() {
  for (int i = 0; i < 100000 && fabs(world.r) < kTurning_radps; ++i) world.run(0.001);
}

/// Arms and drives, through a turn by 90 deg or along the route, with the failure from `when` on.
void run_failure(const Failure& one, Time when, const Setting& setting) {
  World& w = world;
  w.servo_lag_s = setting.servo_lag_s;
  w.motor_lag_s = setting.motor_lag_s;
  if (when == Time::kWiring) one.inject(w);
  const bool was_armed = start_and_arm();
  w.say(follows_route ? "G\n"
                      : text_of("M %.0f\n", setting.mode) + text_of("S %.3f\n", setting.speed_mps));
  if (when != Time::kWiring) w.run(when == Time::kStart ? 1 : 12);
  double goal = 0;
  if (when == Time::kTurning) {
    goal = turn_left();
    wait_until_turning();
  }
  Record record;
  const auto watch_for = [&](double seconds) {
    for (int i = 0; i < static_cast<int>(1000 * seconds); ++i) {
      if (record.is_over()) return;
      w.run(0.001, [&] { record.watch(); });
    }
  };
  if (when != Time::kWiring) one.inject(w);
  watch_for(3);
  if (when != Time::kTurning) goal = turn_left();
  // The route is 90 m long, at a third of the speed.
  watch_for((follows_route ? std::max(kWatch_s, 300 / setting.speed_mps) : kWatch_s) - 30);
  // Speed and track of the last half minute, compared with the wanted direction.
  const double x1 = w.x, y1 = w.y, wanted = follows_route ? output.psi_ref_rad : goal;
  const double before_m = record.path_m;
  watch_for(30);
  const double error_deg = fabs(wrapped_deg(atan2(w.y - y1, w.x - x1) - wanted));
  printf(
      "case=%s at=%s armed=%d stopped_s=%.2f cause=%d fault=%d path_m=%.2f away_m=%.2f "
      "fastest_mps=%.2f arrived=%d error_deg=%.0f end_share=%.2f\n",
      one.name, kTimeNames[static_cast<int>(when)], was_armed, record.stopped_s, record.cause,
      record.fault, record.path_m, record.away_m, record.fastest_mps,
      safety.reason() == awmr::DisarmReason::kArrived || output.arrived, error_deg,
      (record.path_m - before_m) / (30 * setting.speed_mps));
}

using Uniform = std::function<double(double, double)>;

/// Draws a healthy vehicle and sensors that differ from the model at random.
void draw_world(World& w, const Setting& setting, double wander_m, const Uniform& uniform) {
  w.psi = uniform(-kPi, kPi);
  w.mass_factor = uniform(0.7, 1.4);
  w.drag_factor = uniform(0.7, 1.4);
  w.left_gain = uniform(0.92, 1.08);
  w.right_gain = uniform(0.92, 1.08);
  w.servo_offset = uniform(-0.035, 0.035);
  w.servo_lag_s = setting.servo_lag_s * uniform(0.7, 1.5);
  w.motor_lag_s = setting.motor_lag_s * uniform(0.7, 1.5);
  w.gyro_bias = uniform(-0.05, 0.05);
  w.gyro_gain = uniform(0.97, 1.03);
  w.compass_offset = uniform(-0.15, 0.15);
  w.compass_distortion = uniform(-0.07, 0.07);
  w.compass_noise = uniform(1, 5);
  w.gps_noise_m = uniform(0.02, 0.15);
  w.gps_wander_m = uniform(0, wander_m);
  w.gps_speed_noise = uniform(0.01, 0.1);
  w.gps_delay_ms = static_cast<uint32_t>(uniform(50, 350));
}

/// Runs a healthy drive of two minutes with a vehicle and sensors that differ from the model.
void run_healthy(int seed, double wander_m, Setting setting) {
  World& w = world;
  w.random.seed(static_cast<unsigned>(seed));
  const Uniform uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(w.random);
  };
  draw_world(w, setting, wander_m, uniform);
  const bool is_steered = setting.mode == 2;
  const double drift = uniform(-0.006, 0.006);  // rad/s a minute
  const bool was_armed = start_and_arm();
  Record record;
  const auto each = [&] {
    record.watch();
    w.gyro_bias += drift / 60000;
  };
  if (follows_route) {
    w.say("G\n");
    w.run(120, each);
  }
  while (!follows_route && record.t < 120) {
    if (is_steered && uniform(0, 1) < 0.3) {
      setting.mode = static_cast<int>(uniform(0, 2.999));
      w.say(text_of("M %.0f\n", setting.mode));
    }
    const double chance = uniform(0, 1), speed_mps = uniform(0.25, 1) * setting.speed_mps;
    // Not in steering mode, because steering alone cannot turn a vehicle that drives backward.
    const bool is_backward = chance < 0.2 && setting.mode != 1;
    w.say(text_of("S %.3f\n", chance < 0.1 ? 0.0 : is_backward ? -speed_mps : speed_mps));
    if (uniform(0, 1) < 0.8) w.say(text_of("H %.1f\n", uniform(-180, 180)));
    w.run(uniform(2, 30), each);
  }
  const bool arrived = safety.reason() == awmr::DisarmReason::kArrived;
  printf("case=healthy seed=%d armed=%d stopped_s=%.2f cause=%d fault=%d path_m=%.2f arrived=%d\n",
         seed, was_armed, arrived ? -1.0 : record.stopped_s, arrived ? 0 : record.cause,
         arrived ? 0 : record.fault, record.path_m, arrived);
}

/// Runs a failure in a process of its own: the sketch's state is global.
void run_apart(const Failure& one, Time when, const Setting& setting) {
  fflush(stdout);
  const pid_t child = fork();
  if (child == 0) {
    run_failure(one, when, setting);
    fflush(stdout);
    _exit(0);
  }
  int status = 0;
  if (child < 0 || waitpid(child, &status, 0) != child || status != 0) {
    printf("case=%s at=%s crashed=1\n", one.name, kTimeNames[static_cast<int>(when)]);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 5) return 2;
  follows_route = is_route(argv[0]);
  const Setting setting = {atoi(argv[1]), atof(argv[2]), atof(argv[3]), atof(argv[4])};
  const std::vector<std::string> names(argv + 5, argv + argc);
  if (names.size() == 3 && names[0] == "healthy") {
    run_healthy(std::stoi(names[1]), std::stod(names[2]), setting);
    return 0;
  }
  const auto run = [&](const std::vector<Failure>& failures, std::initializer_list<Time> times) {
    for (const Failure& one : failures) {
      if (!names.empty() && std::count(names.begin(), names.end(), one.name) == 0) continue;
      for (const Time when : times) run_apart(one, when, setting);
    }
  };
  run({{"none", [](World&) {}}}, {Time::kSteady});
  run(hazards(), {Time::kStart, Time::kSteady, Time::kTurning});
  run(further_failures(), {Time::kStart, Time::kSteady, Time::kTurning});
  run(wrong_wirings(), {Time::kWiring});
  return 0;
}
