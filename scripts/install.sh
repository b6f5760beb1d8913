#!/usr/bin/env bash
# Lays the built library out below a prefix: libraries, headers, and what pkg-config and CMake need to find them.
#
#   scripts/install.sh BUILD_DIR DESTDIR PREFIX VERSION ABI_MAJOR      (called by `make install`)
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/command_line.sh"
answer_command_line "$@"
case "${1:-}" in -*) refuse "$1" ;; esac
[ $# -eq 5 ] || { echo "install.sh: five arguments are wanted, got $#; install.sh --help lists them" >&2; exit 2; }
cd "$(dirname "${BASH_SOURCE[0]}")/.."

build="$1" destdir="$2" prefix="$3" version="$4" abi="$5"
root="$destdir$prefix"
case "$prefix" in
/*) ;;
*) echo "install: PREFIX must be an absolute path, got $prefix" >&2 && exit 1 ;;
esac

if [ "$(uname -s)" = Darwin ]; then
    shared=libwelkin.dylib shared_abi="libwelkin.$abi.dylib" shared_full="libwelkin.$version.dylib"
else
    shared=libwelkin.so shared_abi="libwelkin.so.$abi" shared_full="libwelkin.so.$version"
fi
# Without the C library itself, which every compiler driver adds.
private_libs="$(tr -s ' \n' '  ' <"$build/native-static-libs.txt" | sed 's/ *-lc *$//; s/ *$//')"

fill() {
    sed -e "s|@PREFIX@|$prefix|g" -e "s|@VERSION@|$version|g" -e "s|@PRIVATE_LIBS@|$private_libs|g" \
        -e "s|@SHARED_ABI@|$shared_abi|g" -e "s|@SHARED_FULL@|$shared_full|g" "$1" >"$2"
    chmod 644 "$2"
}

# What has not changed keeps its time (-C), so that hosts are not built again for nothing.
install -d "$root/include" "$root/lib/pkgconfig" "$root/lib/cmake/welkin"
install -C -m 755 "$build/$shared" "$root/lib/$shared_full"
ln -sf "$shared_full" "$root/lib/$shared_abi"
ln -sf "$shared_abi" "$root/lib/$shared"
install -C -m 644 "$build/libwelkin.a" "$root/lib/libwelkin.a"
for header in include/*; do
    install -C -m 644 "$header" "$root/include/"
done
fill packaging/welkin.pc.in "$root/lib/pkgconfig/welkin.pc"
fill packaging/welkinConfig.cmake.in "$root/lib/cmake/welkin/welkinConfig.cmake"
fill packaging/welkinConfigVersion.cmake.in "$root/lib/cmake/welkin/welkinConfigVersion.cmake"
echo "installed welkin $version below $root"
