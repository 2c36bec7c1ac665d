#!/usr/bin/env bash
# The finished FMU for linux64 and win64, checked by its validators, with checksums, in out/release/.
set -euo pipefail
cd "$(dirname "$0")/.."
. packaging/env.sh
packaging/linux64.sh
packaging/win64.sh
packaging/check.sh out/binaries/linux64/TreadBlock.so
.venv/bin/fmpy validate out/TreadBlock.fmu
cargo run --quiet --release --bin tread -- fmu check out/TreadBlock.fmu
mkdir -p out/release
cp out/TreadBlock.fmu out/release/
(cd out/release && sha256sum TreadBlock.fmu > TreadBlock.fmu.sha256 && cat TreadBlock.fmu.sha256)
