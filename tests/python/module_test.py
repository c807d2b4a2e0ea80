"""Checks that the Python module gives the same numbers, to the last bit, and the same error messages as the command line."""
import csv
import hashlib
import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

import numpy as np

import awmr

SOURCE = Path(os.environ["SOURCE"])
PAPER = SOURCE / "configs/paper"
TABLES = SOURCE / "datasets/paper"
DRIVE = SOURCE / "datasets/synthetic/drive_1.csv"
SCENARIO = PAPER / "scenarios/c3_heading_steps.json"


def command(*words):
    """Output of the program, and its exit code."""
    return subprocess.run([os.environ["AWMR"], *map(str, words)], capture_output=True, text=True)


def columns_of(path):
    """A CSV's columns as texts."""
    with open(path, newline="") as file:
        rows = [row for row in csv.reader(file) if row and not row[0].startswith("#")]
    return {name: [row[i] for row in rows[1:]] for i, name in enumerate(rows[0])}


def numbers(texts):
    return np.array([float(text) if text else np.nan for text in texts])


def tables():
    return {kind: TABLES / f"{kind}.csv" for kind in ("surge", "coastdown", "turning")}


class Module(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.path = Path(cls.folder.name)
        cls.vehicle = awmr.read_vehicle(PAPER / "vehicle.json")
        words = [word for kind, path in tables().items() for word in (f"--{kind}", path)]
        made = command("identify", "--vehicle", PAPER / "vehicle.json", *words, "-o",
                       cls.path / "model.json")
        assert made.returncode == 0, made.stderr
        made = command("tune", "--nominal", "--model", cls.path / "model.json", "-o",
                       cls.path / "gains.json")
        assert made.returncode == 0, made.stderr
        cls.model = awmr.read_model(cls.path / "model.json")
        cls.gains = awmr.read_gains(cls.path / "gains.json")

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def assert_same_model(self, model, path):
        """Compares byte for byte: numbers, command, options, and inputs by SHA-256."""
        self.assertEqual(model.text(), Path(path).read_text())

    def test_tables_give_the_same_model(self):
        trials = awmr.load_trials(self.vehicle, **tables())
        self.assert_same_model(awmr.identify(trials).model, self.path / "model.json")

    def test_a_log_gives_the_same_model(self):
        made = command("identify", "--vehicle", PAPER / "vehicle.json", "--log", DRIVE, "--fit",
                       "surge.alpha,mass_norm", "-o", self.path / "driven.json")
        self.assertEqual(made.returncode, 0, made.stderr)
        trials = awmr.load_trials(self.vehicle, log=DRIVE)
        identified = awmr.identify(trials, fit=["surge.alpha", "mass_norm"])
        self.assert_same_model(identified.model, self.path / "driven.json")
        self.assertEqual(identified.refused, [])

    def test_a_model_names_its_inputs_and_how_they_were_read(self):
        folder = self.path / "renamed"
        folder.mkdir()
        text = (TABLES / "surge.csv").read_text().replace("speed_mps", "V (km/h)")
        (folder / "surge.csv").write_text(text)
        words = ["--column", "speed_mps=V (km/h)*1", "--prefer", "timed", "--as-is"]
        made = command("identify", "--vehicle", PAPER / "vehicle.json", "--surge", folder / "surge.csv", *words, "-o",
                       self.path / "renamed.json")
        self.assertEqual(made.returncode, 0, made.stderr)
        reading = {"surge": folder / "surge.csv", "columns": ["speed_mps=V (km/h)*1"], "prefer": "timed", "as_is": True}
        model = awmr.identify(awmr.load_trials(self.vehicle, **reading)).model
        self.assert_same_model(model, self.path / "renamed.json")
        named = {one["name"]: one["sha256"] for one in json.loads(model.text())["inputs"]}
        self.assertEqual(named["surge.csv"], hashlib.sha256((folder / "surge.csv").read_bytes()).hexdigest())
        self.assertIn("vehicle.json", named)
        # A vehicle taken from a model has no file; the trials have.
        model = awmr.identify(awmr.load_trials(self.model.vehicle, **reading)).model
        self.assertEqual([one["name"] for one in json.loads(model.text())["inputs"]], ["surge.csv"])

    def test_rows_are_arrays_in_si_units(self):
        trials = awmr.load_trials(self.vehicle, log=[DRIVE], **tables())
        surge = columns_of(TABLES / "surge.csv")
        kept = numbers(surge["tau_speed"]) > 0
        np.testing.assert_array_equal(trials.surge["speed_mps"], numbers(surge["speed_mps"])[kept])
        self.assertEqual(trials.turning["steering_rad"].dtype, np.float64)
        self.assertTrue((trials.turning["steering_rad"] < np.pi / 2).all())
        (log,) = trials.logs
        self.assertEqual(len(log["t_s"]), 1501)
        self.assertEqual({len(column) for column in log.values()}, {1501})
        self.assertLess(np.isfinite(log["x_m"]).sum(), 200)
        finding = trials.findings[0]
        self.assertIn(finding.severity, ("note", "warning", "error"))
        self.assertTrue(finding.code and finding.message and finding.file)

    def test_estimates_have_their_uncertainty(self):
        estimate = self.model["surge.alpha"]
        self.assertLess(estimate.ci95[0], estimate.value)
        self.assertEqual((estimate.source, estimate.method), ("fitted", "log-linear"))
        self.assertEqual(awmr.units["surge.alpha"], "(s/m)^b1")
        names, matrix = self.model.covariance
        self.assertEqual(matrix.shape, (len(names), len(names)))
        np.testing.assert_array_equal(matrix, matrix.T)
        self.assertIn("mass_norm", list(self.model))
        with self.assertRaises(KeyError):
            self.model["mass"]

    def test_tuning_gives_the_same_gains(self):
        tuning = awmr.tune(self.model, nominal=True)
        written = json.loads((self.path / "gains.json").read_text())
        heading, speed = written["heading"], written["speed"]
        gains = tuning.gains
        self.assertEqual((gains.lambda_, gains.mu, gains.epsilon),
                         (heading["lambda"], heading["mu"], heading["epsilon"]))
        self.assertEqual((gains.speed_mu, gains.speed_epsilon), (speed["mu"], speed["epsilon"]))
        self.assertLess(tuning.objective, 1.0)
        for constraint in tuning.constraints:
            if constraint["required"]:
                self.assertGreaterEqual(constraint["margin"], 0.0)

    def test_a_robust_tuning_hands_out_what_fresh_draws_say(self):
        config = self.path / "tune.json"
        config.write_text(json.dumps({"draws": 1, "judged_draws": 8, "global_evaluations": 60,
                                      "local_evaluations": 20,
                                      "goals": [{"at_most": {"settling_time_s": 9}, "share": 0.6}]}))
        made = command("tune", "--observer", "--model", self.path / "model.json", "--config", config,
                       "-o", self.path / "observed.json")
        self.assertEqual(made.returncode, 0, made.stderr)
        written = json.loads((self.path / "observed.json").read_text())
        tuning = awmr.tune(self.model, config=config, observer=True)
        self.assertEqual(tuning.gains.observer_bandwidth_radps, written["observer"]["bandwidth_radps"])
        self.assertEqual(tuning.gains.observer_yaw_max_m, written["observer"]["yaw_max_m"])
        for one in tuning.judged:
            self.assertEqual(one["heading_iae_degs"],
                             written["robust"]["quantiles"][one["mode"]][one["gains"]]["heading_iae_degs"])
        self.assertEqual([goal["held"] for goal in tuning.goals], [goal["held"] for goal in written["goals"]])
        self.assertEqual([goal["verdict"] for goal in tuning.goals],
                         [goal["verdict"] for goal in written["goals"]])
        awmr.write_gains(tuning.gains, self.path / "again.json")
        self.assertEqual(awmr.read_gains(self.path / "again.json").observer_surge_max,
                         written["observer"]["surge_max"])

    def test_a_run_is_the_same(self):
        scenario = awmr.read_scenario(SCENARIO)
        for mode in ("differential", "steering", "combined"):
            made = command("simulate", "--model", self.path / "model.json", "--gains",
                           self.path / "gains.json", "--scenario", SCENARIO, "--mode", mode, "-o",
                           self.path / "run.csv", "--json")
            self.assertEqual(made.returncode, 0, made.stderr)
            run = awmr.simulate(self.model, self.gains, scenario, mode=mode)
            self.assertEqual(run.csv(), (self.path / "run.csv").read_text())
            for name, texts in columns_of(self.path / "run.csv").items():
                np.testing.assert_array_equal(run.columns[name], numbers(texts))
            self.assertEqual(run.metrics, json.loads(made.stdout)["result"]["metrics"])

    def test_a_comparison_is_the_same(self):
        made = command("compare", "--model", self.path / "model.json", "--gains",
                       self.path / "gains.json", "--scenario", SCENARIO, "--samples", 6, "-o",
                       self.path / "compared")
        self.assertEqual(made.returncode, 0, made.stderr)
        comparison = awmr.compare(self.model, self.gains, [awmr.read_scenario(SCENARIO)],
                                  samples=6, threads=1)
        written = columns_of(self.path / "compared/comparison.csv")
        self.assertEqual(comparison.csv(), (self.path / "compared/comparison.csv").read_text())
        self.assertEqual(list(comparison.columns["mode"]), written["mode"])
        stepped = awmr.compare(self.model, self.gains, [awmr.read_scenario(SCENARIO)],
                               heading_rate_limit="none")
        self.assertGreater(max(stepped.columns["yaw_rate_max_degps"]), 50.0)
        slow = awmr.compare(self.model, self.gains, [awmr.read_scenario(SCENARIO)],
                            heading_rate_limit=5)
        self.assertLess(max(slow.columns["yaw_rate_max_degps"]), 6.0)
        with self.assertRaises(awmr.InputError):
            awmr.compare(self.model, self.gains, [awmr.read_scenario(SCENARIO)],
                         heading_rate_limit="fast")
        np.testing.assert_array_equal(comparison.columns["heading_iae_degs"],
                                      numbers(written["heading_iae_degs"]))
        self.assertIn("combined", str(comparison))

    def test_models_and_gains_are_written_and_read_back(self):
        awmr.write_model(self.model, self.path / "again.json")
        self.assertEqual(awmr.read_model(self.path / "again.json").text(), self.model.text())
        gains = awmr.Gains(lambda_=3, mu=50, epsilon=12, speed_mu=5, speed_epsilon=1.2, friction_width_radps=0.1)
        awmr.write_gains(gains, self.path / "own.json")
        self.assertEqual(awmr.read_gains(self.path / "own.json").epsilon, 12)
        self.assertEqual(awmr.read_gains(self.path / "own.json").friction_width_radps, 0.1)
        self.assertEqual(gains.combined_friction_width_radps, 0.05)
        narrow = awmr.Gains(lambda_=3, mu=50, epsilon=12, speed_mu=5, speed_epsilon=1.2, combined_friction_width_radps=0.03)
        awmr.write_gains(narrow, self.path / "own.json")
        self.assertEqual(awmr.read_gains(self.path / "own.json").combined_friction_width_radps, 0.03)

    def test_a_mode_can_have_gains_of_its_own(self):
        gains = json.loads((self.path / "gains.json").read_text())
        gains["modes"] = {"steering": {"heading": {"lambda": 1, "mu": 20, "epsilon": 8},
                                       "speed": {"mu": 2, "epsilon": 1}}}
        (self.path / "by_mode.json").write_text(json.dumps(gains))
        by_mode = awmr.read_mode_gains(self.path / "by_mode.json")
        self.assertEqual(by_mode.in_mode("steering").lambda_, 1)
        self.assertEqual(by_mode.in_mode("combined").lambda_, self.gains.lambda_)
        scenario = awmr.read_scenario(SCENARIO)
        ours = awmr.simulate(self.model, by_mode, scenario, mode="steering")
        own = awmr.simulate(self.model, by_mode.in_mode("steering"), scenario, mode="steering")
        self.assertEqual(ours.csv(), own.csv())
        with self.assertRaises(awmr.InputError):
            by_mode.in_mode("sideways")

    def test_the_next_trial_is_suggested(self):
        made = command("suggest", "--model", self.path / "model.json", "--json")
        best = json.loads(made.stdout)["result"]["trials"][0]
        ours = awmr.suggest(self.model)[0]
        self.assertEqual(ours["std_error_after"], best["std_error_after"])
        self.assertEqual(ours["numbers"], best["settings"])

    def assert_raises_as(self, kind, call, *words):
        """Checks that the exception has the lines that the command prints, without "error: "."""
        told = command(*words)
        with self.assertRaises(kind) as raised:
            call()
        lines = [line for line in told.stderr.splitlines() if line.startswith("error: ")]
        self.assertEqual(str(raised.exception).splitlines(), [line[7:] for line in lines])
        self.assertEqual(raised.exception.exit_code, told.returncode)
        self.assertEqual(len(raised.exception.faults), len(lines))

    def test_errors_are_the_command_lines(self):
        vehicle = PAPER / "vehicle.json"
        wrong = TABLES / "coastdown.csv"
        self.assert_raises_as(awmr.InputError, lambda: awmr.load_trials(self.vehicle, surge=wrong),
                              "identify", "--vehicle", vehicle, "--surge", wrong, "-o",
                              self.path / "no.json")
        self.assert_raises_as(awmr.InputError, lambda: awmr.read_vehicle("nowhere.json"),
                              "identify", "--vehicle", "nowhere.json", "--surge", wrong, "-o",
                              self.path / "no.json")
        self.assertTrue(issubclass(awmr.Refused, awmr.Error))
        trials = awmr.load_trials(self.vehicle, **tables())
        for options in ({"method": "guess"}, {"fit": ["mass"]}, {"family": ["odd"]},
                        {"starts": -1}, {"starts": 1001}, {"time_limit_s": float("nan")}, {"loss": "none"}):
            with self.assertRaises(awmr.InputError):
                awmr.identify(trials, **options)
        for call in (lambda: awmr.load_trials(self.vehicle),
                     lambda: awmr.load_trials(self.vehicle, log=DRIVE, prefer="both"),
                     lambda: awmr.load_trials(self.vehicle, log=DRIVE, columns=["speed_mps"]),
                     lambda: awmr.compare(self.model, self.gains, []),
                     lambda: awmr.simulate(self.model, self.gains, awmr.read_scenario(SCENARIO),
                                           mode="sideways"),
                     lambda: awmr.Gains(lambda_=0, mu=1, epsilon=1, speed_mu=1, speed_epsilon=1),
                     lambda: awmr.Gains(lambda_=3, mu=50, epsilon=12, speed_mu=5, speed_epsilon=1.2,
                                        observer_bandwidth_radps=2),
                     lambda: awmr.simulate(self.model,
                                           awmr.Gains(lambda_=3, mu=50, epsilon=12, speed_mu=5,
                                                      speed_epsilon=1.2, observer_bandwidth_radps=200,
                                                      observer_yaw_max_m=0.1, observer_surge_max=1),
                                           awmr.read_scenario(SCENARIO), mode="combined"),
                     lambda: awmr.tune(self.model, draws=-1),
                     lambda: awmr.tune(self.model, nominal=True, draws=3)):
            with self.assertRaises(awmr.InputError):
                call()
        with self.assertRaises(TypeError):
            awmr.identify(trials, stars=3)

    def test_every_function_says_what_it_does(self):
        for name in ("load_trials", "identify", "tune", "simulate", "compare", "suggest",
                     "read_vehicle", "read_model", "read_scenario", "read_gains"):
            self.assertGreater(len(getattr(awmr, name).__doc__.splitlines()), 1, name)


if __name__ == "__main__":
    unittest.main()
