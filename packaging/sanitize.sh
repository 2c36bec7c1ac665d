#!/usr/bin/env bash
# The C hosts under AddressSanitizer, UndefinedBehaviorSanitizer and LeakSanitizer, with the library that
# ships: what it takes from the heap and does not give back is found too, also when it is unloaded.
set -euo pipefail
cd "$(dirname "$0")/.."
. packaging/env.sh
say() { echo "sanitize: $*" >&2; }

description=modelDescription/modelDescription.xml
reference() { grep -oE "name=\"$1\" valueReference=\"[0-9]+\"" "$description" | grep -oE '[0-9]+"$' | tr -d '"'; }
guid=$(grep -oE ' guid="[^"]+"' "$description" | cut -d'"' -f2)
references=()
for name in belt.x normal_load solver.elements_along solver.elements_up force.x; do
    references+=("$(reference "$name")")
done

library=out/binaries/linux64/TreadBlock.so
[ -f "$library" ] || packaging/linux64.sh
mkdir -p out/sanitize
for host in host manners threads; do
    cc -O1 -g -fsanitize=address,undefined -fno-sanitize-recover=all -o "out/sanitize/$host" \
        "tests/c/$host.c" -ldl -lpthread -lm
done
# Messages of the hosts are kept; a finding ends the script and is shown.
run() {
    local host=$1
    shift
    "out/sanitize/$host" "$library" "$guid" "$@" > "out/sanitize/$host.txt" 2>&1 ||
        { tail -40 "out/sanitize/$host.txt" >&2; say "$host failed"; exit 1; }
}
run host 100 "${references[@]}"
run manners "${references[@]}"
run threads "${references[@]}"
say "no error, no undefined behaviour, no leak"
