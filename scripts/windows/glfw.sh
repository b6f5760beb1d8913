# glfw_host for Windows: GLFW and libpng, which Debian has for Linux alone, out of its sources. Sourced by run.sh.
# shellcheck shell=bash

dependencies="$work/dependencies"

# Fetches and unpacks the original sources of a package of this Debian: sources_of PACKAGE FOLDER
sources_of() {
    local found
    rm -rf "$work/sources-$1" && mkdir -p "$work/sources-$1"
    (cd "$work/sources-$1" && apt_own source -qq --download-only "$1") || return 1
    found="$(ls "$work/sources-$1"/*.orig.tar.* | grep -v '\.asc$' | head -n 1)"
    mkdir -p "$2"
    tar -xf "$found" -C "$2" --strip-components=1
}

cmake_for_windows() { # SOURCES BUILD OPTIONS..
    cmake -S "$1" -B "$2" -DCMAKE_TOOLCHAIN_FILE="$PWD/scripts/windows/mingw.cmake" -DCMAKE_BUILD_TYPE=Release \
        -DCMAKE_INSTALL_PREFIX="$dependencies" "${@:3}"
    cmake --build "$2" --parallel 2
}

# Once for a target directory.
have_dependencies() {
    [ ! -f "$dependencies/done" ] || return 0
    local line
    line="$(debian_line deb-src "$(. /etc/os-release && echo "${VERSION_CODENAME:-}")")" || return 1
    own_apt "$line" && sources_of glfw3 "$work/glfw" && sources_of libpng1.6 "$work/libpng"
}

build_glfw_host() {
    if [ ! -f "$dependencies/done" ]; then
        cmake_for_windows "$work/glfw" "$work/glfw-build" -DGLFW_BUILD_EXAMPLES=OFF -DGLFW_BUILD_TESTS=OFF -DGLFW_BUILD_DOCS=OFF
        cmake --install "$work/glfw-build"
        cmake_for_windows "$work/libpng" "$work/libpng-build" -DPNG_SHARED=OFF -DPNG_TESTS=OFF \
            -DZLIB_LIBRARY=/usr/x86_64-w64-mingw32/lib/libz.a -DZLIB_INCLUDE_DIR=/usr/x86_64-w64-mingw32/include
        cmake --install "$work/libpng-build"
        touch "$dependencies/done"
    fi
    cmake_for_windows examples/glfw_host "$work/glfw_host" -DCMAKE_PREFIX_PATH="$tree;$dependencies" \
        -DZLIB_LIBRARY=/usr/x86_64-w64-mingw32/lib/libz.a -DZLIB_INCLUDE_DIR=/usr/x86_64-w64-mingw32/include
    cp "$work/glfw_host/glfw_host.exe" "$programs/"
}

glfw_host_checks() {
    if ! have_dependencies >"$work/log/sources.txt" 2>&1; then
        skip "glfw_host builds by MinGW" "the sources of GLFW and libpng cannot be had from Debian here"
        return
    fi
    check "glfw_host builds by MinGW" build_glfw_host
}
