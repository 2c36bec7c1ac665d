#!/usr/bin/env bash
# Builds the book: reference pages from the code, then HTML if mdbook is installed.
set -euo pipefail
cd "$(dirname "$0")/.."
cargo run --quiet --release --bin tread -- reference docs/src/reference
if command -v mdbook >/dev/null; then
    mdbook build docs
else
    echo "docs: the Markdown is complete in docs/src; \`cargo install mdbook\` makes HTML of it" >&2
fi
