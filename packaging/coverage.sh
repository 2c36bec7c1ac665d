#!/usr/bin/env bash
# Lines that the Rust tests reach, by module: out/coverage/summary.csv, and lines in out/coverage/html.
#
#   packaging/coverage.sh                        all tests
#   packaging/coverage.sh --lib --test gap       some of them, as cargo test takes them
#
# Only this package is instrumented; what it depends on is shared with ordinary builds.
set -euo pipefail
cd "$(dirname "$0")/.."
. packaging/env.sh
out=$PWD/out/coverage
tools=$(rustc --print sysroot)/lib/rustlib/$(rustc -vV | sed -n 's/^host: //p')/bin
[ -x "$tools/llvm-cov" ] || rustup component add llvm-tools >&2
rm -rf "$out"
mkdir -p "$out/raw"
printf '#!/bin/sh\nrustc=$1\nshift\nexec "$rustc" -C instrument-coverage "$@"\n' > "$out/rustc"
chmod +x "$out/rustc"
export RUSTC_WORKSPACE_WRAPPER=$out/rustc CARGO_INCREMENTAL=0 LLVM_PROFILE_FILE=$out/raw/%p-%m.profraw

cargo test --quiet --no-run --message-format=json "$@" |
    sed -n 's/.*"executable":"\([^"]*\)".*/--object=\1/p' | sort -u > "$out/objects"
cargo test --quiet --no-fail-fast "$@" >&2
"$tools/llvm-profdata" merge --sparse "$out"/raw/*.profraw -o "$out/tests.profdata"
rm -r "$out/raw"
mapfile -t objects < "$out/objects"
look=("${objects[@]}" --instr-profile="$out/tests.profdata" --sources src)
"$tools/llvm-cov" export "${look[@]}" --summary-only --format=text > "$out/summary.json"
"$tools/llvm-cov" show "${look[@]}" --format=html --output-dir="$out/html"
.venv/bin/python packaging/coverage.py "$out/summary.json" | tee "$out/summary.csv"
