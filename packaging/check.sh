#!/usr/bin/env bash
# What a linux64 library may show and need: only fmi2* functions out, glibc 2.17 and nothing else in.
set -euo pipefail
library=$1
expected=${2:-44} # functions of the interface that it offers
complain() { echo "$library: $*"; exit 1; }

strangers=$(nm -D --defined-only "$library" | awk '{print $3}' | grep -v '^fmi2' || true)
[ -z "$strangers" ] || complain "exports more than the interface: $(echo "$strangers" | head -5)"

functions=$(nm -D --defined-only "$library" | grep -c ' T fmi2')
[ "$functions" = "$expected" ] || complain "exports $functions functions, not $expected"

needed=$(objdump -p "$library" | awk '/NEEDED/ {print $2}')
foreign=$(echo "$needed" | grep -vE '^(libc|libm|libpthread|libdl|librt|ld-linux-x86-64)\.so' || true)
if [ "${TREAD_NO_ZIG:-}" != 1 ]; then
    [ -z "$foreign" ] || complain "needs $foreign"
    newest=$(objdump -T "$library" | grep -oE 'GLIBC_[0-9.]+' | sort -uV | tail -1)
    [ "$(printf '%s\nGLIBC_2.17\n' "$newest" | sort -V | tail -1)" = GLIBC_2.17 ] ||
        complain "needs $newest, allowed is GLIBC_2.17"
    echo "$library: $functions functions, $newest, needs $(echo $needed)"
fi
