# What the scripts share; they source it in the checkout's folder.

# Numbers have a point in every country: awk would read 1.5 as 1 where people write 1,5.
export LC_ALL=C.UTF-8
export PIP_DISABLE_PIP_VERSION_CHECK=1

# Can zig link for glibc 2.17 here? TREAD_NO_ZIG=1 asks for this machine's own linker.
zig_works() {
    mkdir -p out
    [ -z "${TREAD_NO_ZIG:-}" ] && [ "$(uname -m)" = x86_64 ] &&
        echo 'int main(void){return 0;}' | packaging/zigcc.sh -x c - -o out/.zig-probe 2>/dev/null &&
        rm -f out/.zig-probe
}

# A mark of everything that a library is built from: a library with another one is out of date.
source_mark() {
    find src build.rs Cargo.toml Cargo.lock packaging/exports.map -type f | LC_ALL=C sort | xargs cat | sha256sum | cut -c1-16
}

# Builds shared libraries for the FMU, without debug symbols; arguments go to cargo. Prints the folder
# where they are. The library loads on every distribution since 2012, or, without zig, on those with a
# glibc as new as this machine's.
build_libraries() {
    local folder=${CARGO_TARGET_DIR:-$PWD/target}/fmu
    if zig_works; then
        CARGO_PROFILE_RELEASE_DEBUG=0 CARGO_PROFILE_RELEASE_STRIP=symbols \
        CARGO_TARGET_X86_64_UNKNOWN_LINUX_GNU_LINKER=$PWD/packaging/zigcc.sh \
        CC_x86_64_unknown_linux_gnu=$PWD/packaging/zigcc.sh \
            cargo build --quiet --release --target x86_64-unknown-linux-gnu --target-dir "$folder" "$@" >&2
        echo "$folder/x86_64-unknown-linux-gnu/release"
    else
        echo "zig is not at hand (packaging/setup.sh build installs it): building for this machine's glibc" >&2
        CARGO_PROFILE_RELEASE_DEBUG=0 CARGO_PROFILE_RELEASE_STRIP=symbols \
            cargo build --quiet --release --target-dir "$folder" "$@" >&2
        echo "$folder/release"
    fi
}
