# How scripts/drivers.sh runs a program with a driver, and how it judges what came of it.

# What a driver's own needs, and the layers.
readonly PACKAGES=(libgl1-mesa-dri libegl1 libgl1 libvulkan1 mesa-vulkan-drivers vulkan-validationlayers)
readonly TABLE=tests/drivers/expected.tsv
# Seconds for the scenes of one driver; 0: as long as it takes.
LIMIT_S="${DRIVERS_LIMIT_S:-900}"
# Differences beyond the table's, of 255, that processors with other vectors may bring: p95 and greatest.
readonly ROOM_P95=1 ROOM_MOST=16

passed=0 failed=0 skipped=0 blessed=""

# Shaders are compiled anew each time: a cache that other programs and versions of Mesa write meanwhile must not count.
export MESA_SHADER_CACHE_DISABLE=true

# begin STAGE DIR FOLDER PACKAGE.. : what is drawn, and the drivers it is drawn with; Debian's packages in DIR/FOLDER.
begin() {
    stage="$(realpath "$1")"
    mkdir -p "$2"
    work="$(realpath "$2")"
    newer="$work/$3"
    angle="$work/angle"
    readonly stage work newer angle
    shift 3
    build_scenes || { echo "drivers: 0 passed, 1 failed"; exit 1; }
    mapfile -t scenes < <(on_system "$work/scenes" list)
    no_newer="$(fetch_debian "$SUITE" "$newer" "$@")"
    no_angle="$(fetch_angle "$ANGLE" "$angle")"
    write_layer_settings
}

# The scenes' program, and the Vulkan host, which listens to validation itself.
build_scenes() {
    cc -O1 -std=c99 -Wall -Wextra -pedantic -Werror -D_POSIX_C_SOURCE=200809L -I"$stage/include" tests/drivers/*.c \
        -o "$work/scenes" -L"$stage/lib" -lwelkin -lm -ldl &&
        cc -O1 -std=c11 -pthread -I"$stage/include" examples/vulkan_host/*.c -o "$work/vulkan_host" -L"$stage/lib" -lwelkin \
            -lvulkan -lX11 -lm
}

on_system() { LD_LIBRARY_PATH="$stage/lib" timeout "$LIMIT_S" "$@"; }

# By the folder's own loader and C library: a driver of a newer system does not run on an older C library, and the
# older program runs on the newer one.
in_folder() {
    local root="$newer/root"
    local lib="$root/usr/lib/x86_64-linux-gnu" icd="$root/usr/share/vulkan/icd.d/lvp_icd.json"
    [ -f "$icd" ] || icd="$(echo "$root"/usr/share/vulkan/icd.d/lvp_icd*.json)"
    env -u LD_LIBRARY_PATH VK_DRIVER_FILES="$icd" VK_ICD_FILENAMES="$icd" \
        VK_LAYER_PATH="$root/usr/share/vulkan/explicit_layer.d" LIBGL_DRIVERS_PATH="$lib/dri" \
        __EGL_VENDOR_LIBRARY_FILENAMES="$root/usr/share/glvnd/egl_vendor.d/50_mesa.json" \
        timeout "$LIMIT_S" "$root/usr/lib64/ld-linux-x86-64.so.2" --library-path "$stage/lib:$lib" "$@"
}

in_folder_validated() {
    VK_INSTANCE_LAYERS=VK_LAYER_KHRONOS_validation VK_LAYER_SETTINGS_PATH="$work/vk_layer_settings.txt" in_folder "$@"
}

on_angle() { DRIVERS_EGL="$angle/libEGL.so" LD_LIBRARY_PATH="$stage/lib:$angle" timeout "$LIMIT_S" "$@"; }

# Core and synchronisation validation, every message to a file. `info` is there for the one message that says that the
# layer runs: without it silence would mean nothing.
write_layer_settings() {
    mkdir -p "$work/lavapipe"
    cat >"$work/vk_layer_settings.txt" <<END
khronos_validation.validate_core = true
khronos_validation.validate_sync = true
khronos_validation.debug_action = VK_DBG_LAYER_ACTION_LOG_MSG
khronos_validation.report_flags = error,warn,info
khronos_validation.log_filename = $work/lavapipe/messages
END
}

# draw NAME WAY RUNNER : DIR/NAME gets a picture a scene and `figures`. Where the driver takes the process with it, another
# process draws the scenes behind the one at fault.
draw() {
    local name="$1" way="$2" runner="$3" folder="$work/$1" from=0 drawn code
    mkdir -p "$folder"
    rm -f "$folder"/{*.ppm,figures,log,messages}
    while [ "$from" -lt "${#scenes[@]}" ]; do
        code=0
        "$runner" "$work/scenes" draw "$way" "$folder" "${scenes[@]:$from}" >"$folder/out" 2>>"$folder/log" || code=$?
        cat "$folder/out" >>"$folder/figures"
        [ "$code" -ge 124 ] || break
        drawn="$(grep -cP '^[a-z_]+\t[0-9]+$' "$folder/out")"
        echo "${scenes[$((from + drawn))]}: the process ended with status $code" >>"$folder/log"
        from=$((from + drawn + 1))
    done
}

draw_vulkan_host() {
    in_folder "$work/vulkan_host" "$work/vulkan_host.ppm" >"$work/vulkan_host.log" 2>&1
    echo $? >"$work/vulkan_host.status"
}

# ------------------------------------------------------------------------------------------------ judgements

pass() { passed=$((passed + 1)); }
fail() { failed=$((failed + 1)); echo "FAILED  $*"; }
skip() { skipped=$((skipped + $1)); shift; echo "skipped $*"; }

# Mesa's and LLVM's release, or the driver's whole name: a rebuilt package is the same version.
version_of() {
    local line
    line="$(sed -n 's/^driver\t//p' "$work/$1/figures" 2>/dev/null | head -1)"
    if [[ "$line" =~ Mesa\ ([0-9.]+) ]]; then
        local mesa="${BASH_REMATCH[1]}"
        [[ "$line" =~ LLVM\ ([0-9.]+) ]] && echo "Mesa $mesa, LLVM ${BASH_REMATCH[1]}" || echo "Mesa $mesa"
    else
        echo "${line:-none}"
    fi
}

# judge_driver NAME REFERENCE WHY_NOT : every scene of a driver.
judge_driver() {
    local name="$1" reference="$2" why_not="$3" version reference_version scene bad p95 most told
    if [ -n "$why_not" ]; then
        skip "${#scenes[@]}" "$name: ${#scenes[@]} scenes: $why_not"
        return
    fi
    version="$(version_of "$name")" reference_version="$(version_of "$reference")"
    echo "$name: $version, beside $reference: $reference_version"
    rows_for "$name" "$version" "$reference_version" | grep -q . ||
        echo "notice: $TABLE has other versions: $name is drawn and not compared"
    on_system "$work/scenes" compare "$work/$reference" "$work/$name" >"$work/$name/differences"
    for scene in "${scenes[@]}"; do
        bad="$(awk -F'\t' -v s="$scene" '$1 == s { print $2 }' "$work/$name/figures")"
        read -r p95 most < <(awk -F'\t' -v s="$scene" '$1 == s { print $2, $3 }' "$work/$name/differences")
        if [ -z "$bad" ]; then
            fail "$name $scene: not drawn: $(tail -2 "$work/$name/log" | tr '\n' ' ')"
        elif [ "$bad" -gt 0 ]; then
            fail "$name $scene: $bad values are not numbers"
        elif [ -z "$p95" ]; then
            skip 1 "$name $scene: $reference drew no picture to compare with"
        else
            blessed+="$name"$'\t'"$version"$'\t'"$reference_version"$'\t'"$scene"$'\t'"$p95"$'\t'"$most"$'\n'
            judge_difference "$name" "$version" "$reference_version" "$scene" "$p95" "$most"
        fi
    done
}

# Rows of the table for these versions: scene, p95, most.
rows_for() {
    awk -F'\t' -v n="$1" -v v="$2" -v r="$3" '$1 == n && $2 == v && $3 == r { print $4, $5, $6 }' "$TABLE"
}

judge_difference() {
    local name="$1" version="$2" reference_version="$3" scene="$4" p95="$5" most="$6" told_p95 told_most
    read -r _ told_p95 told_most < <(rows_for "$name" "$version" "$reference_version" | grep "^$scene ")
    if [ -z "$told_p95" ]; then
        skip 1 "$name $scene: p95 $p95, most $most of 255, not compared"
    elif [ "$p95" -gt $((told_p95 + ROOM_P95)) ] || [ "$most" -gt $((told_most + ROOM_MOST)) ]; then
        fail "$name $scene: p95 $p95, most $most of 255; the table has $told_p95 and $told_most"
    else
        pass
    fi
}

# judge_messages WHAT FILE WHY_NOT : what validation said.
judge_messages() {
    local what="$1" file="$2" why_not="$3"
    if [ -n "$why_not" ]; then
        skip 1 "validation of $what: $why_not"
    elif ! grep -q "Validation Layer Active" "$file" 2>/dev/null || ! grep -q "SYNCHRONIZATION_VALIDATION" "$file"; then
        fail "validation of $what: the layer did not say that it runs and looks at synchronisation"
    elif grep -qE "^(Validation )?(Error|Warning|Performance)" "$file"; then
        fail "validation of $what: $(grep -oE 'VUID-[A-Za-z0-9-]+|SYNC-[A-Z-]+' "$file" | sort | uniq -c | tr -s ' \n' ' ')"
    else
        pass
    fi
}

judge_vulkan_host() {
    local why_not="$1" status
    if [ -n "$why_not" ]; then
        skip 1 "validation of vulkan_host: $why_not"
        return
    fi
    status="$(cat "$work/vulkan_host.status" 2>/dev/null)"
    if [ "$status" = 0 ]; then
        pass
    else
        fail "vulkan_host ends with status $status: $(grep -oE 'VUID-[A-Za-z0-9-]+|SYNC-[A-Z-]+' "$work/vulkan_host.log" |
            sort | uniq -c | tr -s ' \n' ' ')$(tail -1 "$work/vulkan_host.log")"
    fi
}

finish() {
    if [ -n "${WELKIN_BLESS:-}" ]; then
        { grep '^#' "$TABLE"; printf '%s' "$blessed"; } >"$TABLE.new" && mv "$TABLE.new" "$TABLE"
    fi
    echo "drivers: $passed passed, $failed failed, $skipped skipped"
    [ "$failed" = 0 ]
}
