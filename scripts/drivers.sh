#!/usr/bin/env bash
# Draws the scenes of tests/drivers with other drivers than this system's and compares the pictures with its own.
#
#   scripts/drivers.sh STAGE DIR        twelve scenes; STAGE holds the built library, DIR keeps drivers and pictures
#   WELKIN_BLESS=1 scripts/drivers.sh   writes tests/drivers/expected.tsv anew from what it saw
#
# A scene passes if it is drawn without a value that is not a number, if validation says nothing, and if the picture
# differs from the reference by no more than the table says for these very versions of both. Other versions are drawn
# and not compared: a notice, counted as skipped, as is a driver that cannot be had. The last line counts all.
set -uo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/command_line.sh"
answer_command_line "$@"
case "${1:-}" in -*) refuse "$1" ;; esac
[ $# -eq 2 ] || { echo "drivers.sh: two arguments are wanted, got $#; drivers.sh --help lists them" >&2; exit 2; }
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. scripts/drivers/fetch.sh
. scripts/drivers/run.sh

begin "$1" "$2" "$SUITE" "${PACKAGES[@]}"

# Two at a time: software drivers keep a core busy each, and compile shaders on one.
draw system-vulkan vulkan on_system &
draw system-gl gl on_system &
wait
[ -n "$no_newer" ] || draw lavapipe vulkan in_folder_validated &
[ -n "$no_newer" ] || draw llvmpipe gl in_folder &
wait
[ -n "$no_angle" ] || draw angle es31 on_angle &
[ -n "$no_newer" ] || draw_vulkan_host &
wait

judge_driver lavapipe system-vulkan "$no_newer"
judge_driver llvmpipe system-gl "$no_newer"
judge_driver angle system-gl "$no_angle"
judge_messages "scenes" "$work/lavapipe/messages" "$no_newer"
judge_vulkan_host "$no_newer"
finish
