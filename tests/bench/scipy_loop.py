"""The closed loop with SciPy's solve_ivp (RK45), called once per sample: the simplest program for the task. Prints the rows of the
nominal run as JSON. Run by scripts/bench.

usage: scipy_loop.py MODEL.json GAINS.json SCENARIO.json SUBSTEPS LANES
  SUBSTEPS  awmr's Runge-Kutta steps per sample. They determine the resistance near rest; solve_ivp chooses its own steps
  LANES     1: a single run with Python floats; otherwise the number of runs, solved as one system of equations in NumPy
"""
import json
import sys

import numpy as np
from scipy.integrate import solve_ivp

from vehicle_model import NUMBERS, STATE_SIZE, HeadingRun, control, plants_around, rates

TOLERANCES = {"rtol": 1e-6, "atol": 1e-9}


def main():
    *files, substeps, lanes = sys.argv[1:]
    run, lanes = HeadingRun(*files, int(substeps)), int(lanes)
    shape = (STATE_SIZE, lanes)
    plants = plants_around(run.plant, run.sample_time_s / run.substeps, lanes)

    def rates_of_one(_, at, command):
        return rates(run.plant, at.tolist(), *command, NUMBERS)

    def rates_of_all(_, at, command):
        return np.stack(rates(plants, at.reshape(shape), *command, np)).ravel()

    state = np.zeros(STATE_SIZE * lanes)
    rows = [[0.0] * STATE_SIZE]
    for sample in range(run.samples):
        known, on = (state.tolist(), NUMBERS) if lanes == 1 else (state.reshape(shape), np)
        command = control(run.controller, run.goal_rad(sample), run.speed_mps, known, on)
        state = solve_ivp(rates_of_one if lanes == 1 else rates_of_all, (0.0, run.sample_time_s), state, args=(command,),
                          **TOLERANCES).y[:, -1]
        rows.append(state.reshape(shape)[:, 0].tolist())
    print(json.dumps({"rows": rows}))


if __name__ == "__main__":
    main()
