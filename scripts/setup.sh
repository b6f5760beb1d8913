#!/usr/bin/env bash
# Installs what building, testing and the demo need and this machine lacks. Quick when nothing is missing; where it
# cannot install, it prints one line that names what is missing and the command for it, and fails.
#
#   scripts/setup.sh          everything that `make test` and `make demo` use
#   scripts/setup.sh build    only what the library itself needs (a Rust toolchain and a linker)
#   scripts/setup.sh packages NAME..   these packages of Debian or Ubuntu
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/command_line.sh"
answer_command_line "$@"

readonly MIN_RUST=1.90

# Debian and Ubuntu package names, by what needs them.
build_packages=(gcc libc6-dev make)
all_packages=(
    "${build_packages[@]}"
    g++ pkg-config cmake binutils                     # C and C++ examples, consumers of the installed tree
    libgl-dev libegl-dev libpng-dev                   # C OpenGL host: its world, its pictures
    libglfw3-dev libx11-dev libxrandr-dev             # its window, and a window by native handle
    libopenscenegraph-dev                             # C++ OpenSceneGraph host
    libvulkan-dev                                     # C Vulkan host
    qt6-base-dev libqt6opengl6-dev                    # C++ Qt host; half a minute to install
    libgl1-mesa-dri libegl1 libgl1 libvulkan1         # drivers, software ones included
    mesa-vulkan-drivers vulkan-validationlayers
    xvfb xauth valgrind                               # tests: a display without a screen, memory checks
    glslang-tools spirv-tools                         # what strict drivers say of the shaders
)

fail() {
    echo "setup: $*" >&2
    exit 1
}

# Runs a command as root, or fails without asking for a password that nobody is there to type.
as_root() {
    if [ "$(id -u)" = 0 ]; then
        "$@"
    elif command -v sudo >/dev/null && { [ -t 0 ] || sudo -n true 2>/dev/null; }; then
        sudo "$@"
    else
        return 1
    fi
}

missing_packages() {
    local package
    for package in "$@"; do
        case " $(dpkg-query -W -f='${db:Status-Status} ' "$package" 2>/dev/null)" in
        *" installed "*) ;; # and not "not-installed"
        *) echo "$package" ;;
        esac
    done
}

install_packages() {
    local missing
    mapfile -t missing < <(missing_packages "$@")
    [ "${#missing[@]}" -gt 0 ] || return 0
    echo "setup: installing ${missing[*]}"
    local by_hand="run as root: apt-get update && apt-get install -y ${missing[*]}"
    # The list of packages is often absent on a fresh machine, and sometimes old.
    as_root env DEBIAN_FRONTEND=noninteractive apt-get update -qq >/dev/null ||
        echo "setup: apt-get update failed; trying with the lists that are here" >&2
    as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" \
        >/dev/null || fail "missing packages that could not be installed: ${missing[*]}; $by_hand"
}

# On other systems: say which commands and libraries are missing, by name.
check_without_apt() {
    local need=(cc make) lacking=() name
    [ "$1" = build ] || need+=(c++ pkg-config cmake)
    for name in "${need[@]}"; do
        command -v "$name" >/dev/null || lacking+=("$name")
    done
    if [ "$1" != build ] && command -v pkg-config >/dev/null; then
        for name in libpng glfw3 egl gl; do
            pkg-config --exists "$name" || lacking+=("$name (development files)")
        done
    fi
    [ "${#lacking[@]}" = 0 ] ||
        fail "no apt-get here; install with this system's package manager: $(printf '%s, ' "${lacking[@]}" | sed 's/, $//')"
}

rust_version() {
    { rustc --version 2>/dev/null || true; } | sed -n 's/^rustc \([0-9]*\.[0-9]*\).*/\1/p'
}

new_enough() {
    [ -n "$1" ] && [ "$(printf '%s\n%s\n' "$MIN_RUST" "$1" | sort -V | head -1)" = "$MIN_RUST" ]
}

check_rust() {
    export PATH="$PATH:$HOME/.cargo/bin"
    local have
    have="$(rust_version)"
    new_enough "$have" && command -v cargo >/dev/null && return 0
    # Newer Debian and Ubuntu carry rustup; older ones carry a Rust that is too old.
    if ! command -v rustup >/dev/null && command -v apt-cache >/dev/null &&
        apt-cache policy rustup | grep -q 'Candidate: [0-9]'; then
        as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq rustup >/dev/null || true
    fi
    if command -v rustup >/dev/null; then
        rustup default stable >/dev/null 2>&1 || true
        have="$(rust_version)"
        new_enough "$have" && return 0
    fi
    fail "Rust $MIN_RUST or newer is needed, found ${have:-none}; install rustup and run: rustup default stable"
}

what="${1:-all}"
case "$what" in
packages)
    install_packages "${@:2}"
    exit 0
    ;;
all | build) ;;
*) refuse "$what" ;;
esac
[ $# -le 1 ] || refuse "$2"
if command -v apt-get >/dev/null && command -v dpkg-query >/dev/null; then
    if [ "$what" = build ]; then
        # Any C compiler will do for linking; do not replace a clang-only machine's choice.
        command -v cc >/dev/null || install_packages "${build_packages[@]}"
    else
        install_packages "${all_packages[@]}"
    fi
else
    check_without_apt "$what"
fi
check_rust
