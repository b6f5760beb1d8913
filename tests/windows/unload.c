/* Loads the library at run time, uses it and unloads it, three times over, for one interface. What is left behind by a
 * driver or by wgpu must not end the process afterwards: it goes on for a moment.
 *
 *     unload LIBRARY vulkan|opengl|noop FUNCTION.. */
#define _DEFAULT_SOURCE /* usleep */
#include "welkin.h"

#include <stdio.h>
#include <string.h>

#ifdef _WIN32
#define WIN32_LEAN_AND_MEAN
#include <windows.h>
typedef HMODULE library;
static library load(const char *path) { return LoadLibraryA(path); }
static int unload(library l) { return FreeLibrary(l) ? 0 : 1; }
static void find(library l, const char *name, void *function)
{
    FARPROC found = GetProcAddress(l, name);
    memcpy(function, &found, sizeof found);
}
static void wait_ms(unsigned ms) { Sleep(ms); }
#else
#include <dlfcn.h>
#include <unistd.h>
typedef void *library;
static library load(const char *path) { return dlopen(path, RTLD_NOW | RTLD_LOCAL); }
static int unload(library l) { return dlclose(l); }
static void find(library l, const char *name, void *function)
{
    void *found = dlsym(l, name);
    memcpy(function, &found, sizeof found);
}
static void wait_ms(unsigned ms) { usleep(1000 * ms); }
#endif

#define EXPECT(condition)                                                   \
    do {                                                                    \
        if (!(condition)) {                                                 \
            fprintf(stderr, "%s:%d: %s\n", __FILE__, __LINE__, #condition); \
            return 1;                                                       \
        }                                                                   \
    } while (0)

static int once(int argc, char **argv)
{
    wk_status (*create)(const wk_device_desc *, wk_device **) = NULL;
    wk_status (*destroy)(wk_device *) = NULL;
    const char *(*message)(void) = NULL;
    void (*any)(void) = NULL;
    wk_device_desc desc = WK_DEVICE_DESC_INIT;
    wk_device *device = NULL;
    wk_status made;
    library welkin = load(argv[1]);
    int i;
    EXPECT(welkin);
    for (i = 3; i < argc; i++) {
        find(welkin, argv[i], &any);
        if (!any) fprintf(stderr, "%s is missing\n", argv[i]);
        EXPECT(any);
    }
    find(welkin, "wk_device_create", &create);
    find(welkin, "wk_device_destroy", &destroy);
    find(welkin, "wk_last_error_message", &message);
    EXPECT(create && destroy && message);
    desc.backends = strcmp(argv[2], "vulkan") == 0   ? WK_BACKEND_VULKAN
                    : strcmp(argv[2], "opengl") == 0 ? WK_BACKEND_GL
                                                     : WK_BACKEND_NOOP;
    made = create(&desc, &device);
    if (made < 0) fprintf(stderr, "%s\n", message());
    EXPECT(made == WK_OK && destroy(device) == WK_OK);
    EXPECT(unload(welkin) == 0);
    return 0;
}

int main(int argc, char **argv)
{
    int i;
    EXPECT(argc > 3);
    for (i = 0; i < 3; i++) {
        EXPECT(once(argc, argv) == 0);
        wait_ms(300);
    }
    printf("%d functions, three times\n", argc - 3);
    return 0;
}
