#include <cstdio>

#include "awmr/model/vehicle.h"
#include "awmr/model/vehicle_file.h"
#include "awmr/simulate/simulate.h"

int main(int, char** argv) {
  const auto vehicle = awmr::read_vehicle(argv[1]);
  if (!vehicle) {
    std::fputs(awmr::to_text(vehicle.error()).c_str(), stderr);
    return awmr::exit_code(vehicle.error());
  }
  return vehicle->mass_kg > 0.0 ? 0 : 1;
}
