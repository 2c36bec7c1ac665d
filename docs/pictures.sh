#!/usr/bin/env bash
# The pictures of README and introduction, into docs/src/images: the limit cycle from the demo, the gap
# report from a labelled campaign as Debian's chromium shows it.
set -euo pipefail
cd "$(dirname "$0")/.."
images=docs/src/images
[ -e out/TreadBlock.fmu ] || packaging/linux64.sh
.venv/bin/python demo/demo.py
cp out/demo/sliding-limit-cycle.png "$images/"

campaign=${1:-tests/data/campaigns/open/open-05.zip}
report=out/pictures/$(basename "$campaign" .zip)
# Exit codes of 10 and more are answers, too.
cargo run --quiet --release --bin tread -- gap diagnose "$campaign" --out "$report" || [ $? -ge 10 ]
packaging/setup.sh browser
# Never as root without its sandbox but here, on a page of our own.
chromium --headless=new $([ "$(id -u)" = 0 ] && echo --no-sandbox) --disable-gpu --hide-scrollbars \
    --window-size=1000,640 --screenshot="$images/gap-report.png" "file://$PWD/$report/report.html"
echo "$images/sliding-limit-cycle.png $images/gap-report.png"
