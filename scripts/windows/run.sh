#!/usr/bin/env bash
# `make windows`: builds welkin.dll with MinGW, packs it for Windows projects, and checks it under Wine beside the same
# programs on Linux. The closing line counts the checks: `windows: N passed, N failed`.
#
#   scripts/windows/run.sh          all of it
#   scripts/windows/run.sh pack     the archive and the checks that read it; nothing is run
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/../command_line.sh"
answer_command_line "$@"
case "${1:-}" in '' | pack) ;; *) refuse "$1" ;; esac
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
. scripts/windows/common.sh
. scripts/windows/setup.sh
. scripts/windows/dll.sh
. scripts/windows/wine.sh
. scripts/windows/glfw.sh
. scripts/windows/checks.sh

install_packages
find_std
build_dll
lay_out
echo "windows: $archive"
check "imports only DLLs of Windows" only_dlls_of_windows
check "exports equal the ABI list" exports_are_the_abi
check "import libraries name every function" import_libraries_are_whole
check "the DLL is stripped" dll_is_stripped
check "the archive has all that a project needs" archive_has_all
if git rev-parse --git-dir >/dev/null 2>&1; then
    check "a checkout with autocrlf has the same bytes" checkout_keeps_line_ends
else
    skip "a checkout with autocrlf has the same bytes" "this is no checkout of git's"
fi
if [ "${1:-}" != pack ]; then
    build_linux
    start_wine
    run_checks
fi
summary windows
