#!/usr/bin/env bash
# The FMUs of examples/chain into out/chain/: the two stages, and the block with a rolling block's
# parameters in its resources.
set -euo pipefail
cd "$(dirname "$0")/.."
. packaging/env.sh
mkdir -p out/chain

manifest=examples/chain/stages/Cargo.toml
folder=$(build_libraries --manifest-path "$manifest" --examples)
for pair in BeltSource=belt_source AcousticStage=acoustic_stage; do
    library=$folder/examples/lib${pair#*=}.so
    packaging/check.sh "$library" 34
    cargo run --quiet --release --manifest-path "$manifest" --bin pack \
        --target-dir "${CARGO_TARGET_DIR:-$PWD/target}/chain" -- \
        "${pair%=*}" "$library" "out/chain/${pair%=*}.fmu"
done
[ -f out/TreadBlock.fmu ] || packaging/linux64.sh
.venv/bin/python examples/chain/system.py out/TreadBlock.fmu out/chain
