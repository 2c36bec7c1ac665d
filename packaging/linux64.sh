#!/usr/bin/env bash
# Builds the FMU's linux64 library and packs the FMU.
#
#   packaging/linux64.sh            -> out/TreadBlock.fmu
#
# The library is linked by zig against glibc 2.17 (2012), so that it loads on every distribution in
# use. Where zig cannot be had the machine's own linker serves: the FMU then needs a glibc as new as
# this machine's. TREAD_NO_ZIG=1 asks for that.
set -euo pipefail
cd "$(dirname "$0")/.."
. packaging/env.sh

echo "building the library" >&2
mark=$(source_mark) # of before: who edits while it builds gets an old library
folder=$(build_libraries --lib --no-default-features)
mkdir -p out/binaries/linux64
cp "$folder/libtread_block.so" out/binaries/linux64/TreadBlock.so
echo "$mark" > out/binaries/linux64/source

packaging/merge.sh
