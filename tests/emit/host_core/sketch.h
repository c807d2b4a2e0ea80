// Declares the sketch's objects that a test case reads. The sketch, HeadingHold or
// WaypointFollowing, is compiled separately (`g++ -x c++ SKETCH.ino`). Programs are named after
// their sketch.
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
