#!/usr/bin/env bash
# Packs the libraries under out/binaries/ (linux64, win64) into out/TreadBlock.fmu: those that are of this very
# source. An older one would refuse the GUID, or give other numbers than its neighbour.
set -euo pipefail
cd "$(dirname "$0")/.."
. packaging/env.sh
libraries=()
mark=$(source_mark)
for folder in out/binaries/*/; do
    platform=$(basename "$folder")
    if [ "$(cat "$folder/source" 2>/dev/null)" = "$mark" ]; then
        libraries+=(--library "$platform=$(ls "$folder"TreadBlock.*)")
    else
        echo "$platform is not of this source and left out: packaging/$platform.sh builds it" >&2
    fi
done
[ ${#libraries[@]} -gt 0 ] || { echo "no library to pack: packaging/linux64.sh builds one" >&2; exit 1; }
# A `tread` that is already there may pack (TREAD=...), as long as it is of this very source.
if [ -x "${TREAD:-}" ]; then
    "$TREAD" fmu build --out out/TreadBlock.fmu "${libraries[@]}"
else
    cargo run --quiet --release --bin tread -- fmu build --out out/TreadBlock.fmu "${libraries[@]}"
fi
