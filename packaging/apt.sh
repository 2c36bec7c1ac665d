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
root=()
[ "$(id -u)" = 0 ] || root=(sudo)
echo "installing ${missing[*]} from the distribution${root:+ (asks for root)}" >&2
"${root[@]}" apt-get install -y --no-install-recommends "${missing[@]}" >&2 ||
    { "${root[@]}" apt-get update >&2 && "${root[@]}" apt-get install -y --no-install-recommends "${missing[@]}" >&2; }
