#include "awmr/report/metric_words.h"

#include <algorithm>
#include <array>

namespace awmr {
namespace {

struct MetricEntry {
  std::string_view name;
  std::string_view words;
  std::string_view unit;
};

constexpr std::array<MetricEntry, 19> kMetricEntries{{
    {"settling_time_s", "settling time", "s"},
    {"overshoot_deg", "overshoot", "deg"},
    {"heading_iae_degs", "heading error (IAE)", "deg s"},
    {"cross_track_rms_m", "cross track RMS", "m"},
    {"path_length_m", "path length", "m"},
    {"speed_drop_mps", "speed drop", "m/s"},
    {"sideslip_max_deg", "sideslip max", "deg"},
    {"yaw_rate_max_degps", "yaw rate max", "deg/s"},
    {"control_variation", "control variation", ""},
    {"clearance_min_m", "clearance min", "m"},
    {"finish_time_s", "finish time", "s"},
    {"energy_mech", "energy at the wheels", ""},
    {"energy_electric", "energy in the motors", ""},
    {"electric_work_j", "electrical work", "J"},
    {"saturation_s", "saturation", "s"},
    {"steering_travel_deg", "steering travel", "deg"},
    {"tyre_work", "tyre work", ""},
    {"steering_rate_rms_degps", "steering rate RMS", "deg/s"},
    {"heading_itae_degs2", "heading error (ITAE)", "deg s^2"},
}};

}  // namespace

MetricWords metric_words(std::string_view name) {
  const auto entry = std::find_if(kMetricEntries.begin(), kMetricEntries.end(),
                                  [&](const MetricEntry& one) { return one.name == name; });
  if (entry == kMetricEntries.end()) return {std::string(name), ""};
  return {std::string(entry->words), std::string(entry->unit)};
}

Json metric_words_json() {
  Json json = Json::object();
  for (const MetricEntry& entry : kMetricEntries) {
    std::string text(entry.words);
    if (!entry.unit.empty()) text += ", " + std::string(entry.unit);
    json[std::string(entry.name)] = std::move(text);
  }
  return json;
}

}  // namespace awmr
