#!/usr/bin/env bash
# A page as Debian's chromium shows it, without a network.
#
#   docs/shot.sh PAGE.html PICTURE.png WIDTH HEIGHT [dark]
set -euo pipefail
page=$(realpath "$1") picture=$(realpath "$2")
profile=$(mktemp -d)
trap 'rm -rf "$profile"' EXIT
options=(--headless=new --disable-gpu --hide-scrollbars --no-first-run --user-data-dir="$profile"
    --disable-background-networking --disable-component-update --disable-sync
    --window-size="$3,$4" --screenshot="$picture")
# Root has no sandbox; the page is one of our own.
[ "$(id -u)" != 0 ] || options+=(--no-sandbox)
[ "${5:-}" != dark ] || options+=(--blink-settings=preferredColorScheme=0)
# Characters that a file's address may not hold, such as blanks.
address=$(python3 -c 'import pathlib, sys; print(pathlib.Path(sys.argv[1]).as_uri())' "$page")
chromium "${options[@]}" "$address" 2>/dev/null
