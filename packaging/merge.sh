#!/usr/bin/env bash
# Packs all binaries under out/binaries/ (linux64, win64) into out/TreadBlock.fmu.
set -euo pipefail
cd "$(dirname "$0")/.."
. packaging/env.sh
libraries=()
for file in out/binaries/*/TreadBlock.*; do
    libraries+=(--library "$(basename "$(dirname "$file")")=$file")
done
cargo run --quiet --release --bin tread -- fmu build --out out/TreadBlock.fmu "${libraries[@]}"
