#!/usr/bin/python3
"""Makes the recordings of this folder. The rover is simulated by an integration of the equations of motion that shares no code with
awmr (midpoint rule at 0.5 ms). Units are those of typical recordings: PWM counts, milliseconds, km/h, decimal commas.
usage: generate.py (writes into its own folder)
"""
import math
import pathlib
import random

HERE = pathlib.Path(__file__).parent
MASS_KG, LENGTH_M, WIDTH_M, AXLE_M, HALF_TRACK_M = 2.1, 0.32, 0.22, 0.11, 0.085
STOP_RAD, FASTEST_RADPS, LAG_S = math.radians(25), math.radians(300), 0.06
F_MAX_N = 3.0
A1, B1, A3, B3, SWAY = 2.05, 0.80, 0.042, 0.90, 60.0
M, I = MASS_KG / F_MAX_N, MASS_KG * (LENGTH_M**2 + WIDTH_M**2) / 12 / F_MAX_N
STEP_S = 5e-4


def odd_power(a, b, w):
    return math.copysign(a * abs(w) ** b, w) if w else 0.0


def rates(s, left, right, command):
    x, y, psi, u, v, r, d = s
    both = left + right
    side = both * math.sin(d)
    moment = AXLE_M * side + HALF_TRACK_M * (right - left) * (1 + math.cos(d))
    turn = (max(-STOP_RAD, min(STOP_RAD, command)) - d) / LAG_S
    return (u * math.cos(psi) - v * math.sin(psi), u * math.sin(psi) + v * math.cos(psi), r,
            (both * (1 + math.cos(d)) - odd_power(A1, B1, u)) / M + r * v, (side - SWAY * v) / M - r * u,
            (moment - odd_power(A3, B3, r)) / I, max(-FASTEST_RADPS, min(FASTEST_RADPS, turn)))


def moved(s, ds, h):
    return tuple(a + h * b for a, b in zip(s, ds))


def comma(value, digits):
    return f"{value:.{digits}f}".replace(".", ",")


def write(name, lines):
    (HERE / name).write_text("\n".join(lines) + "\n")


def surge(chance):
    """Straight runs over 5 m, timed by hand to 0.03 s."""
    lines = ["pwm;distance_m;ms"]
    for pwm in (50, 75, 100, 125, 150, 175, 200, 225, 255):
        speed = (4 * pwm / 255 / A1) ** (1 / B1)
        lines.append(f"{pwm};{comma(5, 1)};{1000 * (5 / speed + 0.03 * chance.gauss(0, 1)):.0f}")
    write("surge.csv", lines)


def turning(chance):
    """Full circles, timed by hand to 0.1 s."""
    lines = ["steering_deg;pwm;turns;ms"]
    for degrees in (8, 12, 16, 20, 24):
        for pwm in (90, 150):
            moment = 2 * AXLE_M * pwm / 255 * math.sin(math.radians(degrees))
            rate = (moment / A3) ** (1 / B3)
            turns = 2 if rate < 0.6 else 4
            lines.append(f"{degrees};{pwm};{turns};{1000 * (2 * math.pi * turns / rate + 0.1 * chance.gauss(0, 1)):.0f}")
    write("turning.csv", lines)


def coastdown(chance):
    """Speed by the wheel encoder at 50 Hz while the rover coasts to rest; the motors are off from the start of the record."""
    lines = ["run;t_ms;kmh"]
    for run, start in enumerate((1.4, 1.8, 2.1), 1):
        s = 1 - B1
        for k in range(80):
            left = start**s - s * A1 / M * k / 50
            speed = left ** (1 / s) if left > 0 else 0.0
            lines.append(f"{run};{20 * k};{comma(3.6 * (speed + 0.015 * chance.gauss(0, 1)), 3)}")
    write("coastdown.csv", lines)


def drive(name, duration_s, chance):
    """A drive at 50 Hz with new throttle and steering every 2 s."""
    state, left, right, degrees = (0.0,) * 7, 0, 0, 0
    lines = ["ms;pwm_l;pwm_r;servo_deg;kmh;gyro_dps;yaw_deg"]
    for k in range(int(duration_s * 50) + 1):
        if k % 100 == 0:
            level, apart = chance.uniform(40, 220), chance.uniform(-30, 30)
            left, right, degrees = round(level - apart), round(level + apart), round(chance.uniform(-22, 22))
        yaw = (math.degrees(state[2]) + 0.8 * chance.gauss(0, 1) + 180) % 360 - 180
        lines.append(f"{20 * k};{left};{right};{degrees};{comma(3.6 * (state[3] + 0.015 * chance.gauss(0, 1)), 3)};"
                     f"{comma(math.degrees(state[5]) + 0.4 * chance.gauss(0, 1), 2)};{comma(yaw, 1)}")
        for _ in range(40):
            command = left / 255, right / 255, math.radians(degrees)
            half = moved(state, rates(state, *command), STEP_S / 2)
            state = moved(state, rates(half, *command), STEP_S)
    write(name, lines)


surge(random.Random(1))
turning(random.Random(7))
coastdown(random.Random(3))
drive("drive_1.csv", 30, random.Random(4))
drive("drive_2.csv", 20, random.Random(5))
print(f"m' {M:g}, I'z {I:.6g}")
