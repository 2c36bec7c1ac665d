"""Puts the chain together: the block with its rolling parameters, and Chain.ssp (SSP 1.0).

    python examples/chain/system.py out/TreadBlock.fmu out/chain
"""

import re
import sys
import zipfile
from pathlib import Path

FMUS = ["BeltSource.fmu", "TreadBlock.fmu", "AcousticStage.fmu"]
HERE = Path(__file__).resolve().parent

# On top of the block's defaults: its clamped face follows the belt.
ROLLING = {"drive.normal": "trajectory", "block.height": 0.010, "block.length": 0.015,
           "block.width": 0.015}


def with_parameters(fmu, out, values):
    """Copies an FMU of the block; `values` go into its resources/parameters.toml.

    Masters that cannot set parameters, or only numbers, need no more than that.
    """
    with zipfile.ZipFile(fmu) as source, zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as target:
        for item in source.infolist():
            data = source.read(item)
            if item.filename == "resources/parameters.toml":
                data = changed(data.decode(), values).encode()
            target.writestr(item, data)


def changed(text, values):
    """The TOML text with other values for some of its keys."""
    section, lines, left = "", [], dict(values)
    for line in text.splitlines():
        if header := re.match(r"\[(.+)\]", line):
            section = header[1] + "."
        if key := re.match(r"(\w+) = [^#]+", line):
            name = section + key[1]
            if name in left:
                value = left.pop(name)
                text = f'"{value}"' if isinstance(value, str) else repr(value)
                line = f"{key[1]} = {text} " + line[key.end():]
        lines.append(line)
    if left:
        sys.exit(f"chain: no parameter {', '.join(left)} in resources/parameters.toml")
    return "\n".join(lines) + "\n"


def pack(folder):
    """Chain.ssp from the FMUs in `folder`."""
    with zipfile.ZipFile(folder / "Chain.ssp", "w", zipfile.ZIP_DEFLATED) as ssp:
        ssp.write(HERE / "SystemStructure.ssd", "SystemStructure.ssd")
        for name in FMUS:
            ssp.write(folder / name, f"resources/{name}")


def assemble(fmu, folder, **parameters):
    with_parameters(fmu, folder / "TreadBlock.fmu", {**ROLLING, **parameters})
    pack(folder)


if __name__ == "__main__":
    assemble(Path(sys.argv[1]), Path(sys.argv[2]))
