"""`make bench`: every speed goal as a ratio measured side by side, in out/bench/summary.csv.

    .venv/bin/python benches/bench.py [PART …]      all parts if none is named

Machines are noisy: times are the processor's (what the wall's clock shows on an idle machine), but for the
sweep on two cores; each ratio alternates its two sides and takes medians. A peer is compared at equal accuracy: at the cheapest of its tolerances that keeps stick-slip
frequency and mean friction within 0.5 % of the converged solution, which is what we are held to as well.
"""

from __future__ import annotations

import csv
import json
import os
import statistics
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path

import counting
import pictures

ROOT = Path(__file__).resolve().parents[1]
OUT = ROOT / "out" / "bench"
PYTHON = sys.executable
LIMIT = 0.5  # % of frequency and mean friction
DURATION, STEP = 0.03, 20e-6  # s
CONVERGED = ["solver.max_step=0.3e-6", "solver.tolerance=1e-4"]
LENGTHS = (15, 45)  # mm
STEPS = (2.5, 5, 10, 12.5, 15, 17.5)  # us, internal, at most
TOLERANCES = (5e-3, 0.1)  # of a step: as by default, and so loose that steps are equal
# What the speed on its own is judged against: no choice of ours is in it but a fine mesh.
FINE = {15: ["solver.elements_along=20", "solver.elements_up=14", "solver.max_step=0.3e-6"],
        45: ["solver.elements_along=42", "solver.elements_up=12", "solver.max_step=0.6e-6"]}
FINE_ALL = ["solver.frequency_bound=20e3", "solver.tolerance=1e-4"]
POINTS = {15: (7, 8, 10), 45: (16, 18, 20)}  # contact points that the face is given
PEER_SECONDS = 60  # a run of a Python-driven peer is stopped then and counts as far as it came


@dataclass
class Row:
    figure: str
    value: float
    goal: float
    better: str
    unit: str

    def met(self) -> bool:
        return self.value >= self.goal if self.better == "higher" else self.value <= self.goal


def seconds(run: dict) -> float:
    """Processor's seconds of a run: the mean of its repeats, because the kernel counts them in ticks of some 4 ms."""
    return statistics.mean(run["seconds"])


def call(command, **more) -> str:
    # Peers get one core as we do, whatever their linear algebra would take.
    more.setdefault("env", {**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"})
    words = [str(word) for word in command]
    done = subprocess.run(words, capture_output=True, text=True, cwd=ROOT, **more)
    if done.returncode != 0:
        raise RuntimeError(f"{' '.join(words)}\n{done.stdout}{done.stderr}")
    return done.stdout


def build() -> dict[str, Path]:
    """All programs; cargo says where the bench program is."""
    lines = call(["cargo", "bench", "--quiet", "--bench", "block", "--no-run", "--message-format=json"])
    found = [json.loads(line) for line in lines.splitlines() if line.startswith("{")]
    block = next(m["executable"] for m in found if m.get("target", {}).get("name") == "block"
                 and m.get("executable"))
    call(["cargo", "build", "--quiet", "--release", "--bin", "tread"])
    call(["cargo", "build", "--quiet", "--release", "--manifest-path", "benches/diffsol/Cargo.toml",
          "--target-dir", "target/diffsol"])
    fast = ["cc", "-std=gnu11", "-O3", "-march=native", "-ffast-math", "-Ibenches/peers"]
    rhs = "benches/peers/rhs.c"
    call([*fast, "-shared", "-fPIC", rhs, "-o", OUT / "librhs.so", "-lm"])
    call([*fast, "benches/peers/cvode.c", rhs, "-o", OUT / "cvode", "-lsundials_cvode",
          "-lsundials_nvecserial", "-lsundials_sunmatrixdense", "-lsundials_sunlinsoldense", "-lm"])
    call([*fast, "benches/peers/peak.c", "-o", OUT / "peak"])
    call(["cc", "-O2", "benches/peers/fmu_host.c", "-o", OUT / "fmu_host", "-ldl"])
    return {"block": Path(block), "tread": ROOT / "target/release/tread",
            "diffsol": ROOT / "target/diffsol/release/diffsol-peer"}


class Bench:
    def __init__(self) -> None:
        OUT.mkdir(parents=True, exist_ok=True)
        self.programs = build()
        self.rows: list[Row] = []
        self.points: list[dict] = []  # of the work-precision diagram
        self.notes: list[str] = []
        self.converged: dict[int, dict] = {}
        self.fine: dict[int, dict] = {}
        self.chosen: dict[int, tuple[str, ...]] = {}
        self.quickest: dict[int, tuple[str, ...]] = {}

    # What the parts share.

    @staticmethod
    def stepping(step: float, tolerance: float) -> tuple[str, ...]:
        """Settings of internal steps of at most `step` us; communication steps are twice as long at least."""
        return (f"step={max(1e6 * STEP, 2 * step):g}e-6", f"solver.max_step={step}e-6", f"solver.tolerance={tolerance}")

    def ours(self, length: int, *settings, repeats: int = 20) -> dict:
        return json.loads(call([self.programs["block"], "run", length, f"duration={DURATION}", f"step={STEP}",
                                f"repeats={repeats}", *settings]))

    def reference(self, length: int) -> dict:
        if length not in self.converged:
            self.converged[length] = self.ours(length, *CONVERGED, repeats=1)
        return self.converged[length]

    def fine_reference(self, length: int) -> dict:
        if length not in self.fine:
            self.fine[length] = self.ours(length, *FINE[length], *FINE_ALL, repeats=1)
        return self.fine[length]

    @staticmethod
    def off(found: dict, best: dict) -> float:
        """Larger error of frequency and mean friction [%]."""
        return max(abs(100 * (found[key] / best[key] - 1)) for key in ("frequency", "friction"))

    def error(self, length: int, found: dict) -> float:
        """Error against the converged solution of the same equations [%]."""
        return self.off(found, self.reference(length))

    def choose(self, length: int, candidates, best: dict, what: str) -> tuple[str, ...]:
        """The fastest of the settings that keep the error."""
        found = []
        for settings in candidates:
            run = self.ours(length, *settings)
            error = self.off(run, best)
            self.note(f"l = {length}, {' '.join(settings)}: error {error:.3f} % (limit {LIMIT}) against {what}")
            if error <= LIMIT:
                found.append((seconds(run), settings))
        # The clock wanders: the quickest few once more, in turn. None is: the default, whose speed then does not count.
        few = [settings for _, settings in sorted(found)[:4]]
        rounds = [[seconds(self.ours(length, *settings)) for settings in few] for _ in range(3)]
        again = [(statistics.median(times), settings) for times, settings in zip(zip(*rounds), few)]
        chosen = min(again, default=(0.0, ()))[1]
        self.note(f"l = {length}: fastest that is accurate enough: {' '.join(chosen) or 'none'}")
        return chosen

    def cheapest(self, length: int) -> tuple[str, ...]:
        """Settings for the peers' equations; peers choose their tolerance the same way."""
        if length not in self.chosen:
            candidates = [self.stepping(step, tolerance) for step in STEPS for tolerance in TOLERANCES]
            self.chosen[length] = self.choose(length, candidates, self.reference(length), "the same equations")
        return self.chosen[length]

    def fastest(self, length: int) -> tuple[str, ...]:
        """Settings for a block of its own: contact points are a choice as well as the step."""
        if length not in self.quickest:
            candidates = [(f"solver.contact_points={points}", *self.stepping(step, tolerance))
                          for points in POINTS[length] for step in STEPS[1:] for tolerance in TOLERANCES]
            self.quickest[length] = self.choose(length, candidates, self.fine_reference(length), "a fine mesh")
        return self.quickest[length]

    def our_rate(self, length: int) -> float:
        """Simulated over wall time, with the cheapest settings."""
        run = self.ours(length, *self.cheapest(length))
        return run["duration"] / seconds(run)

    def add(self, figure: str, value: float, goal: float, better: str = "higher", unit: str = "1") -> None:
        row = Row(figure, value, goal, better, unit)
        self.rows.append(row)
        print(f"{'met   ' if row.met() else 'MISSED'} {figure}: {value:.4g} {unit}, goal {goal:g}",
              file=sys.stderr, flush=True)

    def note(self, text: str) -> None:
        self.notes.append(text)
        print(f"       {text}", file=sys.stderr, flush=True)

    # The parts, one per goal or two.

    def part_realtime(self) -> None:
        for length, goal in zip(LENGTHS, (10, 4)):
            runs = [self.ours(length, *self.fastest(length)) for _ in range(3)]
            rate = statistics.median(r["duration"] / seconds(r) for r in runs)
            error = self.off(runs[0], self.fine_reference(length))
            steps = runs[0]["steps"] / runs[0]["duration"] / 1000
            iterations = runs[0]["iterations"] / runs[0]["steps"]
            self.note(f"l = {length}: error {error:.3f} % (limit {LIMIT}), {runs[0]['nodes']} nodes, "
                      f"{runs[0]['modes']} modes, {steps:.0f} steps/ms, {iterations:.2f} iterations a step, "
                      f"{1e9 / rate / steps / 1000:.0f} ns a step")
            if error > LIMIT:
                self.note(f"l = {length}: not accurate enough, so the speed does not count")
                rate = 0.0
            self.add(f"simulated over wall time, l = {length} mm", rate, goal)
        for name, tolerance in zip(("this model", "this model, equal steps"), TOLERANCES):
            for step in (1.25, 2.5, 5, 10, 15, 20):
                run = self.ours(15, *self.stepping(step, tolerance))
                self.point(name, f"{step} us", run, seconds(run), 15)

    def point(self, solver, setting, found, wall, length) -> float:
        error = self.error(length, found)
        self.points.append({"solver": solver, "setting": setting, "seconds_per_ms": wall / found["duration"] / 1e3,
                            "error_percent": error})
        return error

    def peer(self, name, commands, ladder, goal, limit=None) -> None:
        """All ways of calling it and tolerances; the cheapest accurate one counts. Ours runs before and
        after each."""
        model, accurate, partial = self.model(), [], []
        for command, rtol in [(command, rtol) for command in commands for rtol in ladder]:
            trace = OUT / "trace.csv"
            words = [*command, model, rtol, rtol * 3e-7, DURATION, STEP, trace, *([limit] if limit else [])]
            before = self.our_rate(15)
            try:
                run = json.loads(call(words))
            except RuntimeError as error:
                self.note(f"{name} at rtol {rtol:g} fails: {str(error).strip().splitlines()[-1]}")
                continue
            ratio = 0.5 * (before + self.our_rate(15)) * run["seconds"][0] / run["duration"]
            if not run.get("whole", True):
                self.note(f"{name} at rtol {rtol:g}: stopped after {limit} s at {1e3 * run['duration']:.2f} ms; "
                          f"{ratio:.0f} times our time, accuracy not judged")
                partial.append(ratio)
                continue
            found = json.loads(call([self.programs["tread"], "metrics", trace, "--speed", 0.3, "--json"]))
            found = {"frequency": found["stick-slip frequency"]["value"],
                     "friction": found["mean friction"]["value"], "duration": run["duration"]}
            way = " ".join(str(word) for word in command[1:] if len(commands) > 1)
            error = self.point(f"{name} {way}".strip(), f"rtol {rtol:g}", found, run["seconds"][0], 15)
            self.note(f"{name} {way} at rtol {rtol:g}: error {error:.3f} %, {run['calls']} right-hand sides, "
                      f"{run['steps']} steps, {run['seconds'][0]:.2f} s, {ratio:.0f} times our time")
            if error <= LIMIT:
                accurate.append(ratio)
        # A run that did not come to its end was slower than those that did.
        self.add(f"times faster than {name}", min(accurate or partial or [0.0]), goal)

    def model(self) -> Path:
        path = OUT / "block-15.txt"
        if not path.exists() or path.stat().st_mtime < self.programs["block"].stat().st_mtime:
            call([self.programs["block"], "export", 15, path])
        return path

    def part_cvode(self) -> None:
        self.peer("CVODE", [[OUT / "cvode", way] for way in ("exact", "differences")],
                  [1e-3, 1e-4, 1e-5, 1e-6], 100)

    def part_diffsol(self) -> None:
        self.peer("diffsol", [[self.programs["diffsol"], way] for way in ("bdf", "tr_bdf2")],
                  [1e-2, 1e-3, 1e-4, 1e-5], 100)

    def part_scipy(self) -> None:
        script = ROOT / "benches/peers/scipy_peer.py"
        for method in ("LSODA", "BDF", "Radau"):
            self.peer(f"scipy {method}", [[PYTHON, script, method]], [1e-3, 1e-4, 1e-5, 1e-6], 500,
                      limit=PEER_SECONDS)

    def part_full(self) -> None:
        run = json.loads(call([self.programs["block"], "full", 15, 1e-3]))
        rate = run["duration"] / run["seconds"][0]
        self.note(f"unreduced: {run['dofs']} degrees of freedom, step {1e9 * run['step']:.1f} ns")
        ours = self.ours(15, *self.fastest(15))
        ours = ours["duration"] / seconds(ours)
        self.add("times faster than the unreduced finite elements, explicit", ours / rate, 300)

    def part_nodes(self) -> None:
        cost = []
        for along in (5, 8, 12, 18, 25, 35, 49):
            run = self.ours(45, f"solver.elements_along={along}", repeats=3)
            cost.append((run["nodes"], seconds(run) / run["duration"],
                         run["iterations"] / run["steps"]))
        slope = counting.slope([c[0] for c in cost], [c[1] for c in cost])
        steepest = max(counting.slope([a[0], b[0]], [a[1], b[1]]) for a, b in zip(cost, cost[2:]))
        text = ", ".join(f"{n}: {1e3 * w:.1f}" for n, w, _ in cost)
        self.note(f"wall over simulated time in 1e-3 by contact nodes: {text}; steepest part {steepest:.2f}")
        self.add("slope of cost over contact nodes, up to 99", slope, 2, "lower")
        pictures.nodes(OUT, [(n, w) for n, w, _ in cost], slope)

    def part_sweep(self) -> None:
        plan, times = OUT / "plan.toml", {1: [], 2: []}
        text = (ROOT / "examples/sweep.toml").read_text().replace("duration = 0.02", "duration = 0.03")
        plan.write_text(text.replace("count = 3", "count = 4"))
        for k in range(3):
            for jobs in (1, 2):
                target, start = OUT / f"sweep-{k}-{jobs}", time.perf_counter()
                call(["rm", "-rf", target])
                call([self.programs["tread"], "sweep", plan, "--out", target, "--jobs", jobs, "-q"])
                times[jobs].append(time.perf_counter() - start)
        ratio = statistics.median(a / b for a, b in zip(times[1], times[2]))
        self.note(f"sweep of 48 points: 1 core {times[1]} s, 2 cores {times[2]} s")
        self.add("sweep, 2 cores against 1", ratio, 1.9)

    def part_fmu(self) -> None:
        import fmu_overhead
        found = fmu_overhead.measure(ROOT / "out/TreadBlock.fmu", OUT, lambda: self.our_rate_sampled())
        self.note("one step of 20 us: library {library:.2f} us, FMU from C {c:.2f} us, fmpy's calls in a loop "
                  "{loop:.2f} us, fmpy.simulate_fmu {simulate:.2f} us".format(**found))
        self.note(f"of it through the C interface alone: {100 * (found['c'] / found['library'] - 1):.0f} %")
        value = 100 * (found["loop"] / found["library"] - 1)
        self.add("overhead of the FMU through fmpy at 20 us", value, 25, "lower", "%")

    def our_rate_sampled(self) -> float:
        """Seconds per communication step of the library."""
        run = self.ours(15)
        return seconds(run) / (run["duration"] / STEP)

    def part_flops(self) -> None:
        found = counting.flops(self.programs["block"], OUT)
        run = self.ours(15)  # with the settings that the flops are counted with
        wall = 1e-3 * seconds(run) / run["duration"]
        peak = max(float(call([OUT / "peak"])) for _ in range(2))
        share = 100 * found["flops"] / wall / peak
        self.note(f"{found['flops'] / 1e6:.2f} Mflop and {found['instructions'] / 1e6:.2f} M instructions per "
                  f"simulated ms, {100 * found['vector_share']:.0f} % of the flops in vectors; "
                  f"{found['flops'] / wall / 1e9:.2f} of {peak / 1e9:.1f} Gflop/s, "
                  f"{found['bytes'] / found['flops']:.1f} bytes loaded or stored per flop")
        self.add("flops of the step over the measured peak", share, 20, "higher", "%")
        pictures.roofline(OUT, peak, found, wall)

    def part_instructions(self) -> None:
        import instructions
        count, budget = instructions.count(ROOT / "out/TreadBlock.fmu", OUT), instructions.budget()
        self.add("instructions per simulated ms over the budget (callgrind)", 100 * (count / budget - 1), 3,
                 "lower", "%")

    # All of it.

    def write(self) -> None:
        with open(OUT / "summary.csv", "w", newline="") as file:
            writer = csv.writer(file)
            writer.writerow(["figure", "value", "goal", "better", "unit"])
            for row in self.rows:
                writer.writerow([row.figure, f"{row.value:.4g}", f"{row.goal:g}", row.better, row.unit])
        (OUT / "notes.txt").write_text("\n".join(self.notes) + "\n")
        if self.points:
            with open(OUT / "work-precision.csv", "w", newline="") as file:
                writer = csv.DictWriter(file, self.points[0].keys())
                writer.writeheader()
                writer.writerows(self.points)
            pictures.work_precision(OUT, self.points, LIMIT)


PARTS = ["realtime", "cvode", "diffsol", "scipy", "full", "flops", "nodes", "sweep", "fmu", "instructions"]


def main() -> None:
    wanted = sys.argv[1:] or PARTS
    unknown = [part for part in wanted if part not in PARTS]
    if unknown:
        sys.exit(f"unknown part {', '.join(unknown)}: allowed is {', '.join(PARTS)}")
    bench = Bench()
    for part in wanted:
        getattr(bench, f"part_{part}")()
        # After each part: what is measured is kept if a later one fails.
        bench.write()
    missed = sum(not row.met() for row in bench.rows)
    print((OUT / "summary.csv").read_text(), end="")
    print(f"{len(bench.rows) - missed} of {len(bench.rows)} goals are met", file=sys.stderr)


if __name__ == "__main__":
    main()
