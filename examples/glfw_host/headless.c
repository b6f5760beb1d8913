/* OpenGL without a display, through EGL: no X server and no window, and no surface where the driver allows that.
 * Windows has no equivalent, so a hidden window is used there. */
#include "platform.h"

#ifdef _WIN32

#include "window.h"

bool headless_open(platform *p)
{
    return window_contexts(p, 1, 1, false);
}

void headless_close(platform *p)
{
    (void)p;
    window_end();
}

#else

#include <stdio.h>
#include <string.h>

#include <EGL/egl.h>
#include <EGL/eglext.h>

#ifndef EGL_PLATFORM_SURFACELESS_MESA
#define EGL_PLATFORM_SURFACELESS_MESA 0x31DD
#endif

static struct {
    EGLDisplay display;
    EGLSurface surface[2];
    EGLContext context[2];
} egl;

static const void *get_proc(void *user, const char *name)
{
    (void)user;
    void (*function)(void) = eglGetProcAddress(name);
    const void *address;
    memcpy(&address, &function, sizeof address);
    return address;
}

static int make_current(void *user, uint32_t which)
{
    (void)user;
    return eglMakeCurrent(egl.display, egl.surface[which], egl.surface[which], egl.context[which]) ? 0 : 1;
}

static bool has(const char *extensions, const char *name)
{
    const char *at = extensions ? strstr(extensions, name) : NULL;
    return at && (at[strlen(name)] == ' ' || at[strlen(name)] == '\0');
}

/* Picks the first GPU that works, or Mesa's software driver. */
static bool open_display(void)
{
    const char *client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    PFNEGLGETPLATFORMDISPLAYEXTPROC get_display =
        (PFNEGLGETPLATFORMDISPLAYEXTPROC)eglGetProcAddress("eglGetPlatformDisplayEXT");
    EGLDisplay candidates[3] = {EGL_NO_DISPLAY, EGL_NO_DISPLAY, EGL_NO_DISPLAY};
    if (get_display && has(client, "EGL_EXT_platform_device") && has(client, "EGL_EXT_device_enumeration")) {
        PFNEGLQUERYDEVICESEXTPROC query = (PFNEGLQUERYDEVICESEXTPROC)eglGetProcAddress("eglQueryDevicesEXT");
        EGLDeviceEXT device;
        EGLint count = 0;
        if (query && query(1, &device, &count) && count > 0)
            candidates[0] = get_display(EGL_PLATFORM_DEVICE_EXT, device, NULL);
    }
    if (get_display && has(client, "EGL_MESA_platform_surfaceless"))
        candidates[1] = get_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL);
    candidates[2] = eglGetDisplay(EGL_DEFAULT_DISPLAY);
    for (int i = 0; i < 3; i++)
        if (candidates[i] != EGL_NO_DISPLAY && eglInitialize(candidates[i], NULL, NULL)) {
            if (eglBindAPI(EGL_OPENGL_API)) {
                egl.display = candidates[i];
                return true;
            }
            eglTerminate(candidates[i]);
        }
    return false;
}

static bool open_contexts(void)
{
    static const EGLint wanted[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
    static const EGLint tiny[] = {EGL_WIDTH, 1, EGL_HEIGHT, 1, EGL_NONE};
    /* The newest core profile that the driver offers; the host needs only 3.3. */
    static const EGLint versions[][2] = {{4, 5}, {4, 3}, {3, 3}};
    bool surfaceless = has(eglQueryString(egl.display, EGL_EXTENSIONS), "EGL_KHR_surfaceless_context");
    EGLConfig config;
    EGLint count = 0;
    if (!eglChooseConfig(egl.display, wanted, &config, 1, &count) || count < 1)
        return false;
    for (int v = 0; v < 3; v++) {
        EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION, versions[v][0], EGL_CONTEXT_MINOR_VERSION, versions[v][1],
                               EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
        EGLContext share = EGL_NO_CONTEXT;
        int made = 0;
        for (; made < 2; made++) {
            egl.context[made] = eglCreateContext(egl.display, config, share, attributes);
            if (egl.context[made] == EGL_NO_CONTEXT)
                break;
            share = egl.context[made];
            egl.surface[made] = surfaceless ? EGL_NO_SURFACE : eglCreatePbufferSurface(egl.display, config, tiny);
        }
        if (made == 2)
            return make_current(NULL, CONTEXT_HOST) == 0;
        if (made == 1)
            eglDestroyContext(egl.display, egl.context[0]);
    }
    return false;
}

bool headless_open(platform *p)
{
    if (!open_display() || !open_contexts()) {
        fprintf(stderr, "no display and no EGL with OpenGL 3.3 (EGL error 0x%x): install libegl1 and libgl1-mesa-dri\n",
                (unsigned)eglGetError());
        return false;
    }
    *p = (platform){get_proc, make_current, NULL};
    return true;
}

void headless_close(platform *p)
{
    (void)p;
    eglMakeCurrent(egl.display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    for (int i = 1; i >= 0; i--) {
        eglDestroyContext(egl.display, egl.context[i]);
        if (egl.surface[i] != EGL_NO_SURFACE)
            eglDestroySurface(egl.display, egl.surface[i]);
    }
    eglTerminate(egl.display);
}

#endif
