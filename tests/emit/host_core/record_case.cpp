// Runs RecordTrials in the simulated world for two runs, with a sensor failure in the second half
// of the first. Prints the number of table rows after each.
#include <algorithm>

#include "world.h"

namespace {

int rows(const char* name) {
  const auto file = SD.files.find(name);
  if (file == SD.files.end()) return -1;
  return static_cast<int>(std::count(file->second->begin(), file->second->end(), '\n')) - 1;
}

}  // namespace

int main(int, char** argv) {
  World& w = world;
  const std::string broken = argv[1];
  w.gps_speed_noise = 0.005;  // small enough that the slowest run counts as steady within 5 %
  setup();
  w.run(3);
  w.say("ARM\n");
  w.run(0.2);
  w.say("G\n");
  w.run(4.5);
  const bool drove = w.is_driven();
  if (broken == "gps-silent") w.gps_answers = false;
  if (broken == "gps-repeated") w.gps_repeats = true;
  if (broken == "gyro-silent") w.gyro_answers = false;
  if (broken == "gyro-frozen") w.gyro_frozen = true;
  if (broken == "silence") w.keeps = false;
  w.run(5);
  const int after_broken = rows("SURGE00.CSV");
  const bool is_driven = w.is_driven();
  w.gps_answers = w.gyro_answers = w.keeps = true;
  w.gps_repeats = w.gyro_frozen = false;
  w.run(2);
  w.say("G\n");  // refused: not armed
  w.run(1);
  const bool drives_unarmed = broken != "none" && w.is_driven();
  w.say("ARM\n");
  w.run(0.1);
  w.say("G\n");
  w.run(8);
  printf("drove=%d driven=%d rows_broken=%d drives_unarmed=%d rows_mended=%d\n", drove, is_driven,
         after_broken, drives_unarmed, rows("SURGE00.CSV"));
}
