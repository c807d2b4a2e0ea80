#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>

#include "awmr/core/units.h"
#include "awmr/report/figures/figures_of.h"

namespace awmr {
namespace {

/// A channel of validation.json, with its axis in the figure and the factor from SI units to the
/// units of this axis.
struct ChannelAxis {
  std::string_view channel;
  const char* quantity;
  const char* unit;
  double per_si = 1.0;
};

constexpr std::array<ChannelAxis, 7> kChannelAxes{{{"x_m", "x", "m"},
                                                   {"y_m", "y", "m"},
                                                   {"heading_rad", "ψ", "deg", degrees(1.0)},
                                                   {"speed_mps", "u", "m/s"},
                                                   {"sway_mps", "v", "m/s"},
                                                   {"yaw_rate_radps", "r", "rad/s"},
                                                   {"steering_rad", "δ", "deg", degrees(1.0)}}};

Series channel_series(const Json& series, const char* key, Role role, double per_si) {
  Series one{.name = key,
             .shape = SeriesShape::kLine,
             .role = role,
             .x = series.at("t_s").get<std::vector<double>>()};
  for (std::size_t i = 0; i < one.x.size(); ++i) {
    one.y.push_back(per_si * series.at(key).at(i).get<double>());
  }
  return one;
}

/// Figure of a log with one panel per channel. It has no panels if an older version of awmr wrote
/// validation.json, because that version wrote no time series.
Figure log_figure(const Json& log) {
  const std::string file = log.at("file");
  Figure figure{.name = figure_name("log", std::filesystem::path(file).stem().string()),
                .meaning = "Measured channels of " + file +
                           " and their prediction from the commands, restarted from the "
                           "measurements at the start of every window",
                .x = {"t", "s"},
                .panels = {}};
  for (const auto& [name, channel] : log.at("channels").items()) {
    const auto axis = std::find_if(kChannelAxes.begin(), kChannelAxes.end(),
                                   [&](const ChannelAxis& one) { return one.channel == name; });
    if (axis == kChannelAxes.end() || !channel.contains("series")) continue;
    const Json& series = channel.at("series");
    figure.panels.push_back(
        {.y = {axis->quantity, axis->unit},
         .series = {channel_series(series, "measured", Role::kMeasured, axis->per_si),
                    channel_series(series, "predicted", Role::kPredicted, axis->per_si)}});
  }
  return figure;
}

}  // namespace

void add_log_figures(const Json& data, FiguresOfResults& all) {
  const std::size_t before = all.figures.size();
  if (data.contains("validation")) {
    for (const Json& log : data.at("validation").at("logs")) {
      Figure figure = log_figure(log);
      if (!figure.panels.empty()) all.figures.push_back(std::move(figure));
    }
  }
  if (all.figures.size() > before) return;
  all.lacking.push_back(
      "log: there is no validation.json with a log (awmr validate --log), or an older version "
      "wrote it without time series");
}

}  // namespace awmr
