#!/usr/bin/python3
"""Makes the synthetic logs of this folder by an integration of the equations of motion that shares no code with awmr
(midpoint rule at 0.25 ms), with the noise that the README states. usage: generate.py (writes into its own folder)
"""
import json
import math
import pathlib
import random

HERE = pathlib.Path(__file__).parent
VEHICLE = json.loads((HERE / "../../configs/paper/vehicle.json").read_text())
TRUTH = {"a1": 1.3157, "b1": 0.8841, "a3": 0.3028, "b3": 0.8250, "a_s": 3.0, "m": 0.0824, "i": 0.0130, "t": 0.02}
STEP_S, RATE_HZ = 2.5e-4, 100


def odd_power(a, b, w):
    return math.copysign(a * abs(w) ** b, w) if w else 0.0


def rates(s, left, right, command):
    x, y, psi, u, v, r, d = s
    p, axle, track = TRUTH, VEHICLE["front_axle_m"], VEHICLE["half_track_m"]
    stop, fastest = (math.radians(VEHICLE["steering"][k]) for k in ("max_deg", "max_rate_degps"))
    both = left + right
    side = both * math.sin(d)
    moment = axle * side + track * (right - left) * (1 + math.cos(d))
    turn = (max(-stop, min(stop, command)) - d) / p["t"]
    return (u * math.cos(psi) - v * math.sin(psi), u * math.sin(psi) + v * math.cos(psi), r,
            (both * (1 + math.cos(d)) - odd_power(p["a1"], p["b1"], u)) / p["m"] + r * v,
            (side - p["a_s"] * v) / p["m"] - r * u,
            (moment - odd_power(p["a3"], p["b3"], r)) / p["i"], max(-fastest, min(fastest, turn)))


def moved(s, ds, h):
    return tuple(a + h * b for a, b in zip(s, ds))


def drive(name, duration_s, seed):
    chance = random.Random(seed)
    state = (0.0,) * 7
    lines = ["# synthetic, see README.md", "t_s,force_left,force_right,steering_cmd_deg,x_m,y_m,heading_deg,speed_mps,"
             "yaw_rate_radps"]
    left = right = command = gps_x = gps_y = 0.0
    for k in range(int(duration_s * RATE_HZ) + 1):
        if k % 150 == 0:
            level = 0.0 if chance.random() < 0.25 else 0.5 * (0.15 + 0.65 * chance.random())
            apart = 0.4 * level * (chance.random() - 0.5)
            left, right = round(level - apart, 5), round(level + apart, 5)
            command = math.radians(round(math.degrees(math.radians(20) * (1.6 * chance.random() - 0.8)), 3))
        if k % 10 == 0:
            gps_x, gps_y = state[0] + 0.05 * chance.gauss(0, 1), state[1] + 0.05 * chance.gauss(0, 1)
        heading = (math.degrees(state[2]) + chance.gauss(0, 1) + 180) % 360 - 180
        lines.append(f"{k / RATE_HZ:.2f},{left:g},{right:g},{math.degrees(command):.3f},{gps_x:.3f},{gps_y:.3f},"
                     f"{heading:.2f},{state[3] + 0.02 * chance.gauss(0, 1):.4f},"
                     f"{state[5] + math.radians(0.5) * chance.gauss(0, 1):.5f}")
        for _ in range(round(1 / (RATE_HZ * STEP_S))):
            half = moved(state, rates(state, left, right, command), STEP_S / 2)
            state = moved(state, rates(half, left, right, command), STEP_S)
    (HERE / name).write_text("\n".join(lines) + "\n")


def coast(name, seed):
    chance = random.Random(seed)
    lines = ["# synthetic, see README.md", "run,t_s,speed_mps"]
    p = TRUTH
    for run in (1, 2, 3):
        u0, s = 1.66, 1 - p["b1"]
        for k in range(100):
            left = u0**s - s * p["a1"] / p["m"] * max(0.0, k / RATE_HZ - 0.1)
            u = left ** (1 / s) if left > 0 else 0.0
            lines.append(f"{run},{k / RATE_HZ:.2f},{u + 0.02 * chance.gauss(0, 1):.4f}")
    (HERE / name).write_text("\n".join(lines) + "\n")


def field(name, seed):
    """Two turns in a horizontal field of 130 counts. Magnets on the vehicle shift the readings (ahead_0, left_0), iron distorts them
    by a symmetric matrix of determinant 1."""
    chance = random.Random(seed)
    lines = ["# synthetic, see README.md", "t_s,field_ahead,field_left,yaw_rate_radps"]
    ahead_0, left_0, gain, cross = 42.0, -67.0, 1.1, 0.06
    other = (1 + cross * cross) / gain
    psi = 0.3
    for k in range(400):
        rate = 4 * math.pi / 40 * (1 + 0.3 * math.sin(0.05 * k))
        c, d = 130 * math.cos(psi), -130 * math.sin(psi)
        lines.append(f"{k / 10:.1f},{ahead_0 + other * c - cross * d + chance.gauss(0, 1):.1f},"
                     f"{left_0 - cross * c + gain * d + chance.gauss(0, 1):.1f},{rate + chance.gauss(0, 0.005):.4f}")
        psi += rate / 10
    (HERE / name).write_text("\n".join(lines) + "\n")


drive("drive_1.csv", 15, 1)
drive("drive_2.csv", 15, 2)
coast("coastdown.csv", 3)
field("field.csv", 4)
