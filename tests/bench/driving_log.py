"""Writes a simulated driving log of the paper's vehicle with 100 rows a second. Wheel forces and steering angle change every
1.25 s; the sensors have white noise. Run by scripts/bench.

usage: driving_log.py VEHICLE.json DURATION_S OUTPUT.csv
"""
import json
import math
import pathlib
import sys
from types import SimpleNamespace

import numpy as np
from scipy.integrate import solve_ivp

from vehicle_model import NUMBERS, STATE_SIZE, geometry_of, rates, resolved_at_rest

RATE_HZ = 100
HELD_ROWS = 125
TRUTH = {"surge_alpha": 1.3157, "surge_beta": 0.8841, "yaw_alpha": 0.3028, "yaw_beta": 0.8250, "sway_alpha": 3.0,
         "mass_norm": 0.0824, "inertia_norm": 0.0130, "time_constant_s": 0.02}
# Standard deviations of the noise by index in the state: x and y in m, psi in rad, u in m/s, r in rad/s.
NOISE = {0: 0.05, 1: 0.05, 2: math.radians(1.0), 3: 0.02, 5: math.radians(0.5)}
COLUMNS = "t_s,force_left,force_right,steering_cmd_deg,x_m,y_m,heading_deg,speed_mps,yaw_rate_radps"


def command_of(chance):
    """A random command: F'L, F'R and the steering angle in deg, rounded as in the log. In one of four the forces are 0."""
    level = 0.0 if chance.random() < 0.25 else 0.5 * (0.15 + 0.65 * chance.random())
    apart = 0.4 * level * (chance.random() - 0.5)
    return round(level - apart, 5), round(level + apart, 5), round(20.0 * (1.6 * chance.random() - 0.8), 3)


def drive(plant, rows, chance):
    """Commands and states by row."""
    state = np.zeros(STATE_SIZE)
    commands, states = [], []
    times = np.arange(HELD_ROWS + 1) / RATE_HZ
    while len(states) < rows:
        left, right, angle_deg = command_of(chance)
        solved = solve_ivp(lambda _, at: rates(plant, at.tolist(), left, right, math.radians(angle_deg), NUMBERS),
                           (0.0, times[-1]), state, method="LSODA", t_eval=times, rtol=1e-8, atol=1e-10).y
        commands += [(left, right, angle_deg)] * HELD_ROWS
        states += solved[:, :-1].T.tolist()
        state = solved[:, -1]
    return np.array(commands[:rows]), np.array(states[:rows])


def main():
    vehicle, duration_s, output = sys.argv[1:]
    plant = SimpleNamespace(**TRUTH, **geometry_of(json.loads(pathlib.Path(vehicle).read_text())))
    rows = round(float(duration_s) * RATE_HZ)
    chance = np.random.default_rng(1)
    commands, states = drive(resolved_at_rest(plant, 1e-3), rows, chance)
    measured = {place: states[:, place] + std * chance.standard_normal(rows) for place, std in NOISE.items()}
    heading_deg = (np.degrees(measured[2]) + 180.0) % 360.0 - 180.0
    table = np.column_stack([np.arange(rows) / RATE_HZ, commands, measured[0], measured[1], heading_deg, measured[3], measured[5]])
    np.savetxt(output, table, fmt="%.2f,%.5f,%.5f,%.3f,%.4f,%.4f,%.3f,%.5f,%.6f", header=COLUMNS, comments="")


if __name__ == "__main__":
    main()
