#!/usr/bin/env bash
# Installs what the project needs; quick when there is nothing to do.
#
#   packaging/setup.sh [build] [run] [test] [docs] [bench] [browser]      (default: build run)
#
#   build  C compiler, libclang, zig: to build the FMU
#   run    fmpy, numpy, matplotlib: the demo and the studies
#   test   pytest and the importers that judge the FMU, valgrind, CalculiX to compare with
#   docs   mdbook (a part of test, too)
#   bench  SUNDIALS, which the benches compare with
#   browser  Debian's chromium, which looks at reports
#
# Python packages go into .venv of this checkout. The distribution is asked (apt-get, as root or with
# sudo) only for what no wheel serves: C compiler, Python's venv module, valgrind, CalculiX.
set -euo pipefail
cd "$(dirname "$0")/.."
wanted=("$@")
[ ${#wanted[@]} -gt 0 ] || wanted=(build run)

say() { echo "setup: $*" >&2; }
fail() { say "$*"; exit 1; }

# Installs Debian packages, asking for root only now; elsewhere says what is missing.
apt() { packaging/apt.sh "$@" || fail "needs $*"; }

command -v cargo >/dev/null || fail "Rust is missing: install rustup with its stable toolchain"
command -v cc >/dev/null || apt gcc libc6-dev

python() {
    local candidate
    for candidate in python3 python3.14 python3.13 python3.12 python3.11; do
        if "$candidate" -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null; then
            echo "$candidate"
            return
        fi
    done
    fail "Python 3.11 or newer is missing: install it with its venv module, as python3 or python3.11 to python3.14"
}

# Also where an earlier try was broken off before pip was there.
if ! .venv/bin/python -c 'import pip' 2>/dev/null; then
    base=$(python)
    "$base" -c 'import venv, ensurepip' 2>/dev/null || apt "$base-venv"
    say "making .venv"
    "$base" -m venv .venv
fi

# Installs a requirements file once; the stamp is its content.
pip_install() {
    local file=$1 stamp=".venv/stamp-$(basename "$1")"
    cmp -s "$file" "$stamp" && return
    say "installing $(grep -vE '^ *(#|$)' "$file" | tr '\n' ' ')into .venv"
    PIP_DISABLE_PIP_VERSION_CHECK=1 .venv/bin/python -m pip install --quiet -r "$file" >&2
    cp "$file" "$stamp"
}

# One that can be used as it is: library and clang's own headers, which other packages bring apart.
has_libclang() {
    [ -n "${LIBCLANG_PATH:-}" ] && return
    # Not libclang-cpp, which is another library: compilers bring it alone.
    compgen -G '/usr/lib*/llvm-*/lib/libclang.so*' >/dev/null || compgen -G '/usr/lib*/llvm-*/lib/libclang-[0-9]*.so*' >/dev/null ||
        compgen -G '/usr/lib*/libclang.so*' >/dev/null || return
    compgen -G '/usr/lib*/llvm-*/lib/clang/*/include/stddef.h' >/dev/null || compgen -G '/usr/lib*/clang/*/include/stddef.h' >/dev/null
}

# Where there is none, a wheel's, told to cargo alone: plain `cargo test` and editors find it, too.
libclang() {
    local config=.cargo/config.toml
    { has_libclang || grep -qs LIBCLANG_PATH "$config"; } && return
    say "installing libclang into .venv"
    .venv/bin/python -m pip install --quiet libclang >&2
    local folder
    folder=$(.venv/bin/python -c 'import clang, os; print(os.path.relpath(os.path.join(list(clang.__path__)[0], "native")))')
    mkdir -p .cargo
    {
        echo '[env]'
        # Relative to the checkout, which may be moved.
        echo "LIBCLANG_PATH = { value = \"$folder\", relative = true }"
        # The wheel brings no headers of the compiler; gcc's serve.
        echo "BINDGEN_EXTRA_CLANG_ARGS = \"-I$(cc -print-file-name=include)\""
    } >> "$config"
}

# cofmupy pins old versions of what the others want new: an environment inside the environment.
cofmupy() {
    [ -f .venv/cofmupy/done ] && return
    say "installing cofmupy into .venv/cofmupy"
    .venv/bin/python -m venv .venv/cofmupy &&
        .venv/cofmupy/bin/python -m pip install --quiet cofmupy==1.0.0 >&2 && touch .venv/cofmupy/done
}

for part in "${wanted[@]}"; do
    case $part in
        build)
            libclang
            pip_install packaging/requirements-build.txt ||
                say "zig cannot be had: the FMU will need this machine's glibc"
            ;;
        run) pip_install packaging/requirements.txt ;;
        test)
            pip_install packaging/requirements-test.txt
            pip_install packaging/requirements-docs.txt
            cofmupy || { say "cofmupy cannot be had: its test will be skipped"; rm -rf .venv/cofmupy; }
            command -v objdump >/dev/null || apt binutils
            # Without root the other tests are worth running, too. valgrind wants the symbols of a C library that
            # some distributions strip.
            command -v valgrind >/dev/null || packaging/apt.sh valgrind libc6-dbg ||
                say "valgrind cannot be had: its tests will be skipped"
            command -v ccx >/dev/null || packaging/apt.sh calculix-ccx ||
                say "CalculiX cannot be had: make test will count that as a failure"
            ;;
        docs) pip_install packaging/requirements-docs.txt ;;
        browser) command -v chromium >/dev/null || apt chromium ;;
        bench) [ -e /usr/include/cvode/cvode.h ] || apt libsundials-dev ;;
        *) fail "unknown part $part: build, run, test, docs, bench, browser" ;;
    esac
done
