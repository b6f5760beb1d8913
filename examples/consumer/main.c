/*
 * The smallest program that uses an installed Welkin: it creates a device that needs no GPU and a context on it, and
 * prints Welkin's version. The tests build it against the installed tree, with pkg-config and find_package(welkin).
 */
#include <stdio.h>

#include <welkin.h>

static int check(wk_status status)
{
    if (status >= WK_OK)
        return 1;
    fprintf(stderr, "%s: %s\n", wk_status_name(status), wk_last_error_message());
    return 0;
}

int main(void)
{
    uint32_t major = 0, minor = 0, patch = 0;
    wk_device_desc desc = WK_DEVICE_DESC_INIT;
    wk_device *device = NULL;
    wk_context *context = NULL;
    wk_caps caps = WK_CAPS_INIT;

    desc.backends = WK_BACKEND_NOOP;
    int ok = check(wk_version(&major, &minor, &patch)) && check(wk_device_create(&desc, &device)) &&
             check(wk_device_get_caps(device, &caps)) && check(wk_context_create(device, NULL, &context));
    if (ok)
        printf("welkin %u.%u.%u on %s\n", (unsigned)major, (unsigned)minor, (unsigned)patch, caps.adapter_name);
    ok = check(wk_context_destroy(context)) && ok;
    ok = check(wk_device_destroy(device)) && ok;
    return ok ? 0 : 1;
}
