#!/usr/bin/env bash
# The minimum supported Rust version is what Cargo.toml says: no dependency asks for more, and where that very
# toolchain is installed it checks the sources. That no newer part of the standard library is used is clippy's
# business (incompatible_msrv, denied in the lint stage).
set -euo pipefail
cd "$(dirname "$0")/.."
. packaging/env.sh
minimum=$(sed -n 's/^rust-version = "\(.*\)"/\1/p' Cargo.toml)
cargo metadata --format-version 1 --locked | .venv/bin/python -c '
import json, sys
minimum = tuple(int(n) for n in sys.argv[1].split("."))
packages = json.load(sys.stdin)["packages"]
newer = [p["name"] + " needs Rust " + p["rust_version"] for p in packages
         if p["rust_version"] and tuple(int(n) for n in p["rust_version"].split("."))[:2] > minimum]
print("\n".join(newer) or f"{len(packages)} packages are content with Rust {sys.argv[1]}")
sys.exit(bool(newer))' "$minimum"
if rustup toolchain list 2>/dev/null | grep -q "^$minimum"; then
    cargo "+$minimum" check --quiet --locked --target-dir target/msrv
    echo "Rust $minimum compiles the sources"
else
    echo "Rust $minimum is not installed (rustup toolchain install $minimum): sources not compiled with it"
fi
