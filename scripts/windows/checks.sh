# The checks under Wine. Sourced by run.sh.
# shellcheck shell=bash

run_checks() {
    check "programs build by MinGW, without a warning" build_programs
    check "the same programs build on Linux" build_programs_linux
    check "vulkan_host builds by MinGW" build_vulkan_host
    check "consumer: find_package in the unpacked archive" consumer_by_cmake
    check "minimal.c out of the archive, picture as on Linux" minimal_from_archive
    check "noop" says_ok noop.exe
    check "raii" says_ok raii.exe
    check "values and state as on Linux" same own noop noop.ppm noop-values.bin
    local backend mode
    for backend in noop vulkan opengl; do
        check "loaded and unloaded three times: $backend" loads_thrice "$backend"
    done
    for backend in vulkan opengl; do
        check "own device, picture as on Linux: $backend" same own "$backend" "own-$backend.ppm" "values-$backend.bin"
        check "a window resized, hidden and destroyed: $backend" says_ok window.exe "$backend"
    done
    check "window_host: Vulkan" says_ok window_host.exe --check window.ppm
    check "window_host: OpenGL" says_ok window_host.exe --gl --check window-gl.ppm
    for mode in "shared core" "host core" "host compatibility" "window compatibility"; do
        # shellcheck disable=SC2086
        check "OpenGL host by WGL, picture as on Linux: $mode" same opengl_host $mode "opengl-${mode// /-}.ppm"
    done
    check "Vulkan host, picture as on Linux" same vulkan_host vulkan-host.ppm
    check "Vulkan host in a window that is resized" says_ok vulkan_host.exe --window --check
    glfw_host_checks
}
