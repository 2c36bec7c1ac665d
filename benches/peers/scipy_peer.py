"""scipy's solvers on the reduced equations, with the compiled right-hand side of rhs.c.

    scipy_peer.py METHOD MODEL RTOL ATOL DURATION STEP TRACE [LIMIT]    METHOD: LSODA, BDF, Radau

Output as of cvode.c. After LIMIT seconds it stops and tells how far it came: what it costs per simulated
time is known then, too.
"""

import ctypes
import json
import sys
import time
from pathlib import Path

import numpy as np
from scipy import integrate

method, model, rtol, atol, duration, step, trace = sys.argv[1:8]
limit = float(sys.argv[8]) if len(sys.argv) > 8 else float("inf")
rtol, atol, duration, step = map(float, (rtol, atol, duration, step))
library = ctypes.CDLL(str(Path(__file__).resolve().parents[2] / "out/bench/librhs.so"))
library.problem_read.restype = ctypes.c_void_p
library.problem_calls.restype = ctypes.c_long
problem = ctypes.c_void_p(library.problem_read(model.encode()))
size = library.problem_size(problem)
modes = size // 2 - 1
state, rate, seen = np.zeros(size), np.zeros(size), np.zeros(3)
library.problem_start(problem, state.ctypes.data_as(ctypes.c_void_p))
evaluate = library.problem_rhs
evaluate.argtypes = [ctypes.c_void_p, ctypes.c_double, ctypes.c_void_p, ctypes.c_void_p]
library.problem_observe.argtypes = evaluate.argtypes


def rhs(t, y):
    # Solvers also hand over columns of a matrix, which are not contiguous.
    y = np.ascontiguousarray(y)
    evaluate(problem, t, y.ctypes.data, rate.ctypes.data)
    return rate.copy()


tolerance = np.full(size, atol)
tolerance[modes:2 * modes] = tolerance[-1] = 2e4 * atol
# Two steps more than wanted, so that the last row is inside of a step.
solver = getattr(integrate, method)(rhs, 0.0, state, duration + 2 * step, rtol=rtol, atol=tolerance)
rows, at, steps, start = [], 0, 0, time.process_time()
spent = 0.0
while at <= round(duration / step) and spent < limit:
    solver.step()
    steps += 1
    if solver.status == "failed":
        sys.exit("the solver failed")
    if at * step <= solver.t:
        inside = solver.dense_output()
        while at * step <= solver.t and at <= round(duration / step):
            y = np.ascontiguousarray(inside(at * step))
            library.problem_observe(problem, at * step, y.ctypes.data, seen.ctypes.data)
            rows.append((at * step, *seen, 0.0))
            at += 1
    spent = time.process_time() - start
names = "time,run_in.displacement.x,run_in.velocity.x,contact.friction_coefficient,contact.stick_fraction"
np.savetxt(trace, rows, delimiter=",", header=names, comments="", fmt="%.17g")
print(json.dumps({"seconds": [spent], "duration": float(min(solver.t, duration)), "steps": steps,
                  "calls": library.problem_calls(problem), "whole": bool(solver.t >= duration)}))
