#!/usr/bin/env bash
# Draws every scene with every software driver: those of tests/drivers, the gallery and the lab's. A good hour; no test of
# its own, but what docs/drivers.md is written from. Differences are printed, a scene that is not drawn fails.
#
#   scripts/drivers-all.sh STAGE DIR    STAGE holds the built library and glfw_host, DIR keeps drivers and pictures
set -uo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/command_line.sh"
answer_command_line "$@"
case "${1:-}" in -*) refuse "$1" ;; esac
[ $# -eq 2 ] || { echo "drivers-all.sh: two arguments are wanted, got $#; drivers-all.sh --help lists them" >&2; exit 2; }
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. scripts/drivers/fetch.sh
. scripts/drivers/run.sh
. scripts/drivers/every.sh

begin "$1" "$2" "$SUITE-all" "${PACKAGES[@]}" virgl-server libglfw3 libpng16-16t64
trap stop_virgl EXIT

# The reference first, then each driver with what it can draw: small scenes, gallery (OpenGL), lab (Vulkan).
every system-vulkan vulkan on_system "" system-vulkan
every system-gl gl on_system "" system-gl
every lavapipe vulkan in_folder "$no_newer" system-vulkan
every llvmpipe gl in_folder "$no_newer" system-gl
every zink gl on_zink "$no_newer" llvmpipe
every virgl gl on_virgl "$no_newer" llvmpipe
every swiftshader vulkan on_swiftshader "$no_angle" system-vulkan
every angle es31 on_angle "$no_angle" system-gl
every mesa-es es31 on_system "" system-gl
finish
