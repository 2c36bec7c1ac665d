#!/usr/bin/env bash
# The finished FMU for linux64 and win64, checked by its validators, with checksums, in out/release/:
#
#   TreadBlock.fmu   SHA256SUMS (of the FMU and of each library in it)   BUILD.txt (revision and compilers)
set -euo pipefail
cd "$(dirname "$0")/.."
. packaging/env.sh
packaging/linux64.sh
packaging/win64.sh
packaging/check.sh out/binaries/linux64/TreadBlock.so

rm -rf out/release
mkdir -p out/release
cp out/TreadBlock.fmu out/release/
cd out/release
inside=$(../../.venv/bin/python -m zipfile -l TreadBlock.fmu)
for library in binaries/linux64/TreadBlock.so binaries/win64/TreadBlock.dll; do
    grep -q "$library" <<< "$inside" || { echo "release: $library is not in the FMU" >&2; exit 1; }
done
../../.venv/bin/fmpy validate TreadBlock.fmu
# XSD, fmpy, fmutool -check, fmureader, and what the archive has to hold.
(cd ../.. && TREAD_FMU=out/release/TreadBlock.fmu .venv/bin/python -m pytest -q -p no:cacheprovider \
    tests/python/test_validators.py)

cp -r ../binaries .
sha256sum TreadBlock.fmu binaries/linux64/TreadBlock.so binaries/win64/TreadBlock.dll > SHA256SUMS
rm -r binaries
{
    echo "revision $(git describe --always --dirty --tags 2>/dev/null || echo unknown)"
    echo "linux64  $(rustc --version), linked against glibc 2.17"
    echo "win64    $("$(dpkg -L rustc-web | grep 'bin/rustc$')" --version), x86_64-win7-windows-gnu"
    cat ../win64-against-linux64.txt
} > BUILD.txt
cat BUILD.txt SHA256SUMS
