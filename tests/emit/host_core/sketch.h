// The objects of the sketch that a case reads; HeadingHold or WaypointFollowing, compiled by itself:
// `g++ -x c++ SKETCH.ino`. Programs are named after their sketch.
#pragma once
#include <Arduino.h>
#include <awmr_paper_board.h>

#include <cstring>

extern awmr_board::Imu imu;
extern awmr_board::Gps gps;
extern awmr_board::Safety safety;
extern awmr_output output;

inline bool is_route(const char* program) {
  return strstr(program, "WaypointFollowing") != nullptr;
}
