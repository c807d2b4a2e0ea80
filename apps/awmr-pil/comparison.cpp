#include "comparison.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "awmr/core/units.h"

namespace awmr::pil {
namespace {

struct Sample {
  State<double> state;
  SideForces<double> force;
  double steering_command_rad;
  double tau_speed;
  double tau_turn_m;
  double psi_ref_rad;
  double fault;
};

struct Signal {
  const char* name;
  double (*of)(const Sample&);
};

constexpr std::array<Signal, 14> kSignals{{
    {"x_m", [](const Sample& s) { return s.state.x_m; }},
    {"y_m", [](const Sample& s) { return s.state.y_m; }},
    {"psi_rad", [](const Sample& s) { return s.state.psi_rad; }},
    {"heading_deg", [](const Sample& s) { return degrees(s.state.psi_rad); }},
    {"u_mps", [](const Sample& s) { return s.state.u_mps; }},
    {"v_mps", [](const Sample& s) { return s.state.v_mps; }},
    {"r_radps", [](const Sample& s) { return s.state.r_radps; }},
    {"force_left", [](const Sample& s) { return s.force.left; }},
    {"force_right", [](const Sample& s) { return s.force.right; }},
    {"steering_cmd_rad", [](const Sample& s) { return s.steering_command_rad; }},
    {"tau_speed", [](const Sample& s) { return s.tau_speed; }},
    {"tau_turn", [](const Sample& s) { return s.tau_turn_m; }},
    {"psi_ref_rad", [](const Sample& s) { return s.psi_ref_rad; }},
    {"fault", [](const Sample& s) { return s.fault; }},
}};

Sample sample_of(const LoopRow& row) {
  const AutopilotOutput& out = row.step.output;
  return {.state = row.state,
          .force = row.force,
          .steering_command_rad = row.steering_command_rad,
          .tau_speed = static_cast<double>(out.tau_speed),
          .tau_turn_m = static_cast<double>(out.tau_turn_m),
          .psi_ref_rad = static_cast<double>(out.psi_ref_rad),
          .fault = static_cast<double>(out.fault)};
}

/// Like sample_of(), but with the forces and steering angle that the executor returned. Rounding to
/// the resolution of the actuators could hide a difference.
Sample raw_sample_of(const LoopRow& row) {
  const Allocation<float>& command = row.step.output.command;
  Sample sample = sample_of(row);
  sample.force = {static_cast<double>(command.force.left),
                  static_cast<double>(command.force.right)};
  sample.steering_command_rad = static_cast<double>(command.steering_rad);
  return sample;
}

Sample sample_of(const RunRow& row) {
  return {.state = row.state,
          .force = row.force,
          .steering_command_rad = row.steering_command_rad,
          .tau_speed = row.tau_speed,
          .tau_turn_m = row.tau_turn_m,
          .psi_ref_rad = row.psi_ref_rad,
          .fault = 0.0};
}

/// Absolute difference of two values of a signal. Reference angles can differ by whole turns and
/// still have the same direction, so their difference is computed modulo one turn.
double apart(const Signal& signal, double a, double b) {
  if (std::isfinite(a) != std::isfinite(b)) return std::numeric_limits<double>::infinity();
  const double off = a - b;
  const bool is_reference = std::string_view(signal.name) == "psi_ref_rad";
  return std::abs(is_reference ? std::remainder(off, 2.0 * pi<double>()) : off);
}

Difference difference_of(const std::vector<Sample>& a, const std::vector<Sample>& b) {
  Difference result;
  result.same_length = a.size() == b.size();
  const std::size_t rows = std::min(a.size(), b.size());
  for (const Signal& signal : kSignals) {
    double largest = 0.0;
    for (std::size_t i = 0; i < rows; ++i) {
      largest = std::max(largest, apart(signal, signal.of(a[i]), signal.of(b[i])));
    }
    result.signals.emplace_back(signal.name, largest);
  }
  return result;
}

template <class Row, class Of>
std::vector<Sample> samples_of(const std::vector<Row>& rows, Of of) {
  std::vector<Sample> samples;
  samples.reserve(rows.size());
  for (const Row& row : rows) samples.push_back(of(row));
  return samples;
}

}  // namespace

double Difference::largest() const {
  double largest = 0.0;
  for (const auto& [name, value] : signals) {
    // Skips heading_deg, which repeats psi_rad in degrees. All signals must be in SI units, because
    // the largest difference is compared with one bound.
    if (name != "heading_deg") largest = std::max(largest, value);
  }
  return largest;
}

double Difference::of(const std::string& signal) const {
  for (const auto& [name, value] : signals) {
    if (name == signal) return value;
  }
  return std::numeric_limits<double>::infinity();
}

double heading_apart_deg(const std::vector<LoopRow>& a, const Run& b) {
  const std::size_t rows = std::min(a.size(), b.rows.size());
  double largest_rad = 0.0;
  for (std::size_t i = 0; i < rows; ++i) {
    double lo = b.rows[i].state.psi_rad;
    double hi = lo;
    for (const std::size_t near : {std::max<std::size_t>(i, 1) - 1, std::min(i + 1, rows - 1)}) {
      lo = std::min(lo, b.rows[near].state.psi_rad);
      hi = std::max(hi, b.rows[near].state.psi_rad);
    }
    const double psi_rad = a[i].state.psi_rad;
    if (!std::isfinite(psi_rad) || !std::isfinite(lo) || !std::isfinite(hi)) {
      return std::numeric_limits<double>::infinity();
    }
    largest_rad = std::max({largest_rad, lo - psi_rad, psi_rad - hi});
  }
  return degrees(largest_rad);
}

Difference difference(const std::vector<LoopRow>& a, const std::vector<LoopRow>& b) {
  return difference_of(samples_of(a, raw_sample_of), samples_of(b, raw_sample_of));
}

Difference difference(const std::vector<LoopRow>& a, const Run& b) {
  return difference_of(samples_of(a, [](const LoopRow& row) { return sample_of(row); }),
                       samples_of(b.rows, [](const RunRow& row) { return sample_of(row); }));
}

Cycles cycles_of(const std::vector<LoopRow>& rows) {
  Cycles cycles{.min = std::numeric_limits<unsigned>::max()};
  double sum = 0.0;
  double count = 0.0;
  for (const LoopRow& row : rows) {
    if (!row.step.cycles) continue;
    cycles.min = std::min(cycles.min, *row.step.cycles);
    cycles.max = std::max(cycles.max, *row.step.cycles);
    sum += *row.step.cycles;
    count += 1.0;
  }
  cycles.mean = sum / std::max(count, 1.0);
  return cycles;
}

}  // namespace awmr::pil
