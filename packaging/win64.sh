#!/usr/bin/env bash
# Builds the FMU's win64 library on Debian, drives it under wine through a whole run, compares its
# numbers with linux64's, and packs it into out/TreadBlock.fmu.
#
# rustup has no windows library for an offline machine; Debian's rustc-web with rust-web-src builds
# one (-Zbuild-std). Target x86_64-win7-windows-gnu: it needs nothing that wine 8 or Windows 7 lack.
# RUSTC_BOOTSTRAP is confined to this script. The compiler is another one than linux64's: its version
# is printed and belongs into the release notes.
set -euo pipefail
cd "$(dirname "$0")/.."
. packaging/env.sh
say() { echo "win64: $*" >&2; }

packaging/apt.sh rustc-web rust-web-src gcc-mingw-w64-x86-64-win32 wine wine64
mark=$(source_mark) # of before the build
rustc=$(dpkg -L rustc-web | grep 'bin/rustc$')
target=x86_64-win7-windows-gnu
target_dir=${CARGO_TARGET_DIR:-$PWD/target}/win64
say "compiler: $("$rustc" --version)"
# bindgen looks up the compiler's own headers only when it builds for the host.
BINDGEN_EXTRA_CLANG_ARGS_x86_64_win7_windows_gnu="-I$(x86_64-w64-mingw32-gcc -print-file-name=include)" \
CC_x86_64_win7_windows_gnu=x86_64-w64-mingw32-gcc AR_x86_64_win7_windows_gnu=x86_64-w64-mingw32-ar \
CARGO_TARGET_X86_64_WIN7_WINDOWS_GNU_LINKER=$PWD/packaging/mingwld.sh \
RUSTC=$rustc RUSTC_BOOTSTRAP=1 CARGO_PROFILE_RELEASE_DEBUG=0 CARGO_PROFILE_RELEASE_STRIP=symbols \
    cargo build --quiet --release --lib --no-default-features -Zbuild-std=std,panic_unwind \
    --target "$target" --target-dir "$target_dir"
mkdir -p out/binaries/win64
rm -f out/binaries/win64/source
cp "$target_dir/$target/release/tread_block.dll" out/binaries/win64/TreadBlock.dll

exports=$(x86_64-w64-mingw32-objdump -p out/binaries/win64/TreadBlock.dll |
    sed -n '/Ordinal\/Name Pointer/,/^$/p' | grep -oE '[A-Za-z_][A-Za-z0-9_]*$' | grep -v Table || true)
strangers=$(echo "$exports" | grep -v '^fmi2' || true)
[ -z "$strangers" ] || { say "the DLL exports more than the interface:" $strangers; exit 1; }
[ "$(echo "$exports" | grep -c '^fmi2')" = 44 ] || { say "the DLL does not export 44 functions"; exit 1; }

[ "$(cat out/binaries/linux64/source 2>/dev/null)" = "$mark" ] || packaging/linux64.sh
x86_64-w64-mingw32-gcc -O1 -D__USE_MINGW_ANSI_STDIO=1 -o out/host.exe tests/c/host.c
cc -O1 -o out/host tests/c/host.c -ldl

description=modelDescription/modelDescription.xml
guid=$(grep -oE 'guid="[^"]+"' "$description" | cut -d'"' -f2)
reference() { grep -oE "name=\"$1\" valueReference=\"[0-9]+\"" "$description" | grep -oE '[0-9]+"$' | tr -d '"'; }
arguments=("$guid" 3)
for name in belt.x normal_load solver.elements_along solver.elements_up force.x; do
    arguments+=("$(reference "$name")")
done

prefix=$(mktemp -d)
trap 'WINEPREFIX=$prefix wineserver -k 2>/dev/null || true; sleep 1; rm -rf "$prefix"' EXIT
say "driving the DLL under wine"
WINEPREFIX=$prefix WINEDEBUG=-all wine out/host.exe out/binaries/win64/TreadBlock.dll "${arguments[@]}" |
    tr -d '\r' > out/win64.txt
out/host out/binaries/linux64/TreadBlock.so "${arguments[@]}" > out/linux64.txt

# exp, atan and pow of two C libraries differ in the last bit; 1e-9 of the largest force is far
# below anything that a user sees and far above what the last bits grow to in 40 steps.
paste out/linux64.txt out/win64.txt | awk '
    { if ($1 < 0) a = -$1; else a = $1; if (a > size) size = a
      d = $1 - $2; if (d < 0) d = -d; if (d > worst) worst = d; n++ }
    END {
        printf "win64 against linux64: %d steps, largest difference %.3g of %.3g N\n", n, worst, size
        exit !(n == 40 && worst <= 1e-9 * size)
    }' | tee out/win64-against-linux64.txt
# Only a library that has passed is packed.
echo "$mark" > out/binaries/win64/source
packaging/merge.sh
