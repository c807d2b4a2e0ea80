#include "awmr/trials/calibration_checks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "awmr/core/option_text.h"
#include "awmr/core/statistics/linear_algebra.h"
#include "awmr/core/statistics/sample_quantile.h"
#include "awmr/core/units.h"
#include "awmr/trials/checks/log_evidence.h"

namespace awmr {
namespace {

using Complex = std::complex<double>;

/// A fit below returns empty if a channel is missing, if there are fewer windows than this, or if
/// the windows do not determine the result.
constexpr std::size_t kMinWindows = 15;
// Errors above this number of standard errors are significant.
constexpr double kSignificance = 5.0;
constexpr double kMinScale = 0.03;
constexpr double kMinOffset_rad = 0.0175;

/// Divides the log into about `count` windows of 1 to 5 s. In a shorter window, the noise of the
/// first and last reading matters more. In a longer window, errors by sideslip and heading
/// accumulate.
std::vector<LogWindow> calibration_windows(const DrivingLog& log, double count = 20.0) {
  constexpr double kShortest_s = 1.0;
  constexpr double kLongest_s = 5.0;
  const double duration_s = log.t_s.back() - log.t_s.front();
  return evidence_rows(log, std::clamp(duration_s / count, kShortest_s, kLongest_s));
}

bool has_all(const DrivingLog& log, std::initializer_list<LogChannel> channels) {
  return std::ranges::all_of(channels, [&](LogChannel c) { return log[c].has_value(); });
}

struct Regression {
  Eigen::VectorXd coefficients;
  Eigen::VectorXd std_errors;
  double scatter = 0.0;  ///< standard deviation of the residuals without outliers
};

/// Indices of the residuals within four standard deviations; the others are outliers. Estimates the
/// standard deviation from the median of the magnitudes, which outliers hardly change.
std::vector<Eigen::Index> usual_rows(const Eigen::VectorXd& residuals) {
  std::vector<double> sizes(residuals.data(), residuals.data() + residuals.size());
  for (double& size : sizes) size = std::abs(size);
  const double limit = 4.0 * kStdPerMad * median(std::move(sizes));
  std::vector<Eigen::Index> rows;
  for (Eigen::Index i = 0; i < residuals.size(); ++i) {
    if (std::abs(residuals(i)) <= limit) rows.push_back(i);
  }
  return rows;
}

/// Fits y = X k by least squares in three rounds, without outliers in the second and the third
/// round. Empty if X is rank-deficient, or if the remaining rows are at most twice as many as the
/// coefficients.
std::optional<Regression> regression(const Eigen::MatrixXd& x, const Eigen::VectorXd& y) {
  constexpr int kRounds = 3;
  Regression found;
  std::vector<Eigen::Index> rows(static_cast<std::size_t>(y.size()));
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = static_cast<Eigen::Index>(i);
  for (int round = 0; round < kRounds; ++round) {
    const auto count = static_cast<Eigen::Index>(rows.size());
    if (count <= 2 * x.cols()) return std::nullopt;
    const Eigen::MatrixXd some = x(rows, Eigen::all);
    const PivotedQr qr(some);
    if (qr.rank() < x.cols()) return std::nullopt;
    found.coefficients = qr.solve(Eigen::VectorXd(y(rows)));
    const Eigen::VectorXd residuals = y(rows) - some * found.coefficients;
    const double variance = residuals.squaredNorm() / static_cast<double>(count - x.cols());
    found.scatter = std::sqrt(variance);
    found.std_errors = (variance * qr.inverse_information().diagonal()).cwiseSqrt();
    rows = usual_rows(y - x * found.coefficients);
  }
  return found;
}

/// Displacement of the position in one window (`moved`), and the integrals over the window that
/// explain it. calibration_checks.h defines them as a (`driven`), b (`turned`), c (`slipped`) and d
/// (`hastened`).
struct CourseWindow {
  Complex moved, driven, turned, slipped, hastened;
};

/// Computes the displacement and the integrals of one window. `psi`: heading of each row, rad.
CourseWindow course_window(const DrivingLog& log, const LogWindow& window,
                           const std::vector<double>& psi) {
  const std::vector<double>& x = log[LogChannel::kX]->value;
  const std::vector<double>& y = log[LogChannel::kY]->value;
  const std::vector<double>& u = log[LogChannel::kSpeed]->value;
  const auto& rate = log[LogChannel::kYawRate];
  const std::size_t last = window.end - 1;
  CourseWindow sums{{x[last] - x[window.begin], y[last] - y[window.begin]}, 0, 0, 0, 0};
  for (std::size_t i = window.begin; i < last; ++i) {
    const double h = log.t_s[i + 1] - log.t_s[i];
    const double speed = 0.5 * (u[i] + u[i + 1]);
    const Complex ahead = std::polar(1.0, 0.5 * (psi[i] + psi[i + 1]));
    const double turn =
        rate ? 0.5 * (rate->value[i] + rate->value[i + 1]) * h : psi[i + 1] - psi[i];
    sums.driven += speed * h * ahead;
    sums.turned += turn * ahead;
    sums.slipped += speed * turn * ahead;
    sums.hastened += (u[i + 1] - u[i]) * ahead;
  }
  return sums;
}

struct CourseFit {
  Complex factor;  ///< k = s exp(i phi)
  /// Standard error of the real or of the imaginary part of k, whichever is larger.
  double std_error = 0.0;
  double scatter_m = 0.0;  ///< standard deviation of the residuals, m
};

/// Fits the complex factor k between measured and integrated displacement (calibration_checks.h).
/// `heading_factor` multiplies the headings, to test another scale of the heading.
std::optional<CourseFit> course_fit(const DrivingLog& log, double heading_factor = 1.0) {
  using enum LogChannel;
  if (!has_all(log, {kX, kY, kSpeed, kHeading})) return std::nullopt;
  const std::vector<LogWindow> windows = calibration_windows(log);
  if (windows.size() < kMinWindows) return std::nullopt;
  std::vector<double> psi = log[LogChannel::kHeading]->value;
  for (double& heading : psi) heading *= heading_factor;
  // The complex equation of the fit becomes two real equations. A term k a with k = p + i q gives
  // Re(k a) = p Re a - q Im a and Im(k a) = p Im a + q Re a.
  constexpr Eigen::Index kTerms = 4;
  Eigen::MatrixXd left(2 * static_cast<Eigen::Index>(windows.size()), 2 * kTerms);
  Eigen::VectorXd right(left.rows());
  for (std::size_t w = 0; w < windows.size(); ++w) {
    const CourseWindow sums = course_window(log, windows[w], psi);
    const auto row = 2 * static_cast<Eigen::Index>(w);
    const Complex terms[kTerms] = {sums.driven, sums.turned, sums.slipped, sums.hastened};
    for (Eigen::Index i = 0; i < kTerms; ++i) {
      const Complex term = terms[i];
      left.block(row, 2 * i, 2, 2) << term.real(), -term.imag(), term.imag(), term.real();
    }
    right(row) = sums.moved.real();
    right(row + 1) = sums.moved.imag();
  }
  const auto found = regression(left, right);
  if (!found) return std::nullopt;
  return CourseFit{{found->coefficients(0), found->coefficients(1)},
                   std::max(found->std_errors(0), found->std_errors(1)),
                   found->scatter};
}

/// Ratio s of the position's scale to the speed's scale, for a log without heading
/// (calibration_checks.h).
std::optional<Calibration> distance_scale(const DrivingLog& log) {
  using enum LogChannel;
  if (!has_all(log, {kX, kY, kSpeed, kYawRate})) return std::nullopt;
  const std::vector<LogWindow> windows = calibration_windows(log);
  if (windows.size() < kMinWindows) return std::nullopt;
  const std::vector<double> psi = integrated_rate(log);
  Eigen::MatrixXd left(static_cast<Eigen::Index>(windows.size()), 7);
  Eigen::VectorXd right(left.rows());
  for (std::size_t w = 0; w < windows.size(); ++w) {
    const CourseWindow sums = course_window(log, windows[w], psi);
    const Complex a = sums.driven;
    const Complex with_b = a * std::conj(sums.turned);
    const auto row = static_cast<Eigen::Index>(w);
    left.row(row) << std::norm(a), with_b.real(), with_b.imag(), std::norm(sums.turned),
        (a * std::conj(sums.slipped)).imag(), (a * std::conj(sums.hastened)).real(), 1.0;
    right(row) = std::norm(sums.moved);
  }
  const auto found = regression(left, right);
  if (!found || !(found->coefficients(0) > 0.0)) return std::nullopt;
  const double scale = std::sqrt(found->coefficients(0));
  return Calibration{scale, 0.5 * found->std_errors(0) / scale};
}

/// Ratio k of the change of heading to the integral of the yaw rate (calibration_checks.h).
std::optional<Calibration> heading_over_rate(const DrivingLog& log) {
  if (!log[LogChannel::kHeading] || !log[LogChannel::kYawRate]) return std::nullopt;
  const std::vector<LogWindow> windows = calibration_windows(log);
  if (windows.size() < kMinWindows) return std::nullopt;
  const std::vector<double>& psi = log[LogChannel::kHeading]->value;
  const std::vector<double>& rate = log[LogChannel::kYawRate]->value;
  Eigen::MatrixXd left(static_cast<Eigen::Index>(windows.size()), 3);
  Eigen::VectorXd right(left.rows());
  for (std::size_t w = 0; w < windows.size(); ++w) {
    const std::size_t first = windows[w].begin;
    const std::size_t last = windows[w].end - 1;
    const auto row = static_cast<Eigen::Index>(w);
    left(row, 0) = integral_of(log, LogChannel::kYawRate, windows[w]);
    left(row, 1) = log.t_s[last] - log.t_s[first];
    left(row, 2) = rate[last] - rate[first];
    right(row) = psi[last] - psi[first];
  }
  const auto found = regression(left, right);
  if (!found) return std::nullopt;
  return Calibration{found->coefficients(0), found->std_errors(0)};
}

/// Ratio k of the change of the course over ground to the change of the heading psi
/// (calibration_checks.h). Without a heading, psi is the integral of the yaw rate.
std::optional<Calibration> course_over_heading(const DrivingLog& log) {
  // Leaves out windows with a displacement below this fraction of the longest displacement, because
  // noise makes their direction uncertain.
  constexpr double kMoving = 0.3;
  constexpr double kWindows = 60.0;
  if (!has_all(log, {LogChannel::kX, LogChannel::kY, LogChannel::kSpeed})) return std::nullopt;
  const std::vector<double> psi = headings_of(log);
  if (psi.empty()) return std::nullopt;
  const std::vector<LogWindow> windows = calibration_windows(log, kWindows);
  std::vector<CourseWindow> sums;
  double longest_m = 0.0;
  for (const LogWindow& window : windows) {
    sums.push_back(course_window(log, window, psi));
    longest_m = std::max(longest_m, std::abs(sums.back().moved));
  }
  std::vector<double> angles_rad;
  std::vector<Eigen::RowVector4d> rows;  // regressors of each window: psi, change of psi, time, 1
  double before_rad = 0.0;
  for (std::size_t w = 0; w < windows.size(); ++w) {
    if (!(std::abs(sums[w].moved) > kMoving * longest_m)) continue;
    const double angle_rad = std::arg(sums[w].moved * std::conj(sums[w].driven));
    before_rad += std::remainder(angle_rad - before_rad, 2.0 * std::numbers::pi);
    angles_rad.push_back(before_rad);
    const std::size_t first = windows[w].begin;
    const std::size_t last = windows[w].end - 1;
    rows.emplace_back(0.5 * (psi[first] + psi[last]), psi[last] - psi[first], log.t_s[first], 1.0);
  }
  if (rows.size() < kMinWindows) return std::nullopt;
  Eigen::MatrixXd left(static_cast<Eigen::Index>(rows.size()), 4);
  for (std::size_t i = 0; i < rows.size(); ++i) left.row(static_cast<Eigen::Index>(i)) = rows[i];
  const Eigen::VectorXd right = Eigen::Map<Eigen::VectorXd>(angles_rad.data(), left.rows());
  const auto found = regression(left, right);
  if (!found) return std::nullopt;
  return Calibration{1.0 + found->coefficients(0), found->std_errors(0)};
}

bool is_off_one(const Calibration& scale) {
  const double off = std::abs(scale.value - 1.0);
  return off > kMinScale && off > kSignificance * scale.std_error;
}

Finding scale_finding(const DrivingLog& log, std::string message) {
  return {log.file, 0, Severity::kWarning, "scale-mismatch", std::move(message)};
}

/// Decides whether the scale of the yaw rate or of the heading is wrong. The channel that agrees
/// with the positions is right.
enum class ChannelAtFault { kYawRate, kHeading, kEither };
ChannelAtFault channel_at_fault(const DrivingLog& log, const Calibration& scale) {
  constexpr double kClearly = 0.7;
  const auto as_it_is = course_fit(log);
  const auto by_rate = course_fit(log, 1.0 / scale.value);
  if (!as_it_is || !by_rate) return ChannelAtFault::kEither;
  if (as_it_is->scatter_m < kClearly * by_rate->scatter_m) return ChannelAtFault::kYawRate;
  if (by_rate->scatter_m < kClearly * as_it_is->scatter_m) return ChannelAtFault::kHeading;
  return ChannelAtFault::kEither;
}

std::optional<Finding> rate_mismatch(const DrivingLog& log,
                                     std::span<const ColumnMapping> mappings) {
  const auto scale = heading_over_rate(log);
  if (!scale || !is_off_one(*scale)) return std::nullopt;
  const std::string compared =
      fmt::format("heading_deg changes by {:.3f} +- {:.3f} times the integral of yaw_rate_radps",
                  scale->value, scale->std_error);
  const std::string rate = mapping_option(mappings, "yaw_rate_radps", scale->value);
  const std::string heading = mapping_option(mappings, "heading_deg", 1.0 / scale->value);
  switch (channel_at_fault(log, *scale)) {
    case ChannelAtFault::kYawRate:
      return scale_finding(log,
                           fmt::format("{}, and the positions agree with the heading: the scale of "
                                       "the gyroscope is wrong; map it with {}",
                                       compared, rate));
    case ChannelAtFault::kHeading:
      return scale_finding(log,
                           fmt::format("{}, and the positions agree with the yaw rate: the scale "
                                       "of the heading is wrong; map it with {}",
                                       compared, heading));
    case ChannelAtFault::kEither:
      break;
  }
  return scale_finding(log,
                       fmt::format("{}, so one of them has a wrong scale: if it is the gyroscope, "
                                   "map its column with {}; if it is the heading, map its column "
                                   "with {}",
                                   compared, rate, heading));
}

/// Finding for heading and yaw rate that agree with each other, but not with the positions.
std::optional<Finding> turn_mismatch(const DrivingLog& log,
                                     std::span<const ColumnMapping> mappings) {
  const auto scale = course_over_heading(log);
  if (!scale || !is_off_one(*scale)) return std::nullopt;
  std::vector<std::string> columns;
  std::vector<std::string> options;
  for (const LogChannel channel : {LogChannel::kHeading, LogChannel::kYawRate}) {
    if (!log[channel]) continue;
    columns.emplace_back(info(channel).column);
    options.push_back(mapping_option(mappings, info(channel).column, scale->value));
  }
  return scale_finding(
      log,
      fmt::format("according to the positions, the vehicle turns {:.3f} +- {:.3f} times as far as "
                  "according to {}: wrong scale (track width of the odometry, or gyroscope). "
                  "Correct it with {}",
                  scale->value, scale->std_error, fmt::join(columns, " and "),
                  fmt::join(options, " and ")));
}

/// Finding for a speed whose scale differs from that of the positions. `scale`: s of
/// calibration_checks.h.
std::optional<Finding> speed_mismatch(const DrivingLog& log, const Calibration& scale,
                                      std::span<const ColumnMapping> mappings) {
  if (!is_off_one(scale)) return std::nullopt;
  return scale_finding(
      log,
      fmt::format("x_m and y_m move by {:.3f} +- {:.3f} times the integral of speed_mps: the scale "
                  "of the speed is wrong (wheel radius, gear, slip; map it with {}) or that of the "
                  "positions (map them with {} and {})",
                  scale.value, scale.std_error, mapping_option(mappings, "speed_mps", scale.value),
                  mapping_option(mappings, "x_m", 1.0 / scale.value),
                  mapping_option(mappings, "y_m", 1.0 / scale.value)));
}

std::optional<Calibration> offset_of(const CourseFit& course) {
  const double size = std::abs(course.factor);
  if (!(size > kSignificance * course.std_error)) return std::nullopt;
  const Calibration offset{std::arg(course.factor), course.std_error / size};
  const bool is_there = std::abs(offset.value) > kMinOffset_rad &&
                        std::abs(offset.value) > kSignificance * offset.std_error;
  return is_there ? std::optional(offset) : std::nullopt;
}

}  // namespace

std::optional<Calibration> heading_offset_rad(const DrivingLog& log) {
  const auto course = course_fit(with_interpolated_values(log));
  return course ? offset_of(*course) : std::nullopt;
}

std::optional<Calibration> gyro_bias_radps(const DrivingLog& measured) {
  if (!has_all(measured, {LogChannel::kHeading, LogChannel::kYawRate})) return std::nullopt;
  const DrivingLog log = with_interpolated_values(measured);
  std::vector<double> offsets;
  for (const LogWindow& window : windows_of(log, kEvidenceWindow_s)) {
    const std::vector<double>& heading = log[LogChannel::kHeading]->value;
    const double span_s = log.t_s[window.end - 1] - log.t_s[window.begin];
    const double turned = heading[window.end - 1] - heading[window.begin];
    offsets.push_back((integral_of(log, LogChannel::kYawRate, window) - turned) / span_s);
  }
  if (offsets.size() < 10) return std::nullopt;
  const double bias = median(offsets);
  // The standard error of a median is sqrt(pi/2) = 1.2533 times that of a mean.
  const double error = 1.2533 * kStdPerMad * median_absolute_deviation(offsets, bias) /
                       std::sqrt(static_cast<double>(offsets.size()));
  if (!(std::abs(bias) > kSignificance * error)) return std::nullopt;
  return Calibration{bias, error};
}

std::vector<Finding> calibration_findings(const DrivingLog& measured,
                                          std::span<const ColumnMapping> mappings) {
  const DrivingLog log = with_interpolated_values(measured);
  std::vector<Finding> findings;
  if (auto rate = rate_mismatch(log, mappings)) {
    findings.push_back(*std::move(rate));
  } else if (auto turn = turn_mismatch(log, mappings)) {
    // The comparisons below use the heading, so its wrong scale would also make them report errors.
    return {*std::move(turn)};
  }
  const auto course = course_fit(log);
  const auto scale = course
                         ? std::optional(Calibration{std::abs(course->factor), course->std_error})
                         : distance_scale(log);
  if (scale) {
    if (auto speed = speed_mismatch(log, *scale, mappings)) findings.push_back(*std::move(speed));
  }
  if (!course) return findings;
  if (const auto offset = offset_of(*course)) {
    findings.push_back(
        {log.file, 0, Severity::kWarning, "heading-offset",
         fmt::format("the course over ground (direction of motion) differs from heading_deg by "
                     "{:+.2f} +- {:.2f} deg (left positive): the compass is rotated in the "
                     "vehicle, the magnetic declination was not added, or the vehicle drifts to "
                     "one side. The fit estimates this offset, as with {}; to avoid it, align the "
                     "compass or map heading_deg with the offset",
                     degrees(offset->value), degrees(offset->std_error),
                     option_text("fit bias.heading_deg"))});
  }
  return findings;
}

}  // namespace awmr
