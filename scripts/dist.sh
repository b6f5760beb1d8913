#!/usr/bin/env bash
# Makes the archives of a release from a built library: a tar of libraries, headers, CMake and pkg-config files, documents and examples, a
# Debian package, and their SHA-256 sums. What `make windows` has packed is taken along if it is there.
#
#   scripts/dist.sh BUILD_DIR OUT_DIR VERSION ABI_MAJOR      (called by `make dist`)
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/command_line.sh"
answer_command_line "$@"
case "${1:-}" in -*) refuse "$1" ;; esac
[ $# -eq 4 ] || { echo "dist.sh: four arguments are wanted, got $#; dist.sh --help lists them" >&2; exit 2; }
build="$(realpath "$1")" out="$(realpath -m "$2")" version="$3" abi="$4"
cd "$(dirname "${BASH_SOURCE[0]}")/.."

machine="$(uname -m)"
name="welkin-$version-$(uname -s | tr '[:upper:]' '[:lower:]')-$machine"
# Archives of one commit are equal to the byte: times are the commit's, owners nobody's.
export SOURCE_DATE_EPOCH="${SOURCE_DATE_EPOCH:-$(git log -1 --format=%ct 2>/dev/null || echo 0)}"
mkdir -p "$out"
work="$(mktemp -d "$out/.work.XXXXXX")"
trap 'rm -rf "$work"' EXIT

# The documents without the lab's tables, and the examples without the lab itself.
documents() {
    mkdir -p "$1/docs/lab" "$1/examples"
    cp docs/*.md "$1/docs/" && cp docs/lab/*.md "$1/docs/lab/"
    cp -r docs/gallery "$1/docs/gallery"
    cp -r examples/{minimal.c,command_line.h,consumer,glfw_host,vulkan_host,window_host,osg_host,data} "$1/examples/"
    cp README.md CHANGELOG.md CONTRIBUTING.md SECURITY.md ARCHITECTURE.md LICENSE-MIT LICENSE-APACHE "$1/"
}

echo "dist: $name.tar.gz" >&2
scripts/install.sh "$build" "" "$work/$name" "$version" "$abi" >/dev/null
strip --strip-debug "$work/$name/lib/libwelkin.a" "$work/$name"/lib/libwelkin.so.*.*.*
documents "$work/$name"
tar --sort=name --owner=0 --group=0 --numeric-owner --mtime="@$SOURCE_DATE_EPOCH" -C "$work" -cf - "$name" |
    gzip -9n >"$work/$name.tar.gz"

made=("$name.tar.gz")
if command -v dpkg-deb >/dev/null; then
    architecture="$(dpkg --print-architecture)"
    package="libwelkin-dev_${version}_$architecture.deb"
    echo "dist: $package" >&2
    root="$work/deb"
    mkdir -p "$root/DEBIAN" "$root/usr/share/doc/libwelkin-dev" "$work/debian"
    cp -a "$work/$name"/{lib,include} "$work/" && mkdir -p "$root/usr" && mv "$work/lib" "$work/include" "$root/usr/"
    cat LICENSE-MIT LICENSE-APACHE >"$root/usr/share/doc/libwelkin-dev/copyright"
    gzip -9nc CHANGELOG.md >"$root/usr/share/doc/libwelkin-dev/changelog.gz"
    cp examples/minimal.c "$root/usr/share/doc/libwelkin-dev/"
    # dpkg-shlibdeps reads which packages have the libraries that this one is linked against.
    printf 'Source: welkin\n\nPackage: libwelkin-dev\nArchitecture: any\n' >"$work/debian/control"
    depends="$(cd "$work" && dpkg-shlibdeps -O --ignore-missing-info "deb/usr/lib/libwelkin.so.$version" 2>/dev/null |
        sed -n 's/^shlibs:Depends=//p')" || depends=""
    cat >"$root/DEBIAN/control" <<CONTROL
Package: libwelkin-dev
Version: $version
Architecture: $architecture
Section: libdevel
Priority: optional
Maintainer: The Welkin authors <welkin@localhost>
Installed-Size: $(du -sk "$root/usr" | cut -f1)
Depends: ${depends:-libc6}
Recommends: mesa-vulkan-drivers | vulkan-icd
Description: weather for simulators behind one C header
 Sky, clouds, fog, rain, snow, lightning and wet ground, drawn into a host's
 own picture by OpenGL or Vulkan. Shared and static library, headers, CMake
 and pkg-config files.
CONTROL
    echo 'activate-noawait ldconfig' >"$root/DEBIAN/triggers"
    find "$root" -type d -exec chmod 755 {} +
    dpkg-deb --root-owner-group --build "$root" "$work/$package" >/dev/null
    made+=("$package")
else
    echo "dist: no Debian package: dpkg-deb is not here" >&2
fi

for archive in "$out"/../windows/welkin-"$version"-windows-*.zip; do
    [ -e "$archive" ] || continue
    cp "$archive" "$work/" && made+=("$(basename "$archive")")
done
(cd "$work" && sha256sum "${made[@]}" >SHA256SUMS)
# Complete archives only ever stand in the folder.
for file in "${made[@]}" SHA256SUMS; do mv -f "$work/$file" "$out/$file"; done
printf '%s\n' "${made[@]/#/$out/}" "$out/SHA256SUMS"
