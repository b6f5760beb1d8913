# Brings what the build for Windows needs and this machine lacks: MinGW, LLVM's dlltool, Wine, and Rust's standard
# library for Windows. Sourced by the scripts of this folder.
# shellcheck shell=bash

packages=(
    gcc-mingw-w64-x86-64-posix g++-mingw-w64-x86-64-posix mingw-w64-tools libz-mingw-w64-dev # compilers, import libraries
    llvm zip unzip cmake pkg-config                                                           # MSVC's import library, archive
    wine wine64 xvfb mesa-vulkan-drivers libgl1-mesa-dri libvulkan1                           # checks
    gcc g++ libc6-dev libgl-dev libx11-dev libvulkan-dev                                      # the same programs on Linux
)

install_packages() {
    command -v dpkg-query >/dev/null ||
        fail "this needs Debian or Ubuntu, or by hand: MinGW (posix threads), llvm-dlltool, CMake, Wine and Xvfb"
    scripts/setup.sh packages "${packages[@]}"
}

# Sets `std` to the options of cargo with which the standard library is there. In this order: rustup's target; the
# sources of the very compiler's version out of Debian, unpacked and not installed; a sentence, and the end.
find_std() {
    std=()
    has_target && return
    if command -v rustup >/dev/null && rustup target add "$TARGET" >/dev/null 2>&1 && has_target; then
        return
    fi
    rust_version="$(rustc --version | sed -n 's/^rustc \([0-9.]*\).*/\1/p')"
    find_sources || fail "no Rust standard library for $TARGET: rustup cannot add it to this compiler, and Debian has no" \
        "rust-src of version $rust_version; install rustup and run: rustup target add $TARGET"
    # Unstable in cargo, and so asked of a stable one by name.
    export RUSTC_BOOTSTRAP=1 __CARGO_TESTS_ONLY_SRC_ROOT="$sources"
    std=(-Zbuild-std=std,panic_unwind)
}

has_target() {
    [ "${WELKIN_STD_SOURCES:-}" != 1 ] && [ -d "$(rustc --print sysroot)/lib/rustlib/$TARGET/lib" ]
}

find_sources() {
    sources="$work/rust-src-$rust_version/usr/src/rustc-$rust_version/library"
    [ ! -d "$sources" ] || return 0
    echo "windows: fetching the sources of Rust's standard library $rust_version"
    local lines=() suite found
    for suite in trixie-backports sid; do
        lines+=("$(debian_line deb "$suite")") || return 1
    done
    own_apt "${lines[@]}" || return 1
    # A version is `1.95.0+dfsg1-2`; the newest packaging of the compiler's own version.
    found="$(apt-cache -o Dir::Etc::sourcelist="$apt_state/sources.list" -o Dir::Etc::sourceparts=- \
        -o Dir::State::lists="$apt_state/lists" -o Dir::Cache="$apt_state/cache" madison rust-src |
        sed -n "s/^ *rust-src | *\(${rust_version//./\\.}+[^ ]*\) .*/\1/p" | sort -V | tail -n 1)"
    [ -n "$found" ] || return 1
    (cd "$apt_state" && apt_own download -qq "rust-src=$found") || return 1
    rm -rf "$work/rust-src-$rust_version"
    dpkg -x "$apt_state"/rust-src_*.deb "$work/rust-src-$rust_version"
    rm -f "$apt_state"/rust-src_*.deb
    [ -d "$sources" ]
}
