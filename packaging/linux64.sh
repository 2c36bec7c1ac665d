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
root=$PWD
. packaging/env.sh

target_dir=${CARGO_TARGET_DIR:-$root/target}
binaries=out/binaries/linux64
mkdir -p "$binaries"

# The shipped library carries no debug symbols.
export CARGO_PROFILE_RELEASE_DEBUG=0 CARGO_PROFILE_RELEASE_STRIP=symbols

zig_works() {
    [ -z "${TREAD_NO_ZIG:-}" ] && [ "$(uname -m)" = x86_64 ] &&
        echo 'int main(void){return 0;}' | packaging/zigcc.sh -x c - -o out/.zig-probe 2>/dev/null &&
        rm -f out/.zig-probe
}

if zig_works; then
    echo "building the library for glibc 2.17" >&2
    CARGO_TARGET_X86_64_UNKNOWN_LINUX_GNU_LINKER=$root/packaging/zigcc.sh \
    CC_x86_64_unknown_linux_gnu=$root/packaging/zigcc.sh \
    cargo build --quiet --release --lib --no-default-features \
        --target x86_64-unknown-linux-gnu --target-dir "$target_dir/fmu"
    built=$target_dir/fmu/x86_64-unknown-linux-gnu/release/libtread_block.so
else
    echo "zig is not at hand (packaging/setup.sh build installs it): building for this machine's glibc" >&2
    cargo build --quiet --release --lib --no-default-features --target-dir "$target_dir/fmu"
    built=$target_dir/fmu/release/libtread_block.so
fi
cp "$built" "$binaries/TreadBlock.so"
unset CARGO_PROFILE_RELEASE_DEBUG CARGO_PROFILE_RELEASE_STRIP

packaging/merge.sh
