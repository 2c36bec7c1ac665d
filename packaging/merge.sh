#!/usr/bin/env bash
# Packs all binaries under out/binaries/ (linux64, win64) into out/TreadBlock.fmu.
set -euo pipefail
cd "$(dirname "$0")/.."
. packaging/env.sh
libraries=()
for file in out/binaries/*/TreadBlock.*; do
    libraries+=(--library "$(basename "$(dirname "$file")")=$file")
done
# A `tread` that is already there may pack (TREAD=...), as long as it is of this very source.
if [ -x "${TREAD:-}" ]; then
    "$TREAD" fmu build --out out/TreadBlock.fmu "${libraries[@]}"
else
    cargo run --quiet --release --bin tread -- fmu build --out out/TreadBlock.fmu "${libraries[@]}"
fi
