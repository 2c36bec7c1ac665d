"""Drives the block in cofmupy and prints the outputs after each step as JSON.

    python cofmupy_run.py FMU STEP OUTPUT... < position of the belt and load, a line per step

Run by tests/python/test_other_masters.py in an environment of its own: cofmupy wants old versions of
packages that the other masters want new.
"""

import contextlib
import json
import sys

from cofmupy import Coordinator

fmu, step, *outputs = sys.argv[1:]
config = {
    "fmus": [{"id": "block", "name": "block", "path": fmu, "initialization": {}}],
    "connections": [],
    "cosim_method": "jacobi",
    "iterative": False,
    "edge_sep": "->",
    "root": "",
}
with contextlib.redirect_stdout(sys.stderr):
    coordinator = Coordinator()
    coordinator.start(config)
    master, rows = coordinator.master, []
    for line in sys.stdin:
        x, load = map(float, line.split())
        inputs = {"belt.x": [x], "belt.z": [0.0], "belt.angle": [0.0], "normal_load": [load]}
        told = master.do_step(float(step), input_dict={"block": inputs})
        rows.append([told["block"][name][0] for name in outputs])
json.dump(rows, sys.stdout)
