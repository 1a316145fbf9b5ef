#!/usr/bin/env python3
"""The notebooks of docs/notebooks run from the first cell to the last, and find what they are about; Jupyter is not needed."""

import json
import os
import sys
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
NOTEBOOKS = os.path.join(ROOT, "docs", "notebooks")


def cells_of(name):
    with open(os.path.join(NOTEBOOKS, name), encoding="utf-8") as file:
        return json.load(file)["cells"]


def names():
    return sorted(name for name in os.listdir(NOTEBOOKS) if name.endswith(".ipynb"))


def run(name):
    """What its names stand for at the end. The last line of a cell may be an expression, which Jupyter shows."""
    space = {"__name__": "__main__"}
    for number, cell in enumerate(cells_of(name)):
        if cell["cell_type"] == "code":
            exec(compile("".join(cell["source"]), "%s, cell %d" % (name, number), "exec"), space)
    return space


class Notebooks(unittest.TestCase):
    def test_are_kept_without_what_a_run_leaves(self):
        for name in names():
            for cell in cells_of(name):
                if cell["cell_type"] == "code":
                    self.assertEqual((cell["outputs"], cell["execution_count"]), ([], None), name)

    def test_standing_wave_swings_as_theory_says(self):
        found = run("standing_wave.ipynb")
        self.assertLess(abs(found["found_period"] / found["period"] - 1), 0.03)
        self.assertTrue(0.5 < found["left"] < 1.1, found["left"])
        gauges = found["gauges"]
        swing = gauges.max() - gauges.min()
        self.assertLess(swing["quarter"], 0.4 * swing["wall"])  # where linear theory has none, the second harmonic has some
        self.assertEqual(len(found["axes"].lines), 6)

    def test_all_are_run(self):
        self.assertEqual(names(), ["standing_wave.ipynb"])


if __name__ == "__main__":
    if not os.environ.get("WAVETANK_PYTHON"):
        print("notebooks_test: left out, since the extension for Python is not built")
        sys.exit(0)
    os.environ["MPLBACKEND"] = "Agg"
    try:
        import matplotlib  # noqa: F401
        import pandas  # noqa: F401
    except ImportError as error:
        print("notebooks_test: left out, since %s: scripts/install --tools" % error)
        sys.exit(0)
    unittest.main()
