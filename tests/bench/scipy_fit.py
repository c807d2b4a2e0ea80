"""Fits a log of driving_log.py like awmr identify --log, but with SciPy: least_squares around solve_ivp. Prints result and
cost as JSON. Run by scripts/bench.

The problem is that of awmr (lib/awmr/identify/logs). The log is split into windows of ten seconds. Unknown are eight parameters (all but
the exponents as logarithms) with a weak prior around the first guess, and the initial state of each window with a weak prior around
the measured state. The residuals are the errors of five channels, divided by standard deviations that are given here; awmr estimates
them. All windows are integrated as one system of equations in NumPy, from one change of the commands to the next. The Jacobian uses
finite differences with fifteen perturbed solutions (eight parameters, seven states), which are integrated together. Fifteen are
enough, because the windows are independent.

usage: scipy_fit.py VEHICLE.json LOG.csv
"""
import json
import math
import pathlib
import sys
from types import SimpleNamespace

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import least_squares
from scipy.sparse import bsr_matrix, csr_matrix, diags, hstack, vstack

from driving_log import HELD_ROWS, NOISE, RATE_HZ
from vehicle_model import STATE_SIZE, geometry_of, rates, resolved_at_rest

WINDOW_ROWS = 8 * HELD_ROWS
NAMES = {"surge_alpha": "surge.alpha", "surge_beta": "surge.beta", "yaw_alpha": "yaw.alpha", "yaw_beta": "yaw.beta",
         "sway_alpha": "sway.alpha", "mass_norm": "mass_norm", "inertia_norm": "inertia_norm",
         "time_constant_s": "steering.time_constant_s"}
EXPONENTS = ("surge_beta", "yaw_beta")
# Standard deviations of the priors: parameters about the first guess, initial states about the
# measurements.
PARAMETER_STD = 5.0
STATE_STD = np.array([100.0, 100.0, 10.0, 1.0, 1.0, 1.0, 0.2])
# With these tolerances the error of solve_ivp is below a thousandth of the sensor noise. It cancels in the finite differences,
# because all perturbed solutions use the same steps.
TOLERANCES = {"rtol": 1e-5, "atol": 1e-7}
DIFFERENCE = 1e-4
# As in awmr, the search ends when a step reduces half the sum of squares by less than this: a third
# of a standard error.
WORTH = 0.05


def read_log(path):
    """Commands F'L, F'R, d_ro and measured states as arrays (quantity, window, row). States that no channel measures are 0."""
    table = np.genfromtxt(path, delimiter=",", names=True)
    rows = len(table) // WINDOW_ROWS * WINDOW_ROWS
    measured = np.zeros((STATE_SIZE, rows))
    for place, name in {0: "x_m", 1: "y_m", 3: "speed_mps", 5: "yaw_rate_radps"}.items():
        measured[place] = table[name][:rows]
    measured[2] = np.unwrap(np.radians(table["heading_deg"][:rows]))
    commands = np.stack([table["force_left"], table["force_right"], np.radians(table["steering_cmd_deg"])])[:, :rows]
    return commands.reshape(3, -1, WINDOW_ROWS), measured.reshape(STATE_SIZE, -1, WINDOW_ROWS)


def first_guess(commands, measured, vehicle):
    """The initial guess of awmr (initial_guess.cpp) from root mean squares; sway resistance and servo as in vehicle.json."""
    def rms(x):
        return math.sqrt(np.mean(x * x))

    left, right, steering = commands
    sides = rms(left) + rms(right)
    moment_m = 2.0 * vehicle["half_track_m"] * rms(right - left) + vehicle["front_axle_m"] * sides * rms(steering)
    surge = 2.0 * sides / rms(measured[3]) ** 0.8
    mass = 0.3 * surge
    return {"surge_alpha": surge, "surge_beta": 0.8, "yaw_alpha": moment_m / rms(measured[5]) ** 0.8, "yaw_beta": 0.8,
            "sway_alpha": vehicle["sway_alpha"], "mass_norm": mass,
            "inertia_norm": mass * vehicle["yaw_inertia_kgm2"] / vehicle["mass_kg"],
            "time_constant_s": vehicle["steering"]["time_constant_s"]}


def coordinates_of(values):
    return np.array([value if name in EXPONENTS else math.log(value) for name, value in values.items()])


def values_of(coordinates):
    return {name: z if name in EXPONENTS else np.exp(z) for name, z in zip(NAMES, coordinates)}


class Problem:
    """The residuals of the log and their Jacobian. The unknowns are the parameters, then every window's initial state."""

    def __init__(self, vehicle, path):
        self.commands, self.measured = read_log(path)
        self.windows = self.commands.shape[1]
        self.geometry = geometry_of(vehicle)
        guess = first_guess(self.commands, self.measured, vehicle)
        # Near rest awmr replaces the resistance by a straight line, up to a speed that depends on its step: a quarter of the
        # shortest time constant.
        self.step_s = 0.25 * min(guess["time_constant_s"], guess["mass_norm"] / guess["sway_alpha"])
        started = self.measured[:, :, 0].copy()
        started[6] = self.commands[2, :, 0]
        self.start = np.append(coordinates_of(guess), started.T.ravel())
        self.pull = 1.0 / np.append(np.full(len(NAMES), PARAMETER_STD), np.tile(STATE_STD, self.windows))

    def bounds(self):
        """awmr's default bounds of the exponents; nothing else is bounded."""
        low, high = np.full(self.start.size, -np.inf), np.full(self.start.size, np.inf)
        for name, most in (("surge_beta", 1.0), ("yaw_beta", 4.0)):
            low[list(NAMES).index(name)], high[list(NAMES).index(name)] = 0.0, most
        return low, high

    def standardised(self, unknowns):
        """Residuals divided by the sensors' standard deviations, shape (set, window, channel and row), for sets of unknowns of shape
        (set, unknown)."""
        plant = SimpleNamespace(**values_of(unknowns[:, :len(NAMES)].T[:, :, np.newaxis]), **self.geometry)
        plant = resolved_at_rest(plant, self.step_s)
        state = np.moveaxis(unknowns[:, len(NAMES):].reshape(len(unknowns), self.windows, STATE_SIZE), 2, 0)
        shape = state.shape
        times = np.arange(HELD_ROWS + 1) / RATE_HZ
        errors = np.empty((*shape[1:], len(NOISE), WINDOW_ROWS))
        for row in range(0, WINDOW_ROWS, HELD_ROWS):
            command = self.commands[:, :, row]
            solved = solve_ivp(lambda _, at: np.stack(rates(plant, at.reshape(shape), *command, np)).ravel(),
                               (0.0, times[-1]), state.ravel(), t_eval=times, **TOLERANCES).y.reshape(*shape, -1)
            rows = slice(row, row + HELD_ROWS)
            for channel, (place, std) in enumerate(NOISE.items()):
                errors[:, :, channel, rows] = (solved[place, :, :, :-1] - self.measured[place, :, rows]) / std
            state = solved[:, :, :, -1]
        return errors.reshape(*shape[1:], -1)

    def residuals(self, unknowns):
        return np.append(self.standardised(unknowns[np.newaxis]), self.pull * (unknowns - self.start))

    def jacobian(self, unknowns):
        moved = np.zeros((len(NAMES) + STATE_SIZE, unknowns.size))
        moved[:, :len(NAMES)] = np.eye(len(moved), len(NAMES))
        moved[:, len(NAMES):] = np.tile(np.eye(len(moved), STATE_SIZE, -len(NAMES)), self.windows)
        errors = self.standardised(unknowns + DIFFERENCE * np.vstack([np.zeros(unknowns.size), moved]))
        slopes = (errors[1:] - errors[0]) / DIFFERENCE
        by_parameter = csr_matrix(slopes[:len(NAMES)].reshape(len(NAMES), -1).T)
        windows = np.arange(self.windows + 1)
        by_state = bsr_matrix((np.moveaxis(slopes[len(NAMES):], 0, 2), windows[:-1], windows))
        return vstack([hstack([by_parameter, by_state]), diags(self.pull)]).tocsr()


def main():
    vehicle, log = sys.argv[1:]
    problem = Problem(json.loads(pathlib.Path(vehicle).read_text()), log)
    fit = least_squares(problem.residuals, problem.start, jac=problem.jacobian, bounds=problem.bounds(), x_scale="jac",
                        ftol=2.0 * WORTH / problem.residuals(problem.start).size)
    values = {NAMES[name]: float(value) for name, value in values_of(fit.x[:len(NAMES)]).items()}
    print(json.dumps({"values": values, "success": bool(fit.success), "message": fit.message, "cost": fit.cost,
                      "residuals": int(fit.nfev), "jacobians": int(fit.njev), "windows": problem.windows}))


if __name__ == "__main__":
    main()
