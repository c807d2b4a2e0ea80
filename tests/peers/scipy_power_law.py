"""Compares the power-law fit with SciPy's least squares: parameters and standard errors to 1e-8.

usage: scipy_power_law.py AWMR SOURCE_DIR
"""
import csv
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
from scipy.optimize import least_squares

awmr, source = sys.argv[1], pathlib.Path(sys.argv[2])


def rows(path):
    lines = [line for line in path.read_text().splitlines() if not line.startswith("#")]
    table = list(csv.DictReader(lines))
    return [r for r in table if float(r["tau_speed"]) > 0 and float(r["speed_mps"]) > 0]


def by_scipy(noise, table):
    force = np.array([float(r["tau_speed"]) for r in table])
    speed = np.array([float(r["speed_mps"]) for r in table])
    time = np.array([float(r["elapsed_s"]) for r in table])
    travel = np.array([float(r["distance_m"]) for r in table])

    def residual(theta):
        log_alpha, beta = theta
        if noise == "force":
            return np.exp(log_alpha) * speed**beta - force
        rate = (force / np.exp(log_alpha)) ** (1.0 / beta)
        return rate - speed if noise == "speed" else travel / rate - time

    def jacobian(theta):  # complex steps: exact to rounding
        columns = []
        for i in range(2):
            moved = np.array(theta, dtype=complex)
            moved[i] += 1e-30j
            columns.append(residual(moved).imag / 1e-30)
        return np.array(columns).T

    fit = least_squares(residual, [0.2, 0.85], jac=jacobian, xtol=1e-15, ftol=1e-15, gtol=1e-15,
                        x_scale="jac")
    j = jacobian(fit.x)
    variance = (fit.fun @ fit.fun) / (len(force) - 2)
    error = np.sqrt(np.diag(variance * np.linalg.inv(j.T @ j)))
    alpha = np.exp(fit.x[0])
    return {"alpha": (alpha, alpha * error[0]), "beta": (fit.x[1], error[1])}


def main():
    table = rows(source / "datasets/paper/surge.csv")
    worst = 0.0
    with tempfile.TemporaryDirectory() as scratch:
        for noise in ("force", "speed", "time"):
            out = pathlib.Path(scratch) / "model.json"
            subprocess.run(
                [awmr, "identify", "--vehicle", source / "configs/paper/vehicle.json", "--surge",
                 source / "datasets/paper/surge.csv", "--method", "nonlinear", "--noise", noise,
                 "--quiet", "-o", out], check=True)
            surge = json.loads(out.read_text())["surge"]
            for name, (value, error) in by_scipy(noise, table).items():
                for ours, theirs, what in ((surge[name]["value"], value, "value"),
                                           (surge[name]["std_error"], error, "standard error")):
                    difference = abs(ours / theirs - 1.0)
                    worst = max(worst, difference)
                    print(f"{noise:6} {name:6} {what:15} {ours:.12g} {theirs:.12g} {difference:.1e}")
    print(f"largest relative difference {worst:.1e}")
    return 0 if worst < 1e-8 else 1


sys.exit(main())
