# Wine with a display, a prefix and software drivers of its own, and the same programs for Windows and for Linux.
# Sourced by the scripts of this folder.
# shellcheck shell=bash

programs="$work/programs"
pictures="$work/pictures"
linux="$target_dir/stage/dev"

# Wine's own 64-bit loader: the script beside it asks for a 32-bit Wine.
find_wine() {
    local candidate
    for candidate in /usr/lib/wine/wine64 /opt/wine-stable/bin/wine64 "$(command -v wine64 || true)" "$(command -v wine || true)"; do
        [ -x "$candidate" ] && wine="$candidate" && return
    done
    fail "Wine is not installed where it is looked for: /usr/lib/wine/wine64, wine64 or wine in PATH"
}

start_wine() {
    find_wine
    mkdir -p "$programs" "$pictures"
    # The display's number comes from the server itself, so that several may run.
    Xvfb -displayfd 9 -screen 0 1024x768x24 -nolisten tcp -noreset 9>"$work/display" 2>/dev/null &
    xvfb=$!
    trap stop_wine EXIT
    for _ in $(seq 100); do [ -s "$work/display" ] && break || sleep 0.1; done
    [ -s "$work/display" ] || fail "Xvfb does not start"
    DISPLAY=":$(cat "$work/display")"
    export DISPLAY
    export WINEPREFIX="$work/prefix" WINEDEBUG=-all LIBGL_ALWAYS_SOFTWARE=1 WELKIN_WITHOUT_VALIDATION=1
    # Neither Mono nor Gecko is asked for; and with Wine's DX12, which wgpu would prefer, no shader compiles.
    export WINEDLLOVERRIDES="mscoree=;mshtml=;d3d12="
    unset WAYLAND_DISPLAY
    local icd
    for icd in /usr/share/vulkan/icd.d/lvp_icd*.json; do export VK_ICD_FILENAMES="$icd" VK_DRIVER_FILES="$icd"; done
    timeout 120 "$wine" wineboot -i >/dev/null 2>&1 || fail "Wine cannot make its prefix in $WINEPREFIX"
    # Wine before 9 lacks a DLL of Windows that Rust's standard library imports.
    if [ ! -f "$WINEPREFIX/drive_c/windows/system32/bcryptprimitives.dll" ]; then
        x86_64-w64-mingw32-gcc -shared -O2 tests/windows/process_prng.c -o "$programs/bcryptprimitives.dll" -ladvapi32
    fi
}

stop_wine() {
    [ -z "${wine:-}" ] || "${wine%/*}/wineserver" -k 2>/dev/null || wineserver -k 2>/dev/null || true
    [ -z "${xvfb:-}" ] || kill "$xvfb" 2>/dev/null || true
}

# under_wine PROGRAM ARGUMENTS..: in the folder of the programs, so that paths are short and plain on both systems.
under_wine() { (cd "$programs" && timeout 240 "$wine" "$@"); }
on_linux() { (cd "$programs" && timeout 240 "$@"); }

# ---- building ----

strict=(-O2 -Wall -Wextra -Werror -Iinclude)

# mingw NAME SOURCE.. -- LIBRARY..: programs/NAME.exe
mingw() {
    local name="$1" compiler=x86_64-w64-mingw32-gcc-posix standard=-std=c11 runtime=()
    shift
    case " $* " in
    *.cpp\ *)
        compiler=x86_64-w64-mingw32-g++-posix standard=-std=c++11
        runtime=(-static-libstdc++ -Wl,-Bstatic,--whole-archive -lwinpthread -Wl,--no-whole-archive,-Bdynamic)
        ;;
    esac
    local sources=()
    while [ "$1" != -- ]; do sources+=("$1") && shift; done
    shift
    "$compiler" "$standard" "${strict[@]}" -DWK_SHARED -isystem "$work/include" "${sources[@]}" -o "$programs/$name.exe" \
        -static-libgcc -L"$tree/lib" -lwelkin "$@" "${runtime[@]}"
}

# gcc_linux NAME SOURCE.. -- LIBRARY..: programs/NAME
gcc_linux() {
    local name="$1" sources=()
    shift
    while [ "$1" != -- ]; do sources+=("$1") && shift; done
    shift
    gcc -std=c11 "${strict[@]}" "${sources[@]}" -o "$programs/$name" -L"$linux/lib" -lwelkin -Wl,-rpath,"$linux/lib" "$@"
}

# The Linux library of the same sources, for its pictures. They are equal in all profiles; this one is built for the tests.
build_linux() {
    ${MAKE:-make} --no-print-directory stage PROFILE=dev
}

# MinGW has an import library for all of Windows but Vulkan's loader: made from the DLL that Wine has. The headers are
# the system's.
vulkan_import() {
    local dll="$WINEPREFIX/drive_c/windows/system32/vulkan-1.dll" folder="$work/include"
    mkdir -p "$folder" "$work/lib"
    ln -sfn /usr/include/vulkan "$folder/vulkan"
    ln -sfn /usr/include/vk_video "$folder/vk_video"
    [ -f "$dll" ] || return 1
    { printf 'EXPORTS\n' && x86_64-w64-mingw32-objdump -p "$dll" | sed -n 's/.*[] ]\(vk[A-Z][A-Za-z0-9]*\)$/    \1/p' | sort -u; } \
        >"$work/vulkan-1.def"
    x86_64-w64-mingw32-dlltool -d "$work/vulkan-1.def" -D vulkan-1.dll -l "$work/lib/libvulkan-1.a"
}

build_programs() {
    set -e
    cp "$tree/bin/welkin.dll" "$programs/"
    mingw noop tests/c/noop.c --
    mingw raii tests/c/raii.cpp --
    mingw unload tests/windows/unload.c --
    mingw own tests/windows/own.c --
    mingw window tests/windows/window.c -- -lgdi32
    mingw opengl_host tests/windows/opengl_host.c tests/windows/contexts_wgl.c -- -lopengl32 -lgdi32
    mingw window_host examples/window_host/*.c -- -lgdi32
}

build_programs_linux() {
    set -e
    gcc_linux own tests/windows/own.c --
    gcc_linux opengl_host tests/windows/opengl_host.c tests/windows/contexts_glx.c -- -lGL -lX11
    gcc_linux vulkan_host examples/vulkan_host/*.c -- -lvulkan -lX11 -lm
}

build_vulkan_host() {
    set -e
    vulkan_import
    mingw vulkan_host examples/vulkan_host/*.c -- -L"$work/lib" -lvulkan-1
}

# The first program of a new user, out of the archive alone.
minimal_from_archive() {
    x86_64-w64-mingw32-gcc-posix -O2 -Wall -Wextra -Werror -DWK_SHARED -I"$tree/include" \
        "$tree/share/doc/welkin/minimal.c" -o "$programs/minimal.exe" -L"$tree/lib" -lwelkin
    gcc_linux minimal examples/minimal.c --
    on_linux ./minimal >"$programs/linux-minimal.ppm"
    under_wine minimal.exe >"$programs/windows-minimal.ppm"
    cmp "$programs/linux-minimal.ppm" "$programs/windows-minimal.ppm"
}

# A project of its own, by CMake, against the archive as it is unpacked elsewhere.
consumer_by_cmake() {
    set -e
    local there="$work/unpacked"
    rm -rf "$there" "$work/consumer"
    unzip -q "$archive" -d "$there"
    cmake -S examples/consumer -B "$work/consumer" -DCMAKE_TOOLCHAIN_FILE="$PWD/scripts/windows/mingw.cmake" \
        -DCMAKE_PREFIX_PATH="$there/$(basename "$tree")"
    cmake --build "$work/consumer"
    cp "$work/consumer/consumer.exe" "$programs/"
    under_wine consumer.exe | grep "welkin $version on "
}

# ---- running ----

says_ok() { under_wine "$@" | tr -d '\r' | tee /dev/stderr | tail -n 1 | grep -qx ok; }

loads_thrice() { under_wine unload.exe welkin.dll "$1" $(cat tests/abi/symbols.txt) | grep ' functions, three times'; }

# same PROGRAM ARGUMENTS.. FILE..: runs it on both systems and compares what it wrote. Arguments with a dot are files.
same() {
    set -e
    local program="$1" arguments=() there=() name
    shift
    for name in "$@"; do
        case "$name" in
        *.*) arguments+=("linux-$name") && there+=("windows-$name") ;;
        *) arguments+=("$name") && there+=("$name") ;;
        esac
    done
    on_linux "./$program" "${arguments[@]}"
    under_wine "$program.exe" "${there[@]}"
    for name in "$@"; do
        case "$name" in *.*) cmp "$programs/linux-$name" "$programs/windows-$name" ;; esac
    done
}
