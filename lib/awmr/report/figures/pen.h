/// Style of each role of a series: the table of colours, widths, dashes and marks. Private to this
/// folder.
///
/// The colours are those of Okabe and Ito, "Color Universal Design" (2008), which colour-blind
/// readers can distinguish. In grey print, dashes and marks distinguish the series. Coinciding
/// lines are visible because the wide one is drawn first.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "awmr/report/figures/figure.h"

namespace awmr {

struct Colour {
  std::uint8_t red = 0;
  std::uint8_t green = 0;
  std::uint8_t blue = 0;
};
inline constexpr Colour kBlack{0, 0, 0};
inline constexpr Colour kGridGrey{221, 221, 221};
inline constexpr Colour kObstacleGrey{200, 200, 200};

enum class Marker { kDisc, kDiamond, kSquare };

struct Pen {
  Colour colour;
  double width_pt = 1.0;
  std::vector<double> dashes_pt = {};
  Marker marker = Marker::kDisc;
  Colour band = {};  ///< for an area; opaque, because nothing is drawn transparently
};

inline const Pen& pen_of(Role role) {
  static const std::array<Pen, 9> kPens{{
      {.colour = kBlack, .width_pt = 1.0, .dashes_pt = {}, .band = {225, 225, 225}},
      {.colour = {213, 94, 0}, .width_pt = 1.0, .dashes_pt = {}, .marker = Marker::kDiamond},
      {.colour = {0, 114, 178}, .width_pt = 1.4, .dashes_pt = {}, .band = {204, 226, 240}},
      {.colour = {213, 94, 0}, .width_pt = 1.2, .dashes_pt = {4.0, 1.5}},
      {.colour = {86, 180, 233}, .width_pt = 2.6, .dashes_pt = {}},
      {.colour = {213, 94, 0},
       .width_pt = 1.5,
       .dashes_pt = {5.0, 2.5},
       .marker = Marker::kDiamond},
      {.colour = {0, 80, 60}, .width_pt = 1.0, .dashes_pt = {}, .marker = Marker::kSquare},
      {.colour = kBlack, .width_pt = 0.8, .dashes_pt = {1.0, 2.0}, .marker = Marker::kSquare},
      {.colour = {140, 140, 140}, .width_pt = 1.0, .dashes_pt = {}, .band = {235, 235, 235}},
  }};
  return kPens[static_cast<std::size_t>(role)];
}

}  // namespace awmr
