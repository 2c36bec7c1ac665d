"""Runs TreadBlock.fmu in fmpy on two inputs, sliding and rolling, and draws what the block does.

    python demo/demo.py --fmu out/TreadBlock.fmu --tread target/release/tread --out out/demo

Everything but the deformed shapes comes out of the FMU, as any importer would see it. Shapes need the
displacements of all nodes, which are no outputs; `tread simulate --field` gives them from the same model.
"""

import argparse
import sys
import time
from pathlib import Path

import cases
import plots_rolling
import plots_sliding
import table


def parse():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--fmu", type=Path, default=Path("out/TreadBlock.fmu"))
    parser.add_argument("--tread", type=Path, default=Path("target/release/tread"),
                        help="the command line, for shapes and metrics")
    parser.add_argument("--out", type=Path, default=Path("out/demo"))
    return parser.parse_args()


def main():
    arguments = parse()
    for file, remedy in [(arguments.fmu, "make fmu"), (arguments.tread, "cargo build --release")]:
        if not file.exists():
            sys.exit(f"demo: {file} is missing; `{remedy}` makes it")
    arguments.out.mkdir(parents=True, exist_ok=True)
    tread = cases.Tread(arguments.tread.resolve(), arguments.out)
    results, seconds = {}, {}
    for case in (cases.SLIDING, cases.ROLLING):
        start = time.perf_counter()
        results[case.name] = cases.run_in_fmpy(arguments.fmu, case, arguments.out)
        seconds[case.name] = time.perf_counter() - start
    say("shapes from the library, the same block on the same inputs")
    edge = tread.edge_history(cases.SLIDING)
    instants = plots_rolling.instants(results["rolling"])
    shapes = tread.shapes(cases.ROLLING, list(instants.values()))
    say("drawing")
    files = plots_sliding.draw(results["sliding"], edge, arguments.out)
    files += plots_rolling.draw(results["rolling"], instants, shapes, arguments.out)
    metrics = tread.metrics(arguments.out / "sliding.csv", cases.SLIDING.speed)
    print(table.text(metrics, results, seconds))
    print("\nfiles in", arguments.out)
    for file in sorted(files + list(arguments.out.glob("*.csv"))):
        print("  ", file.name)


def say(text):
    print(text, file=sys.stderr)


if __name__ == "__main__":
    main()
