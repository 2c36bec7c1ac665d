#!/bin/sh
# Compiler and linker for glibc 2.17, from the project's virtual environment.
here=$(cd "$(dirname "$0")/.." && pwd)
PATH="$here/.venv/bin:$PATH"
export CARGO_ZIGBUILD_ZIG_COMMAND="$here/.venv/bin/python" CARGO_ZIGBUILD_ZIG_COMMAND_ARGS='-m ziglang'
# zig's linker does not know --exclude-libs; of several version scripts it heeds the last.
for argument; do
    shift
    case $argument in
        -Wl,--exclude-libs,ALL) argument=-Wl,--version-script=$here/packaging/exports.map ;;
    esac
    set -- "$@" "$argument"
done
exec cargo-zigbuild zig cc -- -fno-sanitize=all -target x86_64-linux-gnu.2.17 "$@"
