#include "awmr/identify/compass/compass.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "awmr/core/index.h"
#include "awmr/core/statistics/distributions.h"
#include "awmr/core/statistics/linear_algebra.h"
#include "awmr/core/units.h"
#include "ellipse.h"

namespace awmr {
namespace {

using compass::Ellipse;
using compass::Parameters;
using compass::Points;
using Covariance = Eigen::Matrix<double, 5, 5>;

/// Number of equal sectors of the circle, 10 degrees each. known() leaves out one sector at a time.
constexpr int kSectors = 36;
/// Largest accepted gap between neighbouring headings of the readings of a calibration turn.
constexpr double kLargestGapDeg = 30.0;
/// Residual standard deviation, as a share of the field, above which `compass-residual` is
/// reported. Tilt, moving iron or noise cause such residuals; hard and soft iron cause none.
constexpr double kLargeResidual = 0.05;
/// Residual standard deviation, as a share of the field, above which the ellipse is refused.
constexpr double kNoEllipse = 0.2;
/// Accepted difference of the turn angles of compass and gyroscope, as a share of the turn. It has
/// to be larger than the scale error of a gyroscope.
constexpr double kTurnTolerance = 0.1;

Points points_of(const FieldRecord& record) {
  Points points(rows_of(record.ahead), 2);
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    points.row(i) << record.ahead[at(i)], record.left[at(i)];
  }
  return points;
}

/// Magnetic heading of each row, rad, counter-clockwise from magnetic north.
std::vector<double> headings_of(const Ellipse& ellipse, const Points& points) {
  std::vector<double> headings;
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const Eigen::Vector2d c = ellipse.on_circle(points.row(i));
    headings.push_back(std::atan2(-c[1], c[0]));
  }
  return headings;
}

/// Largest gap of the circle without a reading: the heading at which the gap begins, and its size
/// counter-clockwise from there, rad.
std::pair<double, double> largest_gap_rad(std::vector<double> headings) {
  std::sort(headings.begin(), headings.end());
  std::pair<double, double> largest{headings.back(),
                                    headings.front() + 2.0 * pi<double>() - headings.back()};
  for (std::size_t i = 1; i < headings.size(); ++i) {
    const double gap = headings[i] - headings[i - 1];
    if (gap > largest.second) largest = {headings[i - 1], gap};
  }
  return largest;
}

std::size_t sector_of(double heading_rad) {
  const double share = (heading_rad + pi<double>()) / (2.0 * pi<double>());
  return static_cast<std::size_t>(std::clamp(static_cast<int>(share * kSectors), 0, kSectors - 1));
}

/// A fitted ellipse with its uncertainty.
struct Known {
  Ellipse ellipse;
  Covariance covariance = Covariance::Zero();
  double half = 0.0;      ///< half of the width of a 95 % interval, in standard errors
  double residual = 0.0;  ///< standard deviation of the residuals, as a share of the field
};

/// Computes the covariance C of the parameters of the ellipse by the jackknife: each of the n
/// sectors is left out once, because the residuals within a sector may be correlated. J_s and r_s
/// are the Jacobian and the residuals of sector s, J is the Jacobian of all rows:
///     D_s = (J'J - J_s'J_s)^-1 J_s' r_s,   C = (n - 1)/n sum_s D_s D_s'    [Efron 1982, 3.1]
Known known(const Ellipse& ellipse, const Points& points, const std::vector<double>& headings) {
  Known known{.ellipse = ellipse};
  std::array<Covariance, kSectors> information;
  std::array<Parameters, kSectors> sums;
  information.fill(Covariance::Zero());
  sums.fill(Parameters::Zero());
  Covariance whole = Covariance::Zero();
  double squares = 0.0;
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const Parameters gradient = compass::residual_gradient(ellipse, points.row(i)).transpose();
    const double r = compass::residual(ellipse, points.row(i));
    const std::size_t sector = sector_of(headings[at(i)]);
    information[sector] += gradient * gradient.transpose();
    sums[sector] += r * gradient;
    whole += gradient * gradient.transpose();
    squares += r * r;
  }
  int sectors = 0;
  for (std::size_t s = 0; s < kSectors; ++s) {
    if (information[s].isZero(0.0)) continue;
    const Parameters moved = solve_ldlt(whole - information[s], sums[s]);
    known.covariance += moved * moved.transpose();
    ++sectors;
  }
  known.covariance *= (sectors - 1.0) / sectors;
  known.half = t_quantile_95(std::max(1, sectors - 5));
  known.residual = std::sqrt(squares / static_cast<double>(points.rows() - 5));
  return known;
}

/// 95 % bound of the heading error at the worst heading, rad, due to the covariance of the ellipse.
/// The heading is computed from the field c = S (f - o) (Ellipse), so its error is
///     d heading = (c_left d c_ahead - c_ahead d c_left)/|c|^2
double heading_error_rad(const Known& known) {
  const Ellipse& ellipse = known.ellipse;
  double worst = 0.0;
  for (int i = 0; i < 2 * kSectors; ++i) {
    const double angle = pi<double>() * i / kSectors;
    const Eigen::Vector2d c(std::cos(angle), std::sin(angle));
    const Eigen::Vector2d f = ellipse.centre() + ellipse.gain().inverse() * c;
    const Eigen::Matrix<double, 1, 5> gradient =
        Eigen::RowVector2d(c[1], -c[0]) * compass::circle_gradient(ellipse, f);
    worst = std::max(worst, gradient.dot(gradient * known.covariance));
  }
  return known.half * std::sqrt(worst);
}

/// Value of `function` at the fitted ellipse, with its 95 % interval.
template <class Function>
WithInterval with_interval(const Known& known, const Function& function) {
  Parameters gradient;
  for (int k = 0; k < 5; ++k) {
    // The step is 1e-5 of the field for the coordinates of the centre, and 1e-5/field for the
    // gains.
    const double scale = k < 2 ? 1.0 / known.ellipse.gain().norm() : known.ellipse.gain().norm();
    const double step = 1e-5 * scale;
    Ellipse up = known.ellipse;
    Ellipse down = known.ellipse;
    up.p[k] += step;
    down.p[k] -= step;
    gradient[k] = (function(up) - function(down)) / (2.0 * step);
  }
  const double value = function(known.ellipse);
  const double half = known.half * std::sqrt(gradient.dot(known.covariance * gradient));
  return {value, {value - half, value + half}};
}

/// Angle turned from the first row to the last, rad. Precondition: less than half a turn per row.
double turned_rad(const std::vector<double>& headings) {
  double turned = 0.0;
  for (std::size_t i = 1; i < headings.size(); ++i) {
    turned += std::remainder(headings[i] - headings[i - 1], 2.0 * pi<double>());
  }
  return turned;
}

double turned_by_gyro_rad(const FieldRecord& record) {
  double turned = 0.0;
  for (std::size_t i = 1; i < record.t_s.size(); ++i) {
    turned += 0.5 * (record.yaw_rate_radps[i] + record.yaw_rate_radps[i - 1]) *
              (record.t_s[i] - record.t_s[i - 1]);
  }
  return turned;
}

/// Compares the angle `turned`, rad, by the compass with the integral of the gyroscope's yaw rate.
/// Errors (refused): opposite signs, or a difference above kTurnTolerance times |turned|.
Status check_turn(const FieldRecord& record, double turned, std::vector<Finding>& findings) {
  if (record.yaw_rate_radps.empty()) {
    findings.push_back({record.file, 0, Severity::kNote, "turn-not-checked",
                        "there is no yaw_rate_radps, so the signs of field_ahead and field_left "
                        "were not checked; record the yaw rate too"});
    return {};
  }
  const double gyro = turned_by_gyro_rad(record);
  if (gyro * turned < 0.0) {
    return refusal(
        ErrorCode::kCompassUnusable,
        fmt::format("{}: the compass turns by {:.0f} deg while the gyroscope turns by {:.0f} deg. "
                    "Check the "
                    "signs of field_ahead and field_left, whether they are exchanged, and that "
                    "yaw_rate_radps is positive to the left",
                    record.file, degrees(turned), degrees(gyro)));
  }
  if (std::abs(turned - gyro) <= kTurnTolerance * std::abs(turned)) return {};
  return refusal(ErrorCode::kCompassUnusable,
                 fmt::format("{}: the compass turns by {:.0f} deg while the gyroscope turns by "
                             "{:.0f} deg, a difference of more than {:.0f} %; check that "
                             "yaw_rate_radps is in rad/s and without bias, and that no row is "
                             "missing",
                             record.file, degrees(turned), degrees(gyro), 100.0 * kTurnTolerance));
}

/// Checks whether the firmware can use the calibration. Errors (refused): rounding the centre to
/// float changes it by more than 0.1 % of the field; one axis of the ellipse is more than ten times
/// the other, so that noise determines the heading.
Status check_usable(const std::string& file, const CompassCalibration& c) {
  constexpr double kRounding =
      1e-3;  // largest rounding error of the centre, over the field: 0.06 deg of heading
  constexpr double kRoundest = 10.0;  // largest ratio of the longer axis to the shorter axis
  const double field = c.field.value;
  for (const double centre : {c.centre_ahead.value, c.centre_left.value}) {
    const double rounded = static_cast<double>(static_cast<float>(centre));
    if (std::abs(rounded - centre) <= kRounding * field) continue;
    return refusal(
        ErrorCode::kCompassUnusable,
        fmt::format("{}: the centre of the field ellipse, {:.9g}, is too large compared with the "
                    "field {:.4g} for the firmware's float numbers (24 bits); subtract a "
                    "constant from the readings, or move the magnet away",
                    file, centre, field));
  }
  // The gain matrix S of an ellipse with the half axes a and b has the eigenvalues 1/a and 1/b. The
  // ratio of the axes is that of the eigenvalues.
  const double mean = 0.5 * (c.gain_ahead.value + c.gain_left.value);
  const double apart =
      std::hypot(0.5 * (c.gain_ahead.value - c.gain_left.value), c.gain_cross.value);
  const double ratio = (mean + apart) / (mean - apart);
  if (ratio > 0.0 && ratio <= kRoundest) return {};
  return refusal(
      ErrorCode::kCompassUnusable,
      fmt::format(
          "{}: the measured field is {:.3g} times weaker along one axis than along the other; "
          "check for a dead compass axis, or move iron away from the compass",
          file, ratio));
}

/// Converts the ellipse to the calibration in the model. The gain S is scaled to det S = 1, so that
/// the length of S (f - o) is the strength of the field, in the unit of the readings f.
CompassCalibration calibration_of(const Known& known) {
  const auto root = [](const Ellipse& e) { return std::sqrt(e.gain().determinant()); };
  const auto gain = [&](int k) {
    return with_interval(known, [&, k](const Ellipse& e) { return e.p[k] / root(e); });
  };
  return {.centre_ahead = with_interval(known, [](const Ellipse& e) { return e.p[0]; }),
          .centre_left = with_interval(known, [](const Ellipse& e) { return e.p[1]; }),
          .gain_ahead = gain(2),
          .gain_cross = gain(3),
          .gain_left = gain(4),
          .field = with_interval(known, [&](const Ellipse& e) { return 1.0 / root(e); }),
          .residual = known.residual,
          .heading_error_deg = degrees(heading_error_rad(known))};
}

Status check_ellipse(const std::string& file, const Known& fit,
                     const std::pair<double, double>& gap_rad) {
  const double gap_deg = degrees(gap_rad.second);
  if (gap_deg > kLargestGapDeg) {
    return refusal(
        ErrorCode::kCompassUnusable,
        fmt::format("{}: no reading for {:.0f} deg of the circle, counter-clockwise from the "
                    "magnetic heading {:.0f} deg, so the ellipse is uncertain there; "
                    "turn through two whole circles",
                    file, gap_deg, degrees(gap_rad.first)));
  }
  if (fit.residual > kNoEllipse) {
    return refusal(ErrorCode::kCompassUnusable,
                   fmt::format("{}: the readings deviate from the best-fit ellipse by {:.0f} % "
                               "of the field (standard deviation); record again on level ground, "
                               "away from moving iron",
                               file, 100.0 * fit.residual));
  }
  return {};
}

}  // namespace

Result<CompassFit> fit_compass(const FieldRecord& record, double declination_deg) {
  const Points points = points_of(record);
  const std::optional<Ellipse> ellipse = compass::fit_ellipse(points);
  if (!ellipse) {
    return refusal(
        ErrorCode::kCompassUnusable,
        record.file +
            ": the field readings do not form an ellipse; turn the vehicle through two whole "
            "circles on level ground, away from iron");
  }
  const std::vector<double> headings = headings_of(*ellipse, points);
  const std::pair<double, double> gap_rad = largest_gap_rad(headings);
  const Known fit = known(*ellipse, points, headings);
  AWMR_RETURN_IF_ERROR(check_ellipse(record.file, fit, gap_rad));
  CompassFit result{.calibration = calibration_of(fit)};
  AWMR_RETURN_IF_ERROR(check_usable(record.file, result.calibration));
  result.calibration.turned_deg = degrees(turned_rad(headings));
  result.calibration.largest_gap_deg = degrees(gap_rad.second);
  result.calibration.declination_deg = declination_deg;
  if (fit.residual > kLargeResidual) {
    result.findings.push_back(
        {record.file, 0, Severity::kWarning, "compass-residual",
         fmt::format(
             "the readings deviate from the best-fit ellipse by {:.1f} % of the field (standard "
             "deviation), a heading error of about {:.1f} deg; record again on level ground, "
             "away from iron",
             100.0 * fit.residual, degrees(fit.residual))});
  }
  AWMR_RETURN_IF_ERROR(check_turn(record, turned_rad(headings), result.findings));
  return result;
}

}  // namespace awmr
