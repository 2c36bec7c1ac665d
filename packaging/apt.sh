#!/usr/bin/env bash
# Installs those of the distribution's packages that are missing; asks for root only then.
#
#   packaging/apt.sh PACKAGE...
set -euo pipefail
missing=()
for package in "$@"; do
    dpkg -s "$package" 2>/dev/null | grep -q '^Status: install ok installed' || missing+=("$package")
done
[ ${#missing[@]} -gt 0 ] || exit 0
command -v apt-get >/dev/null || { echo "please install ${missing[*]} with your system's package manager" >&2; exit 1; }
# No questions: nobody may be there to answer them.
root=(env DEBIAN_FRONTEND=noninteractive)
if [ "$(id -u)" != 0 ]; then
    command -v sudo >/dev/null || {
        echo "no root and no sudo here; please let someone with root run: apt-get install ${missing[*]}" >&2
        exit 1
    }
    root=(sudo env DEBIAN_FRONTEND=noninteractive)
    echo "asks for root, for what no wheel serves" >&2
fi
echo "installing ${missing[*]} from the distribution" >&2
# Lists of packages may be missing or old: then once more with new ones.
"${root[@]}" apt-get install -y --no-install-recommends "${missing[@]}" >&2 ||
    { "${root[@]}" apt-get update >&2 && "${root[@]}" apt-get install -y --no-install-recommends "${missing[@]}" >&2; }
