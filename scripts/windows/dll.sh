# Builds welkin.dll and lays out what a Windows project needs: DLL, import libraries, headers, CMake package, an archive
# of them. Sourced by the scripts of this folder.
# shellcheck shell=bash

build_dll() {
    local profile="${PROFILE:-release}"
    cargo rustc --locked --profile "$profile" --package welkin-c --crate-type cdylib --target "$TARGET" "${std[@]}" -- -C strip=symbols
    built="$target_dir/$TARGET/${profile/dev/debug}"
}

# MSVC's linker wants an import library of its own kind: LLVM's dlltool writes the one that lib.exe would.
lay_out() {
    rm -rf "$tree" "$archive"
    install -d "$tree/bin" "$tree/include" "$tree/lib/cmake/welkin" "$tree/share/doc/welkin"
    install -m 644 "$built/welkin.dll" "$tree/bin/"
    install -m 644 "$built/libwelkin.dll.a" "$tree/lib/"
    { printf 'EXPORTS\n' && sed 's/^/    /' tests/abi/symbols.txt; } >"$work/welkin.def"
    llvm-dlltool -m i386:x86-64 -d "$work/welkin.def" -D welkin.dll -l "$tree/lib/welkin.lib"
    install -m 644 include/* "$tree/include/"
    sed "s/@VERSION@/$version/g" packaging/welkinConfig.windows.cmake.in >"$tree/lib/cmake/welkin/welkinConfig.cmake"
    sed "s/@VERSION@/$version/g" packaging/welkinConfigVersion.cmake.in >"$tree/lib/cmake/welkin/welkinConfigVersion.cmake"
    install -m 644 LICENSE-MIT LICENSE-APACHE examples/minimal.c "$tree/share/doc/welkin/"
    [ ! -f docs/hosts-windows.md ] || install -m 644 docs/hosts-windows.md "$tree/share/doc/welkin/"
    (cd "$work" && zip -qrX9 "$archive" "$(basename "$tree")")
}

# ---- checks ----

# A checkout of Windows, where git turns line ends over unless it is told otherwise, has the bytes of every other.
checkout_keeps_line_ends() {
    local setting
    for setting in true false; do
        rm -rf "$work/checkout-$setting"
        git -c core.autocrlf=$setting checkout-index -a --prefix="$work/checkout-$setting/"
    done
    diff -rq "$work/checkout-true" "$work/checkout-false" >"$work/differing.txt" || { head -n 5 "$work/differing.txt" && return 1; }
    rm -rf "$work/checkout-true" "$work/checkout-false"
}

imported() { x86_64-w64-mingw32-objdump -p "$1" | sed -n 's/^\tDLL Name: //p' | tr '[:upper:]' '[:lower:]' | sort -u; }

only_dlls_of_windows() {
    local others
    others="$(imported "$tree/bin/welkin.dll" | comm -23 - <(sort scripts/windows/dlls.txt))"
    [ -z "$others" ] || { echo "no part of Windows, or not on the list: $others" && return 1; }
    [ "$(imported "$tree/bin/welkin.dll" | wc -l)" -gt 5 ] # or objdump has not read it
}

exports_are_the_abi() {
    x86_64-w64-mingw32-objdump -p "$tree/bin/welkin.dll" | sed -n '/^\[Ordinal\/Name Pointer\] Table/,/^$/s/.*\] *//p' |
        sed -n 's/^[^a-z]*\(wk_[a-z0-9_]*\)$/\1/p; t; /^[A-Za-z_]/p' | grep -v Table | sort >"$work/exports.txt"
    diff tests/abi/symbols.txt "$work/exports.txt"
}

# Both import libraries name each function of the ABI and the DLL.
import_libraries_are_whole() {
    local library
    for library in libwelkin.dll.a welkin.lib; do
        llvm-nm --quiet "$tree/lib/$library" 2>/dev/null | sed -n 's/.* T \(wk_[a-z0-9_]*\)$/\1/p' | sort -u >"$work/imports.txt"
        diff tests/abi/symbols.txt "$work/imports.txt" || return 1
        grep -q 'welkin\.dll' "$tree/lib/$library" || return 1
    done
}

dll_is_stripped() {
    if x86_64-w64-mingw32-objdump -t "$tree/bin/welkin.dll" | grep '(sec'; then return 1; fi
    # No path of the machine that built it, in no message.
    if grep -q -a -F "${CARGO_HOME:-$HOME/.cargo}/registry" "$tree/bin/welkin.dll"; then return 1; fi
}

archive_has_all() {
    local name
    name="$(basename "$tree")"
    unzip -Z1 "$archive" | sort >"$work/listed.txt"
    for file in bin/welkin.dll lib/welkin.lib lib/libwelkin.dll.a include/welkin.h include/welkin.hpp \
        lib/cmake/welkin/welkinConfig.cmake lib/cmake/welkin/welkinConfigVersion.cmake \
        share/doc/welkin/LICENSE-MIT share/doc/welkin/LICENSE-APACHE share/doc/welkin/minimal.c; do
        grep -qx "$name/$file" "$work/listed.txt" || { echo "$file is not in the archive" && return 1; }
    done
    # Nothing else, and all of it in one folder.
    if grep -v "^$name/" "$work/listed.txt"; then return 1; fi
    [ "$(grep -vc '/$' "$work/listed.txt")" -le 14 ]
}
