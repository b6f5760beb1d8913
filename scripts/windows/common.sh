# Shared by the scripts of this folder, which run from the repository's root: names, folders, checks that count
# themselves.
# shellcheck shell=bash

readonly TARGET=x86_64-pc-windows-gnu
target_dir="${CARGO_TARGET_DIR:-target}"
mkdir -p "$target_dir/windows"
target_dir="$(cd "$target_dir" && pwd)"
work="$target_dir/windows"
version="$(sed -n '/^\[workspace\.package\]/,/^\[/s/^version = "\(.*\)"/\1/p' Cargo.toml)"
# The tree as the archive holds it, and the archive.
tree="$work/welkin-$version-windows-x86_64"
archive="$tree.zip"

# The toolchain's linker, and no path of this machine in the messages of the library.
export CARGO_TARGET_X86_64_PC_WINDOWS_GNU_LINKER=x86_64-w64-mingw32-gcc
export CARGO_TARGET_X86_64_PC_WINDOWS_GNU_RUSTFLAGS="--remap-path-prefix=${CARGO_HOME:-$HOME/.cargo}/registry/src=registry"

fail() {
    echo "windows: $*" >&2
    exit 1
}

# ---- checks that count themselves ----

passed=0 failed=0 skipped=0

# check NAME COMMAND..: runs it, with what it says in a file, which is shown where it fails.
check() {
    local name="$1" log="$work/log/${1//[^A-Za-z0-9]/-}.txt" begun=$SECONDS
    shift
    mkdir -p "$work/log"
    # In no condition, where bash would go on after a command that fails.
    set +e
    (
        set -e
        "$@"
    ) >"$log" 2>&1
    local status=$?
    set -e
    if [ "$status" = 0 ]; then
        passed=$((passed + 1))
        echo "  passed: $name ($((SECONDS - begun)) s)"
    else
        failed=$((failed + 1))
        echo "  FAILED: $name ($((SECONDS - begun)) s)"
        tail -n 40 "$log" | sed 's/^/    | /'
    fi
}

# skip NAME REASON
skip() {
    skipped=$((skipped + 1))
    echo "  skipped: $1: $2"
}

# The last line. Fails where a check has failed.
summary() {
    local rest=
    [ "$skipped" = 0 ] || rest=", $skipped skipped"
    echo "$1: $passed passed, $failed failed$rest"
    [ "$failed" = 0 ]
}

# ---- an apt state of our own: other releases' packages, of which nothing is installed ----

# own_apt LINES: writes the list of sources and reads its indices; the machine's own lists stay as they are.
own_apt() {
    apt_state="$work/apt"
    mkdir -p "$apt_state/lists/partial" "$apt_state/cache/archives/partial"
    printf '%s\n' "$@" >"$apt_state/sources.list"
    apt_own update -qq
}

apt_own() {
    apt-get -o Dir::Etc::sourcelist="$apt_state/sources.list" -o Dir::Etc::sourceparts=- \
        -o Dir::State::lists="$apt_state/lists" -o Dir::Cache="$apt_state/cache" -o APT::Sandbox::User=root "$@"
}

# Where this machine gets Debian from; nothing where it is no Debian.
debian_mirror() {
    apt-get indextargets --format '$(REPO_URI)' 'Origin: Debian' 'Label: Debian' 2>/dev/null | sort -u | head -n 1
}

debian_line() { # deb|deb-src SUITE
    local mirror
    mirror="$(debian_mirror)"
    [ -n "$mirror" ] || return 1
    echo "$1 [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] $mirror $2 main"
}
