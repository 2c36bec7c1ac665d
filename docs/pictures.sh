#!/usr/bin/env bash
# Every picture of README and book, into docs/src/images, by the command that makes it.
#
#   docs/pictures.sh [PART...]          (default: demo gap, which the README shows)
#
#   demo          limit cycle and rolling shapes (make demo)
#   gap           report on a labelled campaign, as Debian's chromium shows it (two minutes)
#   convergence   error over internal step and mesh (make convergence)
#   chain         passage, errors, spectra and the patch of 20 blocks (make chain)
#   bench         work-precision, roofline, cost over nodes (make bench; leave the machine alone meanwhile)
set -euo pipefail
cd "$(dirname "$0")/.."
images=docs/src/images

# Copies pictures from a folder and says so.
take() {
    local folder=$1 name
    shift
    for name in "$@"; do
        cp "$folder/$name" "$images/"
        echo "$images/$name"
    done
}

gap_report() {
    local campaign=tests/data/campaigns/open/open-05.zip report=out/pictures/open-05
    packaging/setup.sh browser
    # Exit codes of 10 and more are answers, too.
    cargo run --quiet --release --bin tread -- gap diagnose "$campaign" --out "$report" || [ $? -ge 10 ]
    docs/shot.sh "$report/report.html" "$images/gap-report.png" 1000 640
    echo "$images/gap-report.png"
}

parts=("$@")
[ ${#parts[@]} -gt 0 ] || parts=(demo gap)
for part in "${parts[@]}"; do
    case $part in
        demo)
            make --no-print-directory demo
            take out/demo sliding-limit-cycle.png rolling-shapes.png
            ;;
        gap) gap_report ;;
        convergence)
            make --no-print-directory convergence
            take out/convergence convergence.svg
            ;;
        chain)
            make --no-print-directory chain
            take out/chain chain-passage.png chain-error.png chain-spectrum.png patch-forces.png patch-spectrum.png
            ;;
        bench)
            make --no-print-directory bench
            take out/bench work-precision.svg roofline.svg nodes.svg
            ;;
        *) echo "unknown part $part: demo, gap, convergence, chain, bench" >&2; exit 2 ;;
    esac
done
