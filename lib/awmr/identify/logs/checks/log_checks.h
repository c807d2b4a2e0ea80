/// Checks of the fit that run_log_stage() has chosen. Each of them is in a .cpp file of its own:
/// slip_choice, exchangeable, adequacy, car_steering, speed_control, gyro_scale, inertia_check. Private to
/// identify/.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "awmr/identify/logs/choice/family_fit.h"
#include "awmr/identify/logs/log_stage.h"

namespace awmr {

/// If the fit `chosen` has significant wheel slip or late commands, tries the alternatives: slip in
/// place of late commands or the reverse, and the second form of slip (slip ratio or slip speed,
/// WheelSlip::is_ratio). A fit can mistake slip for late commands, because both make a reading rise
/// earlier than the logged commands explain.
///
/// The fit with the lowest AIC becomes `chosen`. The logs do not decide if the AIC of another fit
/// is higher by less than 10, or if the difference is larger only because of a few rows
/// (kMaxSquaredInnovation). These few rows are those in which a command changes: whether a
/// reading in such a row already shows the new command depends on the program that writes the log.
/// The intervals of the parameters that differ between the fits by more than one standard error are
/// then withdrawn, and the finding `wheel-slip` names both explanations.
///
/// Without a position, a sensor of the speed whose delay grows at low speed (speed from the time
/// between two encoder ticks) looks like slip. The intervals that depend on the slip are then
/// withdrawn, too (withdraw_of_slip()). Empty if nothing was withdrawn.
std::optional<Finding> decide_slip(const std::vector<DrivingLog>& logs, FamilyFit& chosen);

/// Refuses m', I'z and a lag of the motors, the servo or a sensor if these logs allow another value
/// of them about equally well (equally_likely_exchange()).
void refuse_exchangeable(const std::vector<DrivingLog>& logs, FamilyFit& chosen);

/// Returns one finding `coloured-residuals` for every channel whose whitened residuals are still
/// correlated in time (Ljung-Box test). Whitening removes the drift of the noise model. The finding
/// is a warning if the scatter between parts of the logs raised a standard error much, else a note.
std::vector<Finding> autocorrelation_findings(const LogFit& fit, const std::string& file);

/// Result of check_adequacy().
struct Adequacy {
  /// Fits with other families (forms) of the surge resistance; empty if the check tried none.
  std::vector<EstimatorReport> alternatives;
  std::vector<Finding> findings;
  /// True: a model error is so large that no interval of the fit is valid.
  bool withdraws_intervals = false;
  /// True: heading or yaw rate show a model error, for example play of the steering. The servo's
  /// time constant then gets no interval.
  bool withdraws_servo = false;
  /// True: sway speed or position show a model error. They determine the sway resistance, which
  /// then gets no interval.
  bool withdraws_sway = false;
};

/// Checks every channel of the fit `chosen` for a model error. A channel has one if its residuals
/// (measured minus fitted) have a drift that is too large and too slow to come from the filter of a
/// sensor (ChannelNoise::of_the_model()). One finding `model-inadequate` lists all such channels.
/// If the speed is one of them and `try_families` is true, the check also fits other families of
/// the surge resistance, and recommends a better one. `power_law`: the options of the logs' first
/// fit, which has power laws in surge and yaw; the fits with other families use the same options.
Adequacy check_adequacy(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                        const FamilyFit& chosen, bool try_families);

/// Returns the warning `turns-like-a-car` if the measured yaw rate r follows the formula of a car
/// whose wheels roll without side slip,
///
///     r = u tan(d_r)/L          (u: measured speed, d_r: steering angle, L: wheelbase)
///
/// clearly better than the simulation of `fit`. The side force of the tyres then turns the vehicle,
/// which the model (39) to (41) does not contain. d_r follows the command with a first-order lag,
/// the best one of a few. Empty without steering, measured speed or measured yaw rate.
std::optional<Finding> car_steering_finding(const Vehicle& vehicle,
                                            const std::vector<DrivingLog>& logs, const LogFit& fit);

/// Result of find_speed_control().
struct SpeedControl {
  double speed_per_command_mps = 0.0;  ///< speed of each wheel divided by its command, m/s
  bool withdraws = false;              ///< true: the intervals of the fit are not valid
};

/// Decides whether the speed at which each wheel rolls seems to be proportional to its command.
/// Either motor drag is then the only resistance, or the log has the set-points of a speed
/// controller instead of forces. One of these signs suffices:
///   - Both fitted resistances are linear, and the yaw coefficient a3 is d^2 times the surge
///     coefficient a1 (d: half of the track width):
///
///         tau_speed = a1 u,   tau_turn = a3 r = d^2 a1 r
///
///   - The measured steady speeds of the wheels are proportional to their commands. If the fit
///     has no model error (LogFit::has_model_error()), only speeds in turns with different commands
///     left and right count: for a vehicle without speed controller, inner and outer wheels then
///     have different ratios, unless its only resistance is motor drag.
///
/// The second sign withdraws the intervals, unless all of this indicates motor drag: the model
/// describes the logs, its errors are hardly larger than the sensor noise (LogFit::relative_error
/// below 1.5), and the first sign is present too.
std::optional<SpeedControl> find_speed_control(const Vehicle& vehicle,
                                               const std::vector<DrivingLog>& logs,
                                               const FamilyFit& chosen);

Finding speed_control_finding(const SpeedControl& found, const std::string& file);

/// Prior standard deviation of the scale error s of a gyroscope (it reads 1 + s times the true yaw
/// rate). Data sheets of uncalibrated MEMS gyroscopes give tolerances from 0.5 % (ICM-42688-P) and
/// 1.5 % (ICM-20948) to 3 % (MPU-6050).
inline constexpr double kGyroScaleStd = 0.01;

/// If the logs have a yaw rate and a heading or positions, but the fit does not estimate the scale
/// error s of the yaw rate, adds the effect of s to the covariance and the intervals of `chosen`. s
/// has a normal prior with the mean 0 and the standard deviation kGyroScaleStd. With the
/// information h about s in the logs and the value s_1 that they indicate (both from one
/// Gauss-Newton step), the mean and the variance of s are
///
///     m = s_1 h/(h + 1/kGyroScaleStd^2),   var = 1/(h + 1/kGyroScaleStd^2)
///
/// The fit assumes s = 0, so the variance that counts is var + m^2. Returns the note
/// `gyro-scale-open` if a standard error grows by half or more and the standard deviation of s is
/// above a quarter of kGyroScaleStd, else empty.
std::optional<Finding> widen_by_gyro_scale(const std::vector<DrivingLog>& logs, FamilyFit& chosen);

/// Refuses I'z of the log fit `stage` (gives it no value) in two cases: no distribution of mass
/// within the vehicle's size gives the fitted I'z/m', or m' is not determined and only the steering
/// turns the vehicle. If not I'z but m' may be wrong, for example because of a wrong unit of the
/// speed, also withdraws all intervals and reports `inertia-mismatch`. If I'z/m' is possible but
/// unusual, only reports `inertia-mismatch`. `model`: values from other trials.
void check_inertia(const Vehicle& vehicle, const std::vector<DrivingLog>& logs, const Model& model,
                   LogStage& stage);

}  // namespace awmr
