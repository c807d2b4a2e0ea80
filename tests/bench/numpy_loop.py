"""Closed loops in NumPy. All runs are simulated at once: each has one element (a "lane") of every array. The work per run is that of
awmr compare: control laws, allocation, limits, classical Runge-Kutta steps with a check that they are short enough, and metrics. Lane 0
has the nominal plant; the plants of the other lanes differ by a few percent. Prints rows and metrics of lane 0 as JSON. Run by scripts/bench.

usage: numpy_loop.py MODEL.json GAINS.json SCENARIO.json SUBSTEPS LANES
"""
import json
import sys

import numpy as np

from vehicle_model import NO_CHORD, STATE_SIZE, HeadingRun, control, plants_around, rates, resistance, wrapped


def moved(plant, state, step_s, command):
    """A step of the classical Runge-Kutta method."""
    def rate(at):
        return np.stack(rates(plant, at, *command, np))

    k1 = rate(state)
    k2 = rate(state + 0.5 * step_s * k1)
    k3 = rate(state + 0.5 * step_s * k2)
    k4 = rate(state + step_s * k3)
    return state + step_s / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)


def resolves(state, step_s):
    """True if the step is short enough for the motion. Only the yaw motion can be too fast, because the resistance exponents are below 1."""
    return np.max(np.abs(state[5])) * step_s <= 1.0


def motor_work(plant, state, left, right):
    """The mechanical power of the four wheels, divided by F_max, and half the sum of the squares of their forces F'."""
    _, _, _, u, v, r, d_r = state
    across = (v + plant.front_axle_m * r) * np.sin(d_r)
    cos_d = np.cos(d_r)
    left_mps, right_mps = u - plant.half_track_m * r, u + plant.half_track_m * r
    power = (np.maximum(0.0, left * left_mps) + np.maximum(0.0, left * (left_mps * cos_d + across)) +
             np.maximum(0.0, right * right_mps) + np.maximum(0.0, right * (right_mps * cos_d + across)))
    return power, left * left + right * right


class Meter:
    """awmr's metrics of runs through a heading scenario (lib/awmr/simulate/meter.h), row by row."""

    def __init__(self, run, lanes):
        self.run, self.controller, self.sample_s = run, run.controller, run.sample_time_s
        zeros = np.zeros(lanes)
        names = ("path_length_m", "variation", "energy_mech", "energy_electric", "tyre_work", "saturation_s", "travel_deg",
                 "sideslip_max_deg", "yaw_rate_max_degps", "overshoot_deg", "iae_degs", "settling_s", "settled_s", "out_of_band")
        self.sums = {name: zeros.copy() for name in names}
        self.speed_least_mps = np.full(lanes, np.inf)
        self.before = None

    def add(self, sample, goal_rad, state, command):
        m, c = self.sums, self.controller
        left, right, steering_command = command
        _, _, psi, u, v, r, d_r = state
        error_deg = np.degrees(wrapped(goal_rad - psi))
        self.starts_step(sample, goal_rad, error_deg)
        self.add_heading(sample, error_deg)
        moves = np.hypot(u, v) > 0.05
        m["sideslip_max_deg"] = np.maximum(m["sideslip_max_deg"], moves * np.abs(np.degrees(np.arctan2(v, u))))
        m["yaw_rate_max_degps"] = np.maximum(m["yaw_rate_max_degps"], np.abs(np.degrees(r)))
        counts = np.isfinite(self.speed_least_mps) | (u >= 0.999 * self.run.speed_mps)
        self.speed_least_mps = np.where(counts, np.minimum(self.speed_least_mps, u), np.inf)
        power, copper = motor_work(c, state, left, right)
        limited = ((left >= c.force_max) | (left <= c.force_min) | (right >= c.force_max) | (right <= c.force_min) |
                   (np.abs(steering_command) >= c.stop_rad))
        if self.before:
            b = self.before
            m["path_length_m"] += np.hypot(state[0] - b["state"][0], state[1] - b["state"][1])
            m["variation"] += (np.abs(steering_command - b["command"][2]) / c.stop_rad +
                               (np.abs(left - b["command"][0]) + np.abs(right - b["command"][1])) / c.force_max)
            m["iae_degs"] += np.abs(b["error_deg"]) * self.sample_s
            m["energy_mech"] += self.sample_s * b["power"]
            m["energy_electric"] += self.sample_s * 2.0 * b["copper"]
            m["tyre_work"] += self.sample_s * b["yaw_resistance_m"] * b["state"][5]
            m["saturation_s"] += self.sample_s * b["limited"]
            m["travel_deg"] += np.abs(np.degrees(d_r - b["state"][6]))
        self.before = {"state": state, "command": command, "error_deg": error_deg, "power": power, "copper": copper,
                       "limited": limited, "goal_rad": goal_rad,
                       "yaw_resistance_m": resistance(c.yaw_alpha, c.yaw_beta, NO_CHORD, r, np)}

    def starts_step(self, sample, goal_rad, error_deg):
        """A new heading command closes the previous step."""
        if self.before and goal_rad == self.before["goal_rad"]:
            return
        if self.before:
            self.close_step()
        self.step_start, self.step_deg = sample, error_deg
        self.sums["out_of_band"][:] = 0.0
        self.sums["settled_s"][:] = 0.0

    def add_heading(self, sample, error_deg):
        m = self.sums
        out = np.abs(error_deg) > np.maximum(0.02 * np.abs(self.step_deg), 0.5)
        enters = ~out & (m["out_of_band"] > 0.0)
        m["settled_s"] = np.where(enters, (sample - self.step_start) * self.sample_s, m["settled_s"])
        m["out_of_band"] = out.astype(float)
        m["overshoot_deg"] = np.maximum(m["overshoot_deg"], np.where(self.step_deg > 0.0, -error_deg, error_deg))

    def close_step(self):
        m = self.sums
        m["settling_s"] = np.where(m["out_of_band"] > 0.0, np.inf, np.maximum(m["settling_s"], m["settled_s"]))

    def metrics(self, lane):
        """Metrics by their names in comparison.csv. If the run did not settle or did not reach its speed, the metrics that need this are
        missing."""
        self.close_step()
        m = {name: float(sums[lane]) for name, sums in self.sums.items()}
        found = {"overshoot_deg": m["overshoot_deg"], "heading_iae_degs": m["iae_degs"], "path_length_m": m["path_length_m"],
                 "sideslip_max_deg": m["sideslip_max_deg"], "yaw_rate_max_degps": m["yaw_rate_max_degps"],
                 "control_variation": m["variation"] / (self.run.samples * self.sample_s), "energy_mech": m["energy_mech"],
                 "energy_electric": m["energy_electric"], "saturation_s": m["saturation_s"],
                 "steering_travel_deg": m["travel_deg"], "tyre_work": m["tyre_work"]}
        if np.isfinite(m["settling_s"]):
            found["settling_time_s"] = m["settling_s"]
        if np.isfinite(self.speed_least_mps[lane]):
            found["speed_drop_mps"] = max(0.0, self.run.speed_mps - float(self.speed_least_mps[lane]))
        return found


def main():
    *files, substeps, lanes = sys.argv[1:]
    run = HeadingRun(*files, int(substeps))
    step_s = run.sample_time_s / run.substeps
    plants = plants_around(run.plant, step_s, int(lanes))
    state = np.zeros((STATE_SIZE, int(lanes)))
    meter = Meter(run, int(lanes))
    rows = []
    for sample in range(run.samples + 1):
        command = control(run.controller, run.goal_rad(sample), run.speed_mps, state, np)
        meter.add(sample, run.goal_rad(sample), state, command)
        rows.append(state[:, 0].tolist())
        if sample == run.samples:
            break
        for _ in range(run.substeps):
            before, state = state, moved(plants, state, step_s, command)
            if not (resolves(before, step_s) and resolves(state, step_s)):
                sys.exit("a step is too long for the motion of a run; awmr would halve it, this program cannot")
    print(json.dumps({"rows": rows, "metrics": meter.metrics(0)}))


if __name__ == "__main__":
    main()
