#include "awmr/identify/planning/suggest.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "awmr/core/units.h"
#include "awmr/model/steady.h"
#include "awmr/trials/replay.h"

namespace awmr {
namespace {

/// How little is known of a parameter that the model has no error for: a factor of e^2, so that a
/// trial which shows it counts.
constexpr double kUnknownStd = 2.0;

bool is_exponent(ParameterId id) {
  return id == ParameterId::kSurgeBeta || id == ParameterId::kYawBeta;
}

/// A trial that could be recorded, and what it would measure, in units of its noise.
struct Candidate {
  SuggestedTrial trial;
  std::function<std::vector<double>(const Plant<double>&)> standardised;
};

class Suggester {
 public:
  Suggester(const Model& model, const SuggestOptions& options)
      : model_(model), options_(options) {}

  Result<Suggestion> run() {
    const auto plant = model_.plant();
    if (!plant) return tl::unexpected(plant.error());
    plant_ = *plant;
    list_parameters();
    if (ids_.empty()) {
      return input_error(model_.file + ":/covariance",
                         "no parameter has an uncertainty that a trial could shrink");
    }
    if (auto found = set_target(); !found) return tl::unexpected(found.error());
    list_candidates();
    for (Candidate& candidate : candidates_) weigh(candidate);
    // Best first; a tie in the target goes to the larger gain of information.
    std::stable_sort(suggestion_.trials.begin(), suggestion_.trials.end(),
                     [](const SuggestedTrial& a, const SuggestedTrial& b) {
                       if (a.std_error_after != b.std_error_after) {
                         return a.std_error_after < b.std_error_after;
                       }
                       return a.d_gain > b.d_gain;
                     });
    return std::move(suggestion_);
  }

 private:
  /// The coordinates: logarithms, exponents as they are. Known covariance, and what has none.
  void list_parameters() {
    std::vector<ParameterId> known = model_.covariance.parameters;
    for (const ParameterId id : known) ids_.push_back(id);
    for (const ParameterInfo& parameter : parameter_table()) {
      if (parameter.term) continue;
      const bool listed = std::find(known.begin(), known.end(), parameter.id) != known.end();
      if (!listed && model_[parameter.id].source != Source::kGiven) ids_.push_back(parameter.id);
    }
    const auto n = static_cast<Eigen::Index>(ids_.size());
    covariance_ = Eigen::MatrixXd::Zero(n, n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const double value = *model_[ids_[static_cast<std::size_t>(i)]].value;
      if (static_cast<std::size_t>(i) >= known.size()) {
        covariance_(i, i) = kUnknownStd * kUnknownStd;
        continue;
      }
      for (Eigen::Index j = 0; j < static_cast<Eigen::Index>(known.size()); ++j) {
        const double other = *model_[ids_[static_cast<std::size_t>(j)]].value;
        covariance_(i, j) =
            model_.covariance.matrix[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] /
            (scale(ids_[static_cast<std::size_t>(i)], value) *
             scale(ids_[static_cast<std::size_t>(j)], other));
      }
    }
    // m' and I'z from one coast-down are one number: a hair of independent error keeps C
    // invertible, and a measured I'z able to part them.
    constexpr double kHair = 1e-4;
    covariance_.diagonal().array() += kHair * kHair;
  }

  static double scale(ParameterId id, double value) { return is_exponent(id) ? 1.0 : value; }

  Plant<double> moved(std::size_t parameter, double step) const {
    Model model = model_;
    Estimate& estimate = model[ids_[parameter]];
    estimate.value =
        is_exponent(ids_[parameter]) ? *estimate.value + step : *estimate.value * std::exp(step);
    return *model.plant();
  }

  template <class F>
  Eigen::MatrixXd jacobian(F values_at) const {
    constexpr double kStep = 1e-4;
    const std::vector<double> centre = values_at(plant_);
    Eigen::MatrixXd j(static_cast<Eigen::Index>(centre.size()),
                      static_cast<Eigen::Index>(ids_.size()));
    for (std::size_t i = 0; i < ids_.size(); ++i) {
      const std::vector<double> high = values_at(moved(i, kStep));
      const std::vector<double> low = values_at(moved(i, -kStep));
      for (std::size_t r = 0; r < centre.size(); ++r) {
        j(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(i)) =
            (high[r] - low[r]) / (2.0 * kStep);
      }
    }
    return j;
  }

  /// The gradient of what is to become surer; all parameters alike for A-optimality.
  Status set_target() {
    const auto n = static_cast<Eigen::Index>(ids_.size());
    if (options_.parameter.empty()) {
      suggestion_.criterion =
          "A-optimal: root sum of the squared relative standard errors of all parameters";
      target_ = Eigen::MatrixXd::Identity(n, n);
      target_scale_ = 1.0;
      target_name_ = "all (relative)";
      return {};
    }
    for (const SuggestTarget& metric : options_.metrics) {
      if (metric.name != options_.parameter) continue;
      target_ = jacobian([&](const Plant<double>& p) { return std::vector{metric.value(p)}; });
      target_scale_ = 1.0;
      target_name_ = metric.name;
      suggestion_.criterion = fmt::format("standard error of the closed loop's {}", metric.name);
      return {};
    }
    const auto id = parameter_by_name(options_.parameter);
    const auto place = id ? std::find(ids_.begin(), ids_.end(), *id) : ids_.end();
    if (place == ids_.end()) {
      std::string names;
      for (const ParameterId known : ids_) names += fmt::format("{} ", info(known).name);
      for (const SuggestTarget& metric : options_.metrics) names += metric.name + " ";
      return input_error("--parameter", fmt::format("'{}' is nothing that this model is unsure of; "
                                                    "there are: {}",
                                                    options_.parameter, names));
    }
    target_ = Eigen::MatrixXd::Zero(1, n);
    target_(0, place - ids_.begin()) = 1.0;
    target_scale_ = scale(*id, *model_[*id].value);
    target_name_ = options_.parameter;
    suggestion_.criterion = fmt::format("standard error of {}", options_.parameter);
    return {};
  }

  double target_error(const Eigen::MatrixXd& covariance) const {
    return target_scale_ * std::sqrt((target_ * covariance * target_.transpose()).trace());
  }

  /// The scatter of the model's own rows of this kind, over their rate; 5 % where there are none.
  double row_noise(TrialKind kind) const {
    double squares = 0.0;
    int count = 0;
    for (const TrialPoint& trial : model_.record.trials) {
      if (trial.kind != kind || !trial.predicted) continue;
      const double relative = *trial.predicted / trial.measured - 1.0;
      squares += relative * relative;
      ++count;
    }
    constexpr double kOtherwise = 0.05;
    return count > 2 && squares > 0.0 ? std::sqrt(squares / (count - 2)) : kOtherwise;
  }

  void add(Candidate candidate) { candidates_.push_back(std::move(candidate)); }

  void list_candidates() {
    const Vehicle& v = model_.vehicle;
    const double most = v.wheel_force.hi;
    const double surge_noise = row_noise(TrialKind::kSurge);
    const double turning_noise = row_noise(TrialKind::kTurning);
    const double repeats = options_.repeats;
    suggestion_.assumptions = {
        fmt::format("steady speeds scatter by {:.2g} of their value, yaw rates by {:.2g}: what "
                    "this model's own rows do, or 0.05",
                    surge_noise, turning_noise),
        fmt::format("logs and curves at 100 Hz with {:g} m/s, {:.2g} rad/s, {:.2g} rad; position "
                    "{:g} m at {:g} Hz",
                    options_.sensors.speed_mps, options_.sensors.yaw_rate_radps,
                    options_.sensors.heading_rad, options_.sensors.position_m,
                    options_.sensors.position_rate_hz),
        fmt::format("{} runs of each", options_.repeats)};
    for (const double share : {0.05, 0.1, 0.2, 0.35, 0.5, 0.75, 1.0}) {
      const double tau = 4.0 * most * share;
      add({.trial = {.kind = TrialKind::kSurge,
                     .settings =
                         fmt::format("straight, tau_speed {:.3g} (F' = {:.3g}), {} runs over "
                                     "10 m after reaching steady speed",
                                     tau, most * share, options_.repeats),
                     .numbers = {{"tau_speed", tau}, {"runs", repeats}}},
           .standardised = [=](const Plant<double>& p) {
             const double u = steady_rate(p.surge, tau - 4.0 * p.wheel_dead_zone).value_or(1e-6);
             return std::vector{std::sqrt(repeats) * std::log(u) / surge_noise};
           }});
    }
    for (const double angle_share : {0.25, 0.5, 1.0}) {
      for (const double force_share : {0.2, 0.5, 1.0}) {
        const double angle = radians(v.steering_max_deg) * angle_share;
        const double force = most * force_share;
        add({.trial = {.kind = TrialKind::kTurning,
                       .settings = fmt::format("steering {:.3g} deg, F' = {:.3g}, {} full turns",
                                               degrees(angle), force, options_.repeats),
                       .numbers = {{"steering_deg", degrees(angle)},
                                   {"wheel_force", force},
                                   {"runs", repeats}}},
             .standardised = [=](const Plant<double>& p) {
               const double tau = 2.0 * p.front_axle_m * std::max(0.0, force - p.wheel_dead_zone) *
                                  std::sin(angle);
               const double r = steady_rate(p.yaw, tau).value_or(1e-6);
               return std::vector{std::sqrt(repeats) * std::log(r) / turning_noise};
             }});
      }
    }
    add_coastdown();
    add_log("straight starts and stops", true, 30.0);
    add_log("thrust and steering steps, both sides apart at times", false, 30.0);
    add_log("thrust and steering steps, both sides apart at times", false, 120.0);
  }

  void add_coastdown() {
    const double top =
        steady_rate(plant_.surge, 4.0 * (model_.vehicle.wheel_force.hi - plant_.wheel_dead_zone))
            .value_or(1.0);
    for (const double share : {0.5, 1.0}) {
      const double from = share * top;
      const double noise = options_.sensors.speed_mps / std::sqrt(options_.repeats);
      const double duration_s =
          std::min(10.0, 1.2 * stop_time_s(plant_.surge, plant_.mass_norm, from).value_or(5.0));
      add({.trial = {.kind = TrialKind::kCoastdown,
                     .settings = fmt::format("motors off from {:.3g} m/s, speed recorded at 100 Hz "
                                             "to rest ({:.2g} s), {} runs",
                                             from, duration_s, options_.repeats),
                     .numbers = {{"initial_speed_mps", from},
                                 {"duration_s", duration_s},
                                 {"rate_hz", 100.0},
                                 {"runs", static_cast<double>(options_.repeats)}}},
           .standardised = [=](const Plant<double>& p) {
             Random none(1, 1);
             std::vector<double> values =
                 simulate_coastdown(p, from, duration_s, 100.0, 0.0, 0.0, none).speed_mps;
             for (double& value : values) value /= noise;
             return values;
           }});
    }
  }

  void add_log(const std::string& what, bool straight, double duration_s) {
    const Vehicle vehicle = model_.vehicle;
    const SensorNoise sensors = options_.sensors;
    add({.trial = {.kind = TrialKind::kLog,
                   .settings = fmt::format("{}, new levels every 1.5 s, {:g} s logged at 100 Hz",
                                           what, duration_s),
                   .numbers = {{"duration_s", duration_s}, {"rate_hz", 100.0}, {"runs", 1.0}}},
         .standardised = [=](const Plant<double>& p) {
           Random none(1, 1);
           SensorNoise silent = sensors;
           silent.speed_mps = silent.yaw_rate_radps = silent.heading_rad = silent.position_m = 0.0;
           const DrivingLog log = simulate_log(
               p, vehicle, {.duration_s = duration_s, .straight = straight}, silent, none);
           std::vector<double> values;
           const auto take = [&](LogChannel channel, double noise) {
             for (std::size_t row = 0; row < log.rows(); ++row) {
               if (log[channel]->fresh[row]) values.push_back(log[channel]->value[row] / noise);
             }
           };
           take(LogChannel::kSpeed, sensors.speed_mps);
           take(LogChannel::kYawRate, sensors.yaw_rate_radps);
           take(LogChannel::kHeading, sensors.heading_rad);
           return values;
         }});
  }

  void weigh(Candidate& candidate) {
    const Eigen::MatrixXd j = jacobian(candidate.standardised);
    const auto n = covariance_.rows();
    const Eigen::MatrixXd before = covariance_.ldlt().solve(Eigen::MatrixXd::Identity(n, n));
    const Eigen::MatrixXd after =
        (before + j.transpose() * j).ldlt().solve(Eigen::MatrixXd::Identity(n, n));
    SuggestedTrial trial = candidate.trial;
    trial.parameter = target_name_;
    trial.std_error_before = target_error(covariance_);
    trial.std_error_after = target_error(after);
    const auto log_det = [](const Eigen::MatrixXd& m) {
      return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(m)
          .eigenvalues()
          .array()
          .max(1e-300)
          .log()
          .sum();
    };
    trial.d_gain = log_det(covariance_) - log_det(after);
    suggestion_.trials.push_back(std::move(trial));
  }

  const Model& model_;
  const SuggestOptions& options_;
  Plant<double> plant_{};
  std::vector<ParameterId> ids_;
  Eigen::MatrixXd covariance_;
  Eigen::MatrixXd target_;
  double target_scale_ = 1.0;
  std::string target_name_;
  std::vector<Candidate> candidates_;
  Suggestion suggestion_;
};

}  // namespace

Result<Suggestion> suggest(const Model& model,
                           const SuggestOptions& options) {
  return Suggester(model, options).run();
}

std::string field_sheet(const Suggestion& suggestion, std::size_t most) {
  std::string text = fmt::format("FIELD SHEET    ranked by: {}\n", suggestion.criterion);
  for (const std::string& assumption : suggestion.assumptions) {
    text += fmt::format("  assumed: {}\n", assumption);
  }
  text += '\n';
  int number = 1;
  for (const SuggestedTrial& trial : suggestion.trials) {
    if (static_cast<std::size_t>(number) > most) break;
    text += fmt::format("[ ] {}. {:<9} {}\n", number++, name_in(kTrialKindNames, trial.kind), trial.settings);
    text +=
        fmt::format("       {}: standard error {:.3g} -> {:.3g};  information +{:.1f}\n",
                    trial.parameter, trial.std_error_before, trial.std_error_after, trial.d_gain);
  }
  return text;
}

}  // namespace awmr
