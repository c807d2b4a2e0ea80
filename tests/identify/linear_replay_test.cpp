/// Compares hand-coded derivatives of the motion with those of ceres::Jet, and the reduced rows of
/// triangle_of() with all rows.
#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <functional>
#include <random>

#include "awmr/core/index.h"
#include "awmr/identify/ceres_solve.h"
#include "awmr/identify/logs/problem/product_sums.h"
#include "awmr/identify/logs/simulation/linear_replay.h"
#include "awmr/identify/logs/simulation/wheel_slip.h"
#include "awmr/model/plant_of.h"
#include "awmr/model/rest.h"

namespace awmr::testing {
namespace {

using Kind = FreeQuantity::Kind;

constexpr int kColumns =
    28;  // every parameter, two delays, the state, and zeros up to whole vectors
constexpr std::size_t kInputDelay = kParameterCount;
constexpr std::size_t kSpeedDelay = kParameterCount + 1;
constexpr std::size_t kFirstState = kParameterCount + 2;
using Jet = ceres::Jet<double, kColumns>;

/// Resistance with the terms of all families. b1 is below 1, so that a straight line (chord)
/// replaces the resistance near rest.
constexpr ParameterValues<double> kValues{0.9,  0.75, 0.06, 1.1,  4.0,   0.3,   0.0066,
                                          0.06, 0.05, 0.02, 0.01, 0.003, 0.015, 0.12};

Vehicle robot(Drive drive = Drive::kFourWheel) {
  Vehicle v;
  v.drive = drive;
  v.front_axle_m = 0.16;
  v.half_track_m = 0.12;
  v.steering_max_deg = 25.0;
  v.steering_max_rate_degps = 200.0;
  return v;
}

/// Commands that jump, stop, reverse and request more steering than available.
DrivingLog commands(bool servo) {
  std::mt19937 chance(7);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  DrivingLog log;
  log.steering_command_rad.emplace();
  double left = 0.0;
  double right = 0.0;
  double steering = 0.0;
  for (int i = 0; i < 300; ++i) {
    if (i % 40 == 0) {
      const double level = part(chance) < 0.25 ? 0.0 : 0.8 * part(chance) - 0.2;
      left = level - 0.1 * part(chance);
      right = level + 0.1 * part(chance);
      steering = 1.2 * part(chance) - 0.6;
    }
    log.t_s.push_back(0.01 * i);
    log.force_left.push_back(left);
    log.force_right.push_back(right);
    log.steering_command_rad->push_back(steering);
  }
  if (servo) return log;
  log[LogChannel::kSteering] = Measured{.value = *log.steering_command_rad, .fresh = {}};
  log.steering_command_rad.reset();
  return log;
}

template <class T>
State<T> first_state(const std::function<T(std::size_t, double)>& seed) {
  constexpr double kFirst[kStateSize] = {1.0, -2.0, 0.4, 0.3, -0.02, 0.1, 0.05};
  State<T> s{};
  for (std::size_t i = 0; i < kStateSize; ++i) channel_of(s, kChannels[i]) = seed(i, kFirst[i]);
  return s;
}

struct ByHand {
  std::vector<LinearMotion> motions;
  std::vector<LinearMotion> earlier;  ///< by row: motion at the time of the row - kSpeedDelay_s
};

constexpr double kInputDelay_s = 0.033;
constexpr double kSpeedDelay_s = 0.047;

/// Coulomb friction of the vehicle. With friction, the vehicle stops in the middle of integration
/// steps.
enum class Friction { kNone, kCoulomb };

ParameterValues<double> values_with(Friction friction) {
  ParameterValues<double> values = kValues;
  if (friction == Friction::kNone) {
    values[at(ParameterId::kSurgeCoulomb)] = values[at(ParameterId::kYawCoulomb)] = 0.0;
  }
  return values;
}

Plant<double> plant_by_hand(bool servo, double step_s, Drive drive, Friction friction) {
  Plant<double> plant =
      resolved_beside_friction(plant_of(robot(drive), values_with(friction)), step_s);
  if (!servo) plant.steering_max_rad = 10.0;
  return plant;
}

ByHand by_hand(const DrivingLog& log, double step_s, double latency_s = kSpeedDelay_s,
               Drive drive = Drive::kFourWheel, Friction friction = Friction::kNone,
               double input_delay_s = kInputDelay_s) {
  const LogSignals signals(log);
  std::vector<ParameterColumn> parameters;
  for (std::size_t i = 0; i < kParameterCount; ++i) {
    parameters.push_back({static_cast<ParameterId>(i), i, 1.0});
  }
  CommandPath path;
  path.terms[Kind::kDelay] = {input_delay_s, kInputDelay};
  const Plant<double> plant =
      plant_by_hand(log.steering_command_rad.has_value(), step_s, drive, friction);
  LinearStepper stepper(plant, kColumns, parameters, path.terms);
  LinearMotion first{first_state<double>([](std::size_t, double x) { return x; }),
                     std::vector<double>(kStateSize * kColumns, 0.0)};
  for (std::size_t i = 0; i < kStateSize; ++i) {
    first.row(kChannels[i], kColumns)[kFirstState + i] = 1.0;
  }
  ByHand found;
  LinearStepper back(plant, kColumns, parameters, path.terms);
  replay_linear(signals, 0, log.rows(), path, stepper, step_s, first,
                [&](std::size_t, const LinearMotion& motion) {
                  found.motions.push_back(motion);
                  found.earlier.push_back(earlier_motion(signals, 0, found.motions, back,
                                                         {latency_s, kSpeedDelay}, step_s, path));
                });
  return found;
}

struct ByJets {
  std::vector<State<Jet>> states;
  std::vector<State<Jet>> earlier;
};

/// State at the time that is delay_s >= 0 before the last of `states`. `states` are the states at
/// the rows from `begin` on. Integrates from the last row before that time. The derivative with
/// respect to the delay enters through the length of these integration steps. For a time before the
/// row `begin`, extrapolates linearly from the first state. `input_delay_s`: `delay_s` of replay().
template <class T>
State<T> earlier_state(const LogSignals& signals, std::size_t begin,
                       const std::vector<State<T>>& states, const Plant<T>& plant, const T& delay_s,
                       const T* input_delay_s, double longest_step_s) {
  const DrivingLog& log = *signals.log;
  const double now_s = log.t_s[begin + states.size() - 1];
  const double then_s = now_s - value_of(delay_s);
  std::size_t row = begin + states.size() - 1;
  while (row > begin && log.t_s[row] > then_s) --row;
  const ModelStep<T> step(plant, log);
  const State<T>& state = states[row - begin];
  const T to_s = T(now_s) - delay_s;
  if (value_of(to_s) < log.t_s[row]) {
    const double at_s = log.t_s[row] - (input_delay_s ? value_of(*input_delay_s) : 0.0);
    // The commands are those of the last row that is not after `at_s`.
    const auto after = std::ranges::upper_bound(log.t_s, at_s) - log.t_s.begin();
    const std::size_t acting = after == 0 ? 0 : static_cast<std::size_t>(after) - 1;
    const SideForces<T> force{T(log.force_left[acting]), T(log.force_right[acting])};
    const T steering =
        log.steering_command_rad ? T((*log.steering_command_rad)[acting]) : state.steering_rad;
    const T h_s = to_s - log.t_s[row];
    const State<T> rates = step.rates(state, force, steering);
    State<T> end = moved(state, rates, h_s);
    const State<T> at_end = step.rates(end, force, steering);  // only those of the pose are used
    end.x_m = state.x_m + 0.5 * h_s * (rates.x_m + at_end.x_m);
    end.y_m = state.y_m + 0.5 * h_s * (rates.y_m + at_end.y_m);
    end.psi_rad = state.psi_rad + 0.5 * h_s * (rates.psi_rad + at_end.psi_rad);
    return end;
  }
  return advance_after_row(signals, row, T(log.t_s[row]), to_s, step.plant(), input_delay_s,
                           longest_step_s, state, nullptr, step);
}

ByJets by_jets(const DrivingLog& log, double step_s, Drive drive = Drive::kFourWheel,
               Friction friction = Friction::kNone) {
  const LogSignals signals(log);
  ParameterValues<Jet> values;
  for (std::size_t i = 0; i < kParameterCount; ++i) {
    values[i] = Jet(values_with(friction)[i], static_cast<int>(i));
  }
  const Plant<Jet> plant = resolved_beside_friction(plant_of(robot(drive), values), step_s);
  const Jet input(kInputDelay_s, kInputDelay);
  const Jet late(kSpeedDelay_s, kSpeedDelay);
  const auto first = first_state<Jet>(
      [](std::size_t i, double x) { return Jet(x, static_cast<int>(kFirstState + i)); });
  ByJets found;
  replay(signals, 0, log.rows(), plant, &input, step_s, first,
         [&](std::size_t, const State<Jet>& state) {
           found.states.push_back(state);
           found.earlier.push_back(
               earlier_state(signals, 0, found.states, plant, late, &input, step_s));
         });
  return found;
}

/// Additional tolerance of the derivative with respect to the delay of the commands. The hand-coded
/// derivative is computed from the rates at the time of a command change, that of the jets from the
/// lengths of the Runge-Kutta steps. The two differ by the integration error of a step in which the
/// yaw rate passes the kink of its resistance: by 8.5e-4 with steps of 4 ms, by 8e-6 with steps of
/// 0.25 ms.
constexpr double kChanges = 1e-3;

/// Expects that the states and derivatives of `jets` and `motions` (hand-coded) are equal.
/// `tolerance` is relative to the largest derivative of the column over the log, or to `least` if
/// that is larger. `but`: a column to skip; -1: none.
void expect_equal(const std::vector<State<Jet>>& jets, const std::vector<LinearMotion>& motions,
                  double tolerance, int but = -1, double least = 1e-9) {
  ASSERT_EQ(jets.size(), motions.size());
  for (const LogChannel channel : kChannels) {
    Eigen::VectorXd largest = Eigen::VectorXd::Constant(kColumns, least);
    for (const State<Jet>& s : jets) {
      const Jet& jet = channel_of(s, channel);
      for (int c = 0; c < kColumns; ++c) largest(c) = std::max(largest(c), std::abs(jet.v(c)));
    }
    for (std::size_t row = 0; row < jets.size(); ++row) {
      const Jet& jet = channel_of(jets[row], channel);
      EXPECT_NEAR(channel_of(motions[row].state, channel), jet.a, 1e-12);
      for (int c = 0; c < kColumns; ++c) {
        if (c == but) continue;
        const double slope = motions[row].row(channel, kColumns)[c];
        const double share = tolerance + (c == kInputDelay ? kChanges : 0.0);
        ASSERT_NEAR(slope, jet.v(c), share * largest(c))
            << info(channel).name << " by column " << c << " at row " << row;
      }
    }
  }
}

/// Tolerance for the rounding of 300 steps.
constexpr double kRounding = 1e-11;
/// Tolerance for logs in which the vehicle stops: the time of a stop within a step is computed from
/// the rates at the stop, not from the polynomial of the step.
constexpr double kStops = 5e-4;

TEST(LinearReplay, WithStopsHasTheStatesAndTheDerivativesOfJets) {
  for (const bool servo : {true, false}) {
    const DrivingLog log = commands(servo);
    const Drive drive = Drive::kFourWheel;
    expect_equal(by_jets(log, 0.001, drive, Friction::kCoulomb).states,
                 by_hand(log, 0.001, kSpeedDelay_s, drive, Friction::kCoulomb).motions, kStops, -1,
                 1e-4);
  }
}

TEST(LinearReplay, HasTheStatesAndTheDerivativesOfJets) {
  for (const bool servo : {true, false}) {
    const DrivingLog log = commands(servo);
    expect_equal(by_jets(log, 0.004).states, by_hand(log, 0.004).motions, kRounding);
  }
}

TEST(LinearReplay, OfFrontWheelDriveHasTheDerivativesOfJets) {
  const DrivingLog log = commands(true);
  const Drive drive = Drive::kFrontWheel;
  expect_equal(by_jets(log, 0.004, drive).states, by_hand(log, 0.004, kSpeedDelay_s, drive).motions,
               kRounding);
}

TEST(LinearReplay, DelayedStatesHaveTheDerivativesOfJets) {
  for (const bool servo : {true, false}) {
    const DrivingLog log = commands(servo);
    expect_equal(by_jets(log, 0.004).earlier, by_hand(log, 0.004).earlier, kRounding, kSpeedDelay);
  }
}

/// Returns the log with each row divided into ten rows, and its commands moved to `rows_later` of
/// these rows later.
DrivingLog refined(const DrivingLog& log, std::size_t rows_later) {
  constexpr std::size_t kParts = 10;
  DrivingLog fine;
  fine.steering_command_rad.emplace();
  for (std::size_t i = 0; i < kParts * log.rows(); ++i) {
    const std::size_t from = i < rows_later ? 0 : (i - rows_later) / kParts;
    fine.t_s.push_back(0.001 * static_cast<double>(i));
    fine.force_left.push_back(log.force_left[from]);
    fine.force_right.push_back(log.force_right[from]);
    fine.steering_command_rad->push_back((*log.steering_command_rad)[from]);
  }
  return fine;
}

TEST(LinearReplay, ACommandThatArrivesBetweenRowsActsFromThen) {
  const DrivingLog log = commands(true);
  for (const Friction friction : {Friction::kNone, Friction::kCoulomb}) {
    const auto motions = [&](const DrivingLog& of, double delay_s) {
      return by_hand(of, 0.001, kSpeedDelay_s, Drive::kFourWheel, friction, delay_s).motions;
    };
    const std::vector<LinearMotion> late = motions(log, 0.033);
    const std::vector<LinearMotion> fine = motions(refined(log, 33), 0.0);
    for (std::size_t row = 0; row < log.rows(); ++row) {
      for (const LogChannel channel : kChannels) {
        ASSERT_NEAR(channel_of(late[row].state, channel), channel_of(fine[10 * row].state, channel),
                    1e-9)
            << info(channel).name << " at row " << row;
      }
    }
  }
}

TEST(LinearReplay, DerivativeByACommandDelayIsThatOfDifferences) {
  // With the delay 0.03 s, a delayed command changes exactly at a row, where the motion has a kink.
  // The derivative is then the one-sided derivative towards longer delays, as computed here.
  // Tolerance: steps in which the servo leaves its limit also have a kink.
  constexpr double kApart_s = 1e-6;
  const DrivingLog log = commands(true);
  for (const double delay_s : {0.033, 0.03, -0.017}) {
    const auto motions = [&](double late_s) {
      return by_hand(log, 0.001, kSpeedDelay_s, Drive::kFourWheel, Friction::kNone, late_s).motions;
    };
    const std::vector<LinearMotion> here = motions(delay_s);
    const std::vector<LinearMotion> more = motions(delay_s + kApart_s);
    for (const LogChannel channel : kChannels) {
      double largest = 0.0;
      for (const LinearMotion& motion : here) {
        largest = std::max(largest, std::abs(motion.row(channel, kColumns)[kInputDelay]));
      }
      for (std::size_t row = 0; row < here.size(); ++row) {
        const double slope =
            (channel_of(more[row].state, channel) - channel_of(here[row].state, channel)) /
            kApart_s;
        ASSERT_NEAR(here[row].row(channel, kColumns)[kInputDelay], slope, 0.01 * largest)
            << info(channel).name << " at row " << row << ", delay " << delay_s;
      }
    }
  }
}

TEST(LinearReplay, DerivativeByASensorDelayIsTheRateOfTheMotion) {
  // Central differences over 2e-6 s. The rates of the motion are below 10 and take at least 0.02 s
  // to change, so the error of the differences is below 1e-6. Exceptions are steps in which the
  // motion has a kink, at a limit of the servo or where the vehicle stops.
  constexpr double kApart_s = 1e-6;
  const DrivingLog log = commands(true);
  const std::vector<LinearMotion> here = by_hand(log, 0.004, kSpeedDelay_s).earlier;
  const std::vector<LinearMotion> more = by_hand(log, 0.004, kSpeedDelay_s + kApart_s).earlier;
  const std::vector<LinearMotion> less = by_hand(log, 0.004, kSpeedDelay_s - kApart_s).earlier;
  std::size_t apart = 0;
  for (std::size_t row = 0; row < here.size(); ++row) {
    for (const LogChannel channel : kChannels) {
      const double slope =
          (channel_of(more[row].state, channel) - channel_of(less[row].state, channel)) /
          (2.0 * kApart_s);
      apart += std::abs(slope - here[row].row(channel, kColumns)[kSpeedDelay]) > 1e-4;
    }
  }
  EXPECT_LT(apart, here.size() * kStateSize / 20);
}

/// Number of command errors. Their indices: 0 steering trim, rad; 1 force imbalance; 2 saturation
/// of the forces; 3 logarithm of its sharpness; 4 logarithm of the exponent of the forces; 5 rate
/// limit of the servo, rad/s; 6 dead band of the steering, rad; 7 asymmetry of the steering; 8 its
/// curve; 9 its scale error; 10 sag of the supply; 11 half the difference of the dead zones.
constexpr std::size_t kErrors = 12;
using CommandErrors = std::array<double, kErrors>;

/// Simulates the log with these errors of the commands, and derivatives with respect to them only.
std::vector<LinearMotion> with_errors(const DrivingLog& log, const CommandErrors& errors) {
  constexpr double kStep_s = 0.004;
  const LogSignals signals(log);
  CommandPath path{.full_command = 0.3};
  path.terms[Kind::kSteeringTrim] = {errors[0], 0};
  path.terms[Kind::kForceImbalance] = {errors[1], 1};
  path.terms[Kind::kForceSaturation] = {errors[2], 2};
  path.terms[Kind::kSaturationSharpness] = {std::exp(errors[3]), 3};
  path.terms[Kind::kForceExponent] = {std::exp(errors[4]), 4};
  path.terms[Kind::kServoRate] = {errors[5], 5};
  path.terms[Kind::kSupplySag] = {errors[10], 10};
  path.terms[Kind::kDeadZoneDifference] = {errors[11], 11};
  if (log.steering_command_rad) {
    path.terms[Kind::kSteeringDeadBand] = {errors[6], 6};
    path.terms[Kind::kSteeringAsymmetry] = {errors[7], 7};
    path.terms[Kind::kSteeringCurve] = {errors[8], 8};
    path.terms[Kind::kSteeringScale] = {errors[9], 9};
    path.steering_stop_rad = 0.35;
  }
  Plant<double> plant = plant_by_hand(log.steering_command_rad.has_value(), kStep_s,
                                      Drive::kFourWheel, Friction::kNone);
  plant.steering_max_rate_radps = errors[5];
  LinearStepper stepper(plant, kErrors, {}, path.terms);
  std::vector<LinearMotion> motions;
  const LinearMotion first{first_state<double>([](std::size_t, double x) { return x; }),
                           std::vector<double>(kStateSize * kErrors, 0.0)};
  replay_linear(signals, 0, log.rows(), path, stepper, kStep_s, first,
                [&](std::size_t, const LinearMotion& motion) { motions.push_back(motion); });
  return motions;
}

TEST(LinearReplay, OfErrorsOfTheCommandsHasTheDerivativesOfCentralDifferences) {
  constexpr double kApart = 1e-6;
  const CommandErrors errors{0.03, -0.08, 0.2, 1.2, -0.2, 1.5, 0.05, 0.1, 0.15, -0.1, 0.12, 0.02};
  for (const bool servo : {true, false}) {
    const DrivingLog log = commands(servo);
    const std::vector<LinearMotion> here = with_errors(log, errors);
    for (std::size_t column = 0; column < kErrors; ++column) {
      CommandErrors more = errors;
      CommandErrors less = errors;
      more[column] += kApart;
      less[column] -= kApart;
      const std::vector<LinearMotion> after = with_errors(log, more);
      const std::vector<LinearMotion> before = with_errors(log, less);
      for (const LogChannel channel : kChannels) {
        double largest = 1e-9;
        for (const LinearMotion& motion : here) {
          largest = std::max(largest, std::abs(motion.row(channel, kErrors)[column]));
        }
        for (std::size_t row = 1; row < here.size(); ++row) {
          const double slope =
              (channel_of(after[row].state, channel) - channel_of(before[row].state, channel)) /
              (2.0 * kApart);
          ASSERT_NEAR(here[row].row(channel, kErrors)[column], slope, 1e-4 * largest)
              << info(channel).name << " by column " << column << " at row " << row;
        }
      }
    }
  }
}

/// Number of coordinates: speed, yaw rate, logarithm of the dead zone, back-EMF, force imbalance
/// and slip.
constexpr std::size_t kSlipColumns = 6;
using SlipCoordinates = std::array<double, kSlipColumns>;

/// Amount that wheel slip adds to a reading of the channel, and its derivatives with respect to the
/// coordinates.
std::pair<double, std::vector<double>> slip_at(const SlipCoordinates& x, LogChannel channel,
                                               bool is_ratio) {
  Plant<double> plant = plant_by_hand(true, 0.004, Drive::kFourWheel, Friction::kNone);
  plant.wheel_dead_zone = std::exp(x[2]);
  plant.back_emf_s_per_m = x[3];
  DrivingLog log = commands(true);
  log.force_left.assign(log.rows(), -0.4);
  log.force_right.assign(log.rows(), 0.3);
  CommandPath path;
  path.terms[Kind::kForceImbalance] = {x[4], 4};
  LinearMotion motion{{}, std::vector<double>(kStateSize * kSlipColumns, 0.0)};
  motion.state.u_mps = x[0];
  motion.state.r_radps = x[1];
  motion.row(LogChannel::kSpeed, kSlipColumns)[0] = 1.0;
  motion.row(LogChannel::kYawRate, kSlipColumns)[1] = 1.0;
  const std::vector<ParameterColumn> parameters{
      {ParameterId::kWheelDeadZone, 2, plant.wheel_dead_zone}, {ParameterId::kBackEmf, 3, 1.0}};
  std::vector<double> by(kSlipColumns, 0.0);
  const double added =
      add_wheel_slip({channel, {x[5], 5}, is_ratio}, {plant, parameters, path.terms},
                     command_at(LogSignals(log), 0.5, path), motion, kSlipColumns, by.data());
  return {added, by};
}

TEST(WheelSlip, HasTheDerivativesOfCentralDifferences) {
  constexpr double kApart = 1e-6;
  const SlipCoordinates x{0.1, 2.0, -3.0, 0.05, 0.1, 0.2};  // the left wheels roll back
  for (const LogChannel channel : {LogChannel::kSpeed, LogChannel::kYawRate}) {
    for (const bool is_ratio : {false, true}) {
      const std::vector<double> by = slip_at(x, channel, is_ratio).second;
      for (std::size_t i = 0; i < kSlipColumns; ++i) {
        SlipCoordinates more = x;
        SlipCoordinates less = x;
        more[i] += kApart;
        less[i] -= kApart;
        const double slope =
            (slip_at(more, channel, is_ratio).first - slip_at(less, channel, is_ratio).first) /
            (2.0 * kApart);
        EXPECT_NEAR(by[i], slope, 1e-7) << "column " << i;
      }
    }
  }
}

TEST(WheelSlip, OfAStandingWheelIsZero) {
  const SlipCoordinates at_rest{0.0, 0.0, -3.0, 0.05, 0.1, 0.2};
  EXPECT_EQ(slip_at(at_rest, LogChannel::kSpeed, false).first, 0.0);
}

/// Values of the extra forces, indexed by ExtraForce. Those of the speed scales of Stribeck
/// friction are logarithms.
using ForceCoordinates = std::array<double, kExtraForceCount>;

/// Simulates the log with these extra forces, and derivatives with respect to them only.
std::vector<LinearMotion> with_forces(const DrivingLog& log, const ForceCoordinates& coordinates,
                                      Friction friction) {
  constexpr double kStep_s = 0.004;
  const LogSignals signals(log);
  ExtraForces extra;
  for (std::size_t i = 0; i < kExtraForceCount; ++i) {
    const auto force = static_cast<ExtraForce>(i);
    const bool is_speed =
        force == ExtraForce::kSurgeStribeckSpeed || force == ExtraForce::kYawStribeckSpeed;
    extra[force] = is_speed ? std::exp(coordinates[i]) : coordinates[i];
    extra.columns.push_back({force, i, is_speed ? extra[force] : 1.0});
  }
  const Plant<double> plant =
      plant_by_hand(log.steering_command_rad.has_value(), kStep_s, Drive::kFourWheel, friction);
  LinearStepper stepper(plant, kExtraForceCount, {}, {}, kStep_s, extra);
  std::vector<LinearMotion> motions;
  const LinearMotion first{first_state<double>([](std::size_t, double x) { return x; }),
                           std::vector<double>(kStateSize * kExtraForceCount, 0.0)};
  replay_linear(signals, 0, log.rows(), {}, stepper, kStep_s, first,
                [&](std::size_t, const LinearMotion& motion) { motions.push_back(motion); });
  return motions;
}

/// Expects that the derivatives with respect to the forces [first, end) equal central differences.
/// `share`: tolerance, relative to the largest derivative in the column.
void expect_derivatives_by_forces(const ForceCoordinates& at, Friction friction, std::size_t first,
                                  std::size_t end, double share) {
  constexpr double kApart = 1e-6;
  const DrivingLog log = commands(true);
  const std::vector<LinearMotion> here = with_forces(log, at, friction);
  for (std::size_t column = first; column < end; ++column) {
    ForceCoordinates more = at;
    ForceCoordinates less = at;
    more[column] += kApart;
    less[column] -= kApart;
    const std::vector<LinearMotion> after = with_forces(log, more, friction);
    const std::vector<LinearMotion> before = with_forces(log, less, friction);
    for (const LogChannel channel : kChannels) {
      if (channel == LogChannel::kSteering) continue;  // no force acts on the steering
      double largest = 1e-6;
      double apart = 0.0;
      for (std::size_t row = 0; row < here.size(); ++row) {
        const double slope =
            (channel_of(after[row].state, channel) - channel_of(before[row].state, channel)) /
            (2.0 * kApart);
        const double by_hand = here[row].row(channel, kExtraForceCount)[column];
        largest = std::max(largest, std::abs(by_hand));
        apart = std::max(apart, std::abs(by_hand - slope));
      }
      EXPECT_LT(apart, share * largest) << info(channel).name << " by column " << column;
    }
  }
}

TEST(LinearReplay, OfExtraForcesHasTheDerivativesOfCentralDifferences) {
  // Derivatives and differences agree less exactly in steps in which friction stops the vehicle.
  // Forces that jump at a stop therefore need a larger tolerance.
  constexpr std::size_t kJumping = at(ExtraForce::kTurnDrag);
  const ForceCoordinates none{0.0, -2.0, 0.0, -1.0, 0.0, 0.0, 0.0,
                              1.0, 0.0,  0.0, 0.0,  0.0, 0.0, 0.0};
  const ForceCoordinates all{0.04, -2.0, 0.01, -1.0, 0.06, -0.1, 0.1,
                             0.8,  0.6,  0.3,  -0.2, 0.25, 0.0,  0.0};
  ForceCoordinates steady = all;
  std::copy(none.begin() + kJumping, none.end(), steady.begin() + kJumping);
  expect_derivatives_by_forces(none, Friction::kCoulomb, 0, kJumping, 3e-3);
  expect_derivatives_by_forces(steady, Friction::kCoulomb, 0, kJumping, 3e-3);
  expect_derivatives_by_forces(all, Friction::kCoulomb, kJumping, kExtraForceCount, 2e-2);
  ForceCoordinates without_friction = all;
  without_friction[at(ExtraForce::kSurgeStribeck)] = 0.0;
  without_friction[at(ExtraForce::kYawStribeck)] = 0.0;
  expect_derivatives_by_forces(without_friction, Friction::kNone, at(ExtraForce::kSlopeX),
                               kExtraForceCount, 1e-4);
  // Only the columns of side pull and axle offset: both couple the yaw rate to the speed, so that
  // the tiny derivatives of the yaw rate by surge forces have the errors of the steps with a stop.
  for (ForceCoordinates pulled : {none, without_friction}) {
    pulled[at(ExtraForce::kSidePull)] = 0.02;
    pulled[at(ExtraForce::kAxleOffset)] = 0.05;
    expect_derivatives_by_forces(pulled, Friction::kNone, at(ExtraForce::kSidePull),
                                 kExtraForceCount, 1e-4);
  }
}

TEST(ProductSums, EqualTheSumsOfAllRowsAndOfTheTriangle) {
  std::mt19937 chance(3);
  std::normal_distribution<double> normal;
  constexpr int kRows = 101;
  // The last column is r; column 2 is 0, column 4 twice column 3, the others are correlated.
  constexpr int kSize = 12;
  const auto any = [&] { return normal(chance); };
  Eigen::MatrixXd all = Eigen::MatrixXd::NullaryExpr(kRows, kSize, any) *
                        Eigen::MatrixXd::NullaryExpr(kSize, kSize, any);
  all.col(2).setZero();
  all.col(4) = 2.0 * all.col(3);
  all.col(5) *= 1e6;
  ProductSums sums(kSize);
  std::vector<double> row(sums.columns(), 0.0);
  Eigen::VectorXd gradients = Eigen::VectorXd::Zero(kSize - 1);
  for (int i = 0; i < kRows; ++i) {
    for (int c = 0; c < kSize; ++c) row[at(c)] = all(i, c);
    sums.add(row.data());
    if (i == 40) gradients += sums.take_gradient();
  }
  gradients += sums.take_gradient();
  const Eigen::MatrixXd expected = all.transpose() * all;
  const Eigen::MatrixXd products = sums.products();
  const Eigen::VectorXd scale = expected.diagonal().cwiseSqrt().cwiseMax(1.0);
  const auto relative = [&](const Eigen::MatrixXd& m) -> Eigen::MatrixXd {
    return scale.cwiseInverse().asDiagonal() * m * scale.cwiseInverse().asDiagonal();
  };
  EXPECT_LT(relative(products - expected).cwiseAbs().maxCoeff(), 1e-13);
  EXPECT_LT((gradients - expected.col(kSize - 1).head(kSize - 1))
                .cwiseQuotient(scale.head(kSize - 1))
                .cwiseAbs()
                .maxCoeff(),
            1e-11);

  const Triangle t = triangle_of(products);
  Eigen::MatrixXd few = Eigen::MatrixXd::Zero(kSize, kSize);
  few.topLeftCorner(kSize - 1, kSize - 1) = t.r;
  few.col(kSize - 1).head(kSize - 1) = t.z;
  few(kSize - 1, kSize - 1) = t.rest;
  // Tolerance: pivots of at most 1e-14 are dropped. These are squares, so 1e-7 of a column is lost.
  EXPECT_LT(relative(few.transpose() * few - expected).cwiseAbs().maxCoeff(), 1e-7);
}

}  // namespace
}  // namespace awmr::testing
