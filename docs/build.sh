#!/usr/bin/env bash
# Builds the book: reference pages from the code, then HTML by mdbook; a warning is an error. Links and anchors
# are checked by tests/docs, which needs no mdbook.
set -euo pipefail
cd "$(dirname "$0")/.."
# A `tread` that is already there may write the pages (TREAD=...).
if [ -x "${TREAD:-}" ]; then
    "$TREAD" reference docs/src/reference
else
    cargo run --quiet --release --bin tread -- reference docs/src/reference
fi
# From the project's environment (packaging/setup.sh test), the system, or built once.
mdbook=.venv/bin/mdbook
[ -x "$mdbook" ] || mdbook=$(command -v mdbook || echo out/tools/bin/mdbook)
if [ ! -x "$mdbook" ]; then
    echo "docs: building mdbook into out/tools, once (some minutes)" >&2
    # Unoptimised and without its server: built in a tenth of the time, and fast enough for this book.
    cargo install --quiet --debug --locked --no-default-features --features search --root out/tools mdbook@0.5.4
fi
said=$("$mdbook" build docs 2>&1) || { echo "$said" >&2; exit 1; }
echo "$said" >&2
! grep -qE '\b(WARN|ERROR)\b' <<< "$said" || { echo "docs: mdbook warned" >&2; exit 1; }
