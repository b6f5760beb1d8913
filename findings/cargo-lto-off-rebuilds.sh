#!/usr/bin/env bash
# Cargo 1.95.0: a package that a build script needs, and `lto = "off"` in the profile.
#
# Expected: `lto = "off"` only adds an option for the compiler. What a build script was compiled with is used again when
#           another member of the workspace needs the same package with the same features and profile, as it is by
#           default (lto = false) where there are no tables for a debugger.
# Seen: by default the package and the build script are compiled once. With "off" (and with "thin") the whole workspace
#       compiles both again, and so all that depends on the build script: Cargo takes a package that only a build
#       script needs for one kind of code, and one that a library needs too for another.
# Fails where that changes.
set -euo pipefail
dir="$(mktemp -d)"
trap 'rm -rf "$dir"' EXIT
if ! cargo --version | grep -q '^cargo 1\.95\.0 '; then
    export RUSTUP_HOME="$dir/rustup"
    rustup toolchain install 1.95.0 --profile minimal --no-self-update >"$dir/log" 2>&1 || { cat "$dir/log" >&2; exit 1; }
    export RUSTUP_TOOLCHAIN=1.95.0
fi
cd "$dir"
mkdir -p generated/src reader/src
printf '[workspace]\nmembers = ["generated", "reader"]\nresolver = "2"\n' >Cargo.toml
member() { # NAME KIND-OF-DEPENDENCY
    printf '[package]\nname = "%s"\nversion = "0.0.0"\nedition = "2021"\n\n[%s]\nmemchr = "=2.8.3"\n' "$1" "$2" >"$1/Cargo.toml"
}
member generated build-dependencies
member reader dependencies
echo 'fn main() { println!("cargo:rustc-env=PLACE={:?}", memchr::memchr(b'\''b'\'', b"ab")); }' >generated/build.rs
echo 'pub const PLACE: &str = env!("PLACE");' >generated/src/lib.rs
echo 'pub fn place(of: u8, bytes: &[u8]) -> Option<usize> { memchr::memchr(of, bytes) }' >reader/src/lib.rs

unset CARGO_TARGET_DIR RUSTFLAGS CARGO_BUILD_RUSTFLAGS
export CARGO_PROFILE_DEV_DEBUG=0
for lto in false off; do
    export CARGO_PROFILE_DEV_LTO="$lto" CARGO_TARGET_DIR="$dir/target-$lto"
    cargo build --package generated 2>>"$dir/log"
    cargo build --workspace 2>&1 | tee -a "$dir/log" | sed -n "s/^ *Compiling \([a-z]*\) .*/$lto: \1 is compiled for the workspace/p" | sort
done >"$dir/said"
diff - "$dir/said" <<'SEEN' || { cat "$dir/log" >&2; echo "cargo-lto-off-rebuilds: no longer so" >&2; exit 1; }
false: reader is compiled for the workspace
off: generated is compiled for the workspace
off: memchr is compiled for the workspace
off: reader is compiled for the workspace
SEEN
echo "cargo-lto-off-rebuilds: as seen"
