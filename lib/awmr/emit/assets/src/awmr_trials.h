/* Records the trials of the field sheet: drives each run of a list, measures in steady state, and
   returns the rows of the tables for `awmr identify`. C++11, without Arduino. */
#ifndef AWMR_TRIALS_H
#define AWMR_TRIALS_H

#include <stdint.h>

namespace awmr_trials {

enum Kind { kSurge, kTurning, kCoastdown };

struct Trial {
  Kind kind;
  float force;        /* force of every wheel, divided by F_max */
  float steering_rad; /* angle of the front wheels, left positive */
};

struct Settings {
  float settle_s;  /* driving time before the measurement */
  float measure_s; /* averaging time */
  float coast_s;   /* maximum duration of a coast-down */
  float rest_mps; /* a coast-down also ends below this speed, once it has enough rows for a curve */
  /* a run is steady if the means over the two halves of measure_s differ by at most this fraction
     of the mean of both */
  float steady_share;
};

enum State { kWaiting, kSettling, kMeasuring, kCoasting, kDone };

/* Event of a step. The same run must be driven again after kNotSteady, after kLetGo, and after
   kSensorLost if the motors were on. */
enum Event {
  kNothing,
  kRow,       /* a row of a surge or turning run, which is finished */
  kCurveRow,  /* a row of a coast-down */
  kCoasted,   /* a coast-down is finished */
  kNotSteady, /* the means over the halves of measure_s differ, or a half has too few fixes */
  kLetGo,     /* the dead man's switch was released */
  kSensorLost /* a sensor was rejected. A coast-down ends with the rows so far, and the next run
                 waits */
};

struct Measured {
  uint32_t now_ms;
  float speed_mps;
  uint32_t speed_ms; /* time of the speed's measurement: each reading counts once */
  float yaw_rate_radps;
  bool is_held; /* the dead man's switch is held: the vehicle is armed */
};

/* A row of a table. For kRow: force, steering_rad, and the mean speed or yaw rate as `value`. For
   kCurveRow: time t_s since the motors were switched off, and the speed as `value`. */
struct Row {
  float force;
  float steering_rad;
  float t_s;
  float value;
};

class Recorder {
 public:
  Recorder(const Trial* runs, uint8_t count, const Settings& settings)
      : runs_(runs), settings_(settings), count_(count) {}

  /* Starts the waiting run in the next step. */
  void go() {
    if (state_ == kWaiting) state_ = kSettling, is_new_ = true;
  }
  /* Skips the waiting run. */
  void skip() {
    if (state_ == kWaiting) next();
  }

  /* Call in every control step. is_doubtful: a sensor is rejected; the run in progress ends. */
  Event step(const Measured& m, bool is_doubtful = false) {
    if (is_new_) {
      since_ms_ = m.now_ms;
      is_new_ = false;
    }
    if (state_ == kWaiting || state_ == kDone) return kNothing;
    if (is_doubtful) return lose();
    if (!m.is_held && state_ != kCoasting) return give_up(kLetGo); /* coasting: motors are off */
    const float t_s = static_cast<float>(m.now_ms - since_ms_) * 1e-3f;
    const bool is_fresh = m.speed_ms != speed_ms_;
    speed_ms_ = m.speed_ms;
    if (state_ == kSettling) {
      if (t_s >= settings_.settle_s) begin_window(m.now_ms);
      return kNothing;
    }
    return state_ == kMeasuring ? measure(m, t_s, is_fresh) : coast(m, t_s, is_fresh);
  }

  State state() const { return state_; }
  uint8_t number() const {
    return number_;
  } /* number of the present run, from 0; `count` when all runs are done */
  const Trial& trial() const { return runs_[number_]; }
  const Row& row() const { return row_; }
  /* Force of every wheel to command until the next step, divided by F_max; 0 while waiting or
     coasting. */
  float force() const { return state_ == kSettling || state_ == kMeasuring ? trial().force : 0.0f; }
  float steering_rad() const {
    return state_ == kWaiting || state_ == kDone ? 0.0f : trial().steering_rad;
  }

 private:
  const Trial* runs_;
  Settings settings_;
  uint8_t count_;
  uint8_t number_ = 0;
  State state_ = kWaiting;
  bool is_new_ = false;
  uint32_t since_ms_ = 0; /* start of the present state */
  uint32_t speed_ms_ = 0;
  float sum_[2] = {0.0f, 0.0f}; /* sums of the readings in each half of the averaging time */
  uint16_t samples_[2] = {0, 0};
  uint8_t curve_rows_ = 0;
  Row row_ = {0.0f, 0.0f, 0.0f, 0.0f};

  static const uint8_t kMin = 3; /* minimum number of fixes in half of the averaging time */
  static const uint8_t kCurveRows =
      8; /* minimum rows of a coast-down; the last ones can be at rest */

  void begin_window(uint32_t now_ms) {
    state_ = kMeasuring;
    since_ms_ = now_ms;
    for (uint8_t i = 0; i < 2; ++i) sum_[i] = 0.0f, samples_[i] = 0;
  }
  void next() {
    ++number_;
    state_ = number_ < count_ ? kWaiting : kDone;
  }
  Event give_up(Event why) {
    state_ = kWaiting;
    return why;
  }
  /* Ends a run after a sensor fault. A driven run waits to be repeated. A coast-down is not
     repeated: its rows are already in the table under its number, which no other curve may use. */
  Event lose() {
    if (state_ != kCoasting) return give_up(kSensorLost);
    next();
    return kSensorLost;
  }
  Event measure(const Measured& m, float t_s, bool is_fresh) {
    const bool turns = trial().kind == kTurning;
    if (t_s < settings_.measure_s) {
      const uint8_t half = t_s < 0.5f * settings_.measure_s ? 0 : 1;
      if (turns || is_fresh) {
        sum_[half] += turns ? m.yaw_rate_radps : m.speed_mps;
        ++samples_[half];
      }
      return kNothing;
    }
    if (samples_[0] < kMin || samples_[1] < kMin) return give_up(kNotSteady);
    const float mean = (sum_[0] + sum_[1]) / static_cast<float>(samples_[0] + samples_[1]);
    const float apart = sum_[1] / samples_[1] - sum_[0] / samples_[0];
    const float most = settings_.steady_share * (mean < 0.0f ? -mean : mean);
    if (!(apart <= most && -apart <= most)) return give_up(kNotSteady);
    if (trial().kind == kCoastdown) {
      state_ = kCoasting;
      since_ms_ = m.now_ms;
      curve_rows_ = 0;
      return kNothing;
    }
    row_ = {trial().force, trial().steering_rad, 0.0f, mean};
    next();
    return kRow;
  }
  Event coast(const Measured& m, float t_s, bool is_fresh) {
    const bool rests = is_fresh && m.speed_mps < settings_.rest_mps && curve_rows_ >= kCurveRows;
    if (t_s > settings_.coast_s || rests) {
      next();
      return kCoasted;
    }
    if (!is_fresh) return kNothing;
    if (curve_rows_ < kCurveRows) ++curve_rows_;
    row_ = {0.0f, 0.0f, t_s, m.speed_mps};
    return kCurveRow;
  }
};

}  // namespace awmr_trials

#endif /* AWMR_TRIALS_H */
