#include "awmr/identify/compass/compass.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "awmr/core/index.h"
#include "awmr/core/linear_algebra.h"
#include "awmr/core/units.h"
#include "awmr/identify/uncertainty/quantiles.h"
#include "ellipse.h"

namespace awmr {
namespace {

using compass::Ellipse;
using compass::Parameters;
using compass::Points;
using Covariance = Eigen::Matrix<double, 5, 5>;

/// Residuals within one of these parts of a circle may go together.
constexpr int kSectors = 36;
/// Largest gap of headings that is accepted in a calibration turn.
constexpr double kLargestGapDeg = 30.0;
/// Beyond this share of the field something else than hard and soft iron is there.
constexpr double kLargeResidual = 0.05;
/// Beyond it there is no ellipse.
constexpr double kNoEllipse = 0.2;
/// Compass and gyroscope may differ by this share of the turn: a scale within its tolerance.
constexpr double kTurnTolerance = 0.1;

Points points_of(const FieldRecord& record) {
  Points points(rows_of(record.ahead), 2);
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    points.row(i) << record.ahead[at(i)], record.left[at(i)];
  }
  return points;
}

/// From magnetic north, counter-clockwise; by row.
std::vector<double> headings_of(const Ellipse& ellipse, const Points& points) {
  std::vector<double> headings;
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const Eigen::Vector2d c = ellipse.on_circle(points.row(i));
    headings.push_back(std::atan2(-c[1], c[0]));
  }
  return headings;
}

/// The largest part of the circle without a heading: where it begins, and its size.
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

/// The fit's parameters and how well they are known.
struct Known {
  Ellipse ellipse;
  Covariance covariance = Covariance::Zero();
  double half = 0.0;      ///< half width of a 95 % interval over the standard error
  double residual = 0.0;  ///< standard deviation
};

/// The covariance where residuals of a sector may go together: what becomes of the parameters where
/// one of the n sectors is left out. With J_s the rows of derivatives of sector s and r_s its
/// residuals,
///     D_s = (J'J - J_s'J_s)^-1 J_s' r_s,   (n - 1)/n sum over s of D_s D_s'    [Efron 1982, 3.1]
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

/// The bound of the heading's error that the covariance leaves, in the worst direction:
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

/// A function of the parameters with its interval, by central differences of it.
template <class Function>
WithInterval with_interval(const Known& known, const Function& function) {
  Parameters gradient;
  for (int k = 0; k < 5; ++k) {
    // The gains are of the size 1/field; so is what is known of the centre, times the field.
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

/// The angle from the first row to the last; rows are closer than half a turn.
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

/// Compares the turns by compass and gyroscope. Errors (refused): they turn against each other, or by
/// amounts that are more than kTurnTolerance apart.
Status check_turn(const FieldRecord& record, double turned, std::vector<Finding>& findings) {
  if (record.yaw_rate_radps.empty()) {
    findings.push_back({record.file, 0, Severity::kNote, "turn-not-checked",
                        "there is no yaw_rate_radps: that ahead is ahead and left is left was not "
                        "checked"});
    return {};
  }
  const double gyro = turned_by_gyro_rad(record);
  if (gyro * turned < 0.0) {
    return refusal(
        ErrorCode::kCompassUnusable,
        fmt::format(
            "{}: the compass turns by {:.0f} deg while the gyroscope turns by {:.0f}: one of "
            "field_ahead and field_left has the wrong sign, or they are exchanged, or "
            "yaw_rate_radps is positive to the right",
            record.file, degrees(turned), degrees(gyro)));
  }
  if (std::abs(turned - gyro) <= kTurnTolerance * std::abs(turned)) return {};
  return refusal(ErrorCode::kCompassUnusable,
                 fmt::format("{}: the compass turns by {:.0f} deg while the gyroscope turns by "
                             "{:.0f}, more than {:.0f} % "
                             "apart: check that yaw_rate_radps is in rad/s and without bias, and "
                             "that no row is missing",
                             record.file, degrees(turned), degrees(gyro), 100.0 * kTurnTolerance));
}

/// Errors (refused): the vehicle's float cannot represent the field next to the centre, or the
/// field is so much weaker along one axis that noise determines the heading.
Status check_usable(const std::string& file, const CompassCalibration& c) {
  constexpr double kRounding = 1e-3;  // of the field: 0.06 deg
  constexpr double kRoundest = 10.0;  // longer axis over the shorter one
  const double field = c.field.value;
  for (const double centre : {c.centre_ahead.value, c.centre_left.value}) {
    const double rounded = static_cast<double>(static_cast<float>(centre));
    if (std::abs(rounded - centre) <= kRounding * field) continue;
    return refusal(
        ErrorCode::kCompassUnusable,
        fmt::format("{}: the centre {:.9g} is too large compared with the field {:.4g} for the "
                    "vehicle's 24-bit numbers: subtract the offset from the readings, or "
                    "move the magnet away",
                    file, centre, field));
  }
  // S has the eigenvalues 1/a and 1/b of the axes, and a determinant of 1.
  const double mean = 0.5 * (c.gain_ahead.value + c.gain_left.value);
  const double apart =
      std::hypot(0.5 * (c.gain_ahead.value - c.gain_left.value), c.gain_cross.value);
  const double ratio = (mean + apart) / (mean - apart);
  if (ratio > 0.0 && ratio <= kRoundest) return {};
  return refusal(
      ErrorCode::kCompassUnusable,
      fmt::format(
          "{}: the field is {:.3g} times weaker along one axis than along the other: one axis "
          "of the compass is dead, or iron is too near",
          file, ratio));
}

/// det S = 1: |c| is then the field, in the unit of f.
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

}  // namespace

Result<CompassFit> fit_compass(const FieldRecord& record, double declination_deg) {
  const Points points = points_of(record);
  const std::optional<Ellipse> ellipse = compass::fit_ellipse(points);
  if (!ellipse) {
    return refusal(
        ErrorCode::kCompassUnusable,
        record.file +
            ": the field makes no ellipse: turn the vehicle through two whole circles, level, "
            "away from iron");
  }
  const std::vector<double> headings = headings_of(*ellipse, points);
  const auto [gap_begin, gap] = largest_gap_rad(headings);
  if (degrees(gap) > kLargestGapDeg) {
    return refusal(ErrorCode::kCompassUnusable,
                   fmt::format("{}: the turn leaves {:.0f} deg out, from {:.0f} deg on: an ellipse "
                               "through the rest is a guess; turn through two whole circles",
                               record.file, degrees(gap), degrees(gap_begin)));
  }
  const Known fit = known(*ellipse, points, headings);
  if (fit.residual > kNoEllipse) {
    return refusal(ErrorCode::kCompassUnusable,
                   fmt::format("{}: the field is off the best ellipse by {:.0f} % (standard "
                               "deviation): iron moved, or the vehicle was not level",
                               record.file, 100.0 * fit.residual));
  }
  CompassFit result{.calibration = calibration_of(fit)};
  AWMR_RETURN_IF_ERROR(check_usable(record.file, result.calibration));
  result.calibration.turned_deg = degrees(turned_rad(headings));
  result.calibration.largest_gap_deg = degrees(gap);
  result.calibration.declination_deg = declination_deg;
  if (fit.residual > kLargeResidual) {
    result.findings.push_back(
        {record.file, 0, Severity::kWarning, "compass-residual",
         fmt::format(
             "the field is off the best ellipse by {:.1f} % (standard deviation), which may "
             "turn the heading by {:.1f} deg: iron near by, or a vehicle that is not level",
             100.0 * fit.residual, degrees(fit.residual))});
  }
  AWMR_RETURN_IF_ERROR(check_turn(record, turned_rad(headings), result.findings));
  return result;
}

}  // namespace awmr
