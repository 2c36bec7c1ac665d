"""llvm-cov's summary by module of src/: lines, lines reached, share; the modules in ARCHITECTURE.md's order."""

import json
import re
import sys
from collections import defaultdict
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


def main(summary):
    modules = defaultdict(lambda: [0, 0])
    for file in json.loads(Path(summary).read_text())["data"][0]["files"]:
        path = Path(file["filename"]).resolve().relative_to(ROOT / "src")
        lines = file["summary"]["lines"]
        for name in (path.parts[0].removesuffix(".rs"), "all"):
            modules[name][0] += lines["count"]
            modules[name][1] += lines["covered"]
    order = re.findall(r"`src/(\w+)", (ROOT / "ARCHITECTURE.md").read_text()) + ["all"]
    print("module,lines,reached,per_cent")
    for name in sorted(modules, key=lambda m: order.index(m) if m in order else len(order) - 2):
        count, covered = modules[name]
        print(f"{name},{count},{covered},{100 * covered / max(count, 1):.1f}")


if __name__ == "__main__":
    main(sys.argv[1])
