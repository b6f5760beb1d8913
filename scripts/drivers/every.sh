# What scripts/drivers-all.sh adds to run.sh: further drivers, and the gallery and the lab beside the small scenes.

on_zink() { LIBGL_ALWAYS_SOFTWARE=1 MESA_LOADER_DRIVER_OVERRIDE=zink GALLIUM_DRIVER=zink in_folder "$@"; }

on_swiftshader() {
    VK_DRIVER_FILES="$angle/vk_swiftshader_icd.json" VK_ICD_FILENAMES="$angle/vk_swiftshader_icd.json" on_system "$@"
}

# OpenGL sent to a server that draws it with llvmpipe, as in a virtual machine.
on_virgl() {
    start_virgl
    VTEST_SOCKET_NAME="$work/virgl.socket" LIBGL_ALWAYS_SOFTWARE=1 GALLIUM_DRIVER=virpipe in_folder "$@"
}

virgl_pid=""
start_virgl() {
    [ -z "$virgl_pid" ] || return 0
    rm -f "$work/virgl.socket"
    LIMIT_S=0 in_folder "$newer/root/usr/bin/virgl_test_server" --use-egl-surfaceless \
        --socket-path "$work/virgl.socket" >"$work/virgl.log" 2>&1 &
    virgl_pid=$!
    local waited
    for waited in $(seq 50); do
        [ ! -S "$work/virgl.socket" ] || return 0
        sleep 0.2
    done
    echo "virgl's server does not answer: $(tail -1 "$work/virgl.log")" >&2
}
# The server is the child of the shell that waits for it.
stop_virgl() { [ -z "$virgl_pid" ] || pkill -P "$virgl_pid"; }

# every NAME WAY RUNNER WHY_NOT REFERENCE : all pictures of a driver, and how they differ from the reference's.
every() {
    local name="$1" way="$2" runner="$3" why_not="$4" reference="$5" more=gallery
    [ "$way" != vulkan ] || more=lab
    if [ -n "$why_not" ]; then
        skip "${#scenes[@]}" "$name: $why_not"
        return
    fi
    draw "$name" "$way" "$runner"
    draw_more "$name" "$way" "$runner"
    echo "$name: $(version_of "$name")"
    count_scenes "$name"
    [ "$name" != "$reference" ] || return 0
    on_system "$work/scenes" compare "$work/$reference" "$work/$name" | sed "s/^/  /"
    [ ! -d "$work/$name/$more" ] || "$lab" scenes "$work/$reference/$more" "$work/$name/$more" | sed "s/^/  /"
}

count_scenes() {
    local scene bad
    for scene in "${scenes[@]}"; do
        bad="$(awk -F'\t' -v s="$scene" '$1 == s { print $2 }' "$work/$1/figures")"
        [ "$bad" = 0 ] && pass || fail "$1 $scene: ${bad:-no} values that are not numbers: $(tail -1 "$work/$1/log")"
    done
}

# The gallery by a host of OpenGL, the lab's scenes by Vulkan. OpenGL ES has neither.
readonly lab=target/release/lab
draw_more() {
    local name="$1" way="$2" runner="$3" folder="$work/$1"
    case "$way" in
    gl)
        mkdir -p "$folder/gallery"
        LIMIT_S=20000 "$runner" "$stage/glfw_host/glfw_host" --data examples/data --size 640x360 --out "$folder/gallery" \
            --gallery >>"$folder/log" 2>&1 && pass || fail "$name: gallery: $(tail -1 "$folder/log")"
        ;;
    vulkan)
        mkdir -p "$folder/lab"
        LIMIT_S=20000 "$runner" "$lab" scenes "$folder/lab" >>"$folder/log" 2>&1 && pass ||
            fail "$name: lab: $(tail -1 "$folder/log")"
        ;;
    esac
}
