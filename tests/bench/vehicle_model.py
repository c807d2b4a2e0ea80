"""Vehicle, control laws and allocation in Python, for the NumPy and SciPy programs of scripts/bench.

The equations are those of lib/awmr/model/dynamics.h and lib/awmr/control, implemented independently. A state is (x, y, psi, u, v, r, d_r)
in m, rad, m/s and rad/s. With `on=numpy`, each of the seven is an array with one element (a "lane") per run. With `on=NUMBERS` each is a
Python float, which is several times as fast for a single run.
"""
import json
import math
import pathlib
from types import SimpleNamespace

import numpy as np

NUMBERS = SimpleNamespace(cos=math.cos, sin=math.sin, arctan=math.atan, maximum=max, minimum=min,
                          where=lambda condition, chosen, other: chosen if condition else other)
STATE_SIZE = 7
# Rest speed for the controller, which uses the power law without the chord (see resistance()). Not 0, because 0 to a negative power
# is infinite.
NO_CHORD = 1e-300


def saturate(x, limit, on):
    return on.maximum(-limit, on.minimum(limit, x))


def resistance(alpha, beta, rest_speed, speed, on):
    """Power law alpha |w|^beta sgn w of the speed w; for |w| < rest_speed the straight line through the origin that meets it there
    (the chord)."""
    return alpha * on.maximum(abs(speed), rest_speed) ** (beta - 1.0) * speed


def rest_speed(alpha, beta, inertia, step_s):
    """Rest speed at which motion on the chord decays at the rate 1/h: w = (alpha h/inertia)^(1/(1 - beta)), for beta < 1."""
    return (alpha * step_s / inertia) ** (1.0 / (1.0 - beta))


def resolved_at_rest(plant, step_s):
    """The plant with the rest speeds that integration steps of step_s need."""
    return SimpleNamespace(**{**vars(plant),
                              "surge_rest": rest_speed(plant.surge_alpha, plant.surge_beta, plant.mass_norm, step_s),
                              "yaw_rest": rest_speed(plant.yaw_alpha, plant.yaw_beta, plant.inertia_norm, step_s)})


def geometry_of(vehicle):
    """The values of vehicle.json that the equations need."""
    return {"front_axle_m": vehicle["front_axle_m"], "half_track_m": vehicle["half_track_m"],
            "stop_rad": math.radians(vehicle["steering"]["max_deg"]),
            "fastest_radps": math.radians(vehicle["steering"]["max_rate_degps"])}


def rates(p, state, left, right, steering_command_rad, on):
    """Time derivative of the state. `left`, `right`: forces of a left and a right wheel, divided by F_max."""
    _, _, psi, u, v, r, d_r = state
    cos_psi, sin_psi = on.cos(psi), on.sin(psi)
    one_plus_cos = 1.0 + on.cos(d_r)
    both = left + right
    side = both * on.sin(d_r)
    moment_m = p.front_axle_m * side + p.half_track_m * (right - left) * one_plus_cos
    surge = resistance(p.surge_alpha, p.surge_beta, p.surge_rest, u, on)
    yaw_m = resistance(p.yaw_alpha, p.yaw_beta, p.yaw_rest, r, on)
    lag_rad = saturate(steering_command_rad, p.stop_rad, on) - d_r
    return (u * cos_psi - v * sin_psi,
            u * sin_psi + v * cos_psi,
            r,
            (both * one_plus_cos - surge) / p.mass_norm + r * v,
            (side - p.sway_alpha * v) / p.mass_norm - r * u,
            (moment_m - yaw_m) / p.inertia_norm,
            saturate(lag_rad / p.time_constant_s, p.fastest_radps, on))


def steering_h(c, tau_speed, half_ratio, on):
    """h = tan(d_r/2)/2 that makes a yaw moment of 2 l_f half_ratio, limited; and whether the limit reduced it."""
    able = tau_speed > 1e-6
    limit = c.h_max * on.maximum(0.0, on.minimum(1.0, 16.0 * tau_speed))
    asked = half_ratio / on.where(able, tau_speed, 1.0)
    h = on.where(able, saturate(asked, limit, on), 0.0)
    return h, (abs(asked) > limit) | (tau_speed <= 1e-6)


def allocated(c, tau_speed, tau_turn_m, on):
    """F'L, F'R and d_r in combined mode. Steering and wheel forces each make half of the yaw moment; if one of them cannot, the other
    makes the rest."""
    def clip(force):
        return on.maximum(c.force_min, on.minimum(c.force_max, force))

    speed = on.maximum(4.0 * c.force_min, on.minimum(4.0 * c.force_max, tau_speed))
    h, lost = steering_h(c, speed, tau_turn_m / (4.0 * c.front_axle_m), on)
    quarter = 0.25 + h * h
    over_track = on.where(lost, (tau_turn_m - 2.0 * c.front_axle_m * h * speed) / c.half_track_m,
                          tau_turn_m / (2.0 * c.half_track_m))
    left, right = (speed - over_track) * quarter, (speed + over_track) * quarter
    clipped_left, clipped_right = clip(left), clip(right)
    gives = ((clipped_left != left) | (clipped_right != right)) & (lost == 0)
    rest_m = 2.0 * quarter * tau_turn_m - c.half_track_m * (clipped_right - clipped_left)
    given_h, _ = steering_h(c, clipped_left + clipped_right, rest_m / (2.0 * c.front_axle_m), on)
    angle_rad = 2.0 * on.arctan(2.0 * on.where(gives, given_h, h))
    return clipped_left, clipped_right, saturate(angle_rad, c.stop_rad, on)


def wrapped(angle_rad):
    """The angle wrapped to [-pi, pi)."""
    return (angle_rad + math.pi) % (2.0 * math.pi) - math.pi


def control(c, psi_goal_rad, speed_mps, state, on):
    """Sliding-mode heading and speed laws. Returns the resulting F'L, F'R and d_r."""
    _, _, psi, u, v, r, _ = state
    sliding = c.lambda_ * wrapped(psi_goal_rad - psi) - r
    tau_turn_m = (resistance(c.yaw_alpha, c.yaw_beta, NO_CHORD, r, on) +
                  c.inertia_norm * (saturate(c.mu / c.epsilon * sliding, c.mu, on) - c.lambda_ * r))
    tau_speed = (resistance(c.surge_alpha, c.surge_beta, NO_CHORD, u, on) +
                 c.mass_norm * (saturate(c.speed_mu / c.speed_epsilon * (speed_mps - u), c.speed_mu, on) - r * v))
    return allocated(c, tau_speed, tau_turn_m, on)


def plant_of(model):
    """The plant of a model.json."""
    return SimpleNamespace(surge_alpha=model["surge"]["alpha"]["value"], surge_beta=model["surge"]["beta"]["value"],
                           yaw_alpha=model["yaw"]["alpha"]["value"], yaw_beta=model["yaw"]["beta"]["value"],
                           sway_alpha=model["sway"]["alpha"]["value"], mass_norm=model["mass_norm"]["value"],
                           inertia_norm=model["inertia_norm"]["value"],
                           time_constant_s=model["steering"]["time_constant_s"]["value"],
                           **geometry_of(model["vehicle"]))


def plants_around(plant, step_s, lanes):
    """The plant in lane 0; in the other lanes its dynamic parameters with random changes of 3 % (exponents: 1 %; standard deviations)."""
    chance = np.random.default_rng(1)
    spread = {"surge_alpha": 0.03, "surge_beta": 0.01, "yaw_alpha": 0.03, "yaw_beta": 0.01, "mass_norm": 0.03, "inertia_norm": 0.03}
    lane = dict(vars(plant))
    for name, share in spread.items():
        lane[name] = lane[name] * (1.0 + share * np.append(0.0, chance.standard_normal(lanes - 1)))
    return resolved_at_rest(SimpleNamespace(**lane), step_s)


class HeadingRun:
    """A run of a heading scenario in combined mode: the nominal plant, its controller and the heading commands, read from the files."""

    def __init__(self, model_path, gains_path, scenario_path, substeps):
        model, gains, scenario = (json.loads(pathlib.Path(path).read_text())
                                  for path in (model_path, gains_path, scenario_path))
        vehicle = model["vehicle"]
        self.sample_time_s = vehicle["sample_time_s"]
        self.substeps = substeps
        self.samples = round(scenario["duration_s"] / self.sample_time_s)
        self.speed_mps = scenario["speed_mps"]
        self.goals = [(step["t_s"], math.radians(step["psi_deg"])) for step in scenario["guidance"]["steps"]]
        nominal = plant_of(model)
        self.plant = resolved_at_rest(nominal, self.sample_time_s / substeps)
        self.controller = SimpleNamespace(
            **vars(nominal), force_min=vehicle["wheel_force"]["min"], force_max=vehicle["wheel_force"]["max"],
            h_max=0.5 * math.tan(0.5 * nominal.stop_rad), lambda_=gains["heading"]["lambda"], mu=gains["heading"]["mu"],
            epsilon=gains["heading"]["epsilon"], speed_mu=gains["speed"]["mu"], speed_epsilon=gains["speed"]["epsilon"])

    def goal_rad(self, sample):
        """The heading commanded at a sample."""
        return [goal for t_s, goal in self.goals if t_s <= sample * self.sample_time_s][-1]
