/* Two contexts by GLX: the same host on Linux, whose picture is the reference. */
#ifndef _WIN32

#include "contexts.h"
#include "scene.h"

#include <GL/glx.h>
#include <GL/glxext.h>

static Display *display;
static Window window;
static GLXContext contexts[2];

const void *contexts_get_proc(void *user, const char *name)
{
    void (*found)(void) = glXGetProcAddress((const GLubyte *)name);
    const void *address;
    (void)user;
    memcpy(&address, &found, sizeof address);
    return address;
}

int32_t contexts_make_current(void *user, uint32_t which)
{
    (void)user;
    return glXMakeCurrent(display, window, contexts[which]) ? 0 : 1;
}

void contexts_open(int width, int height, int core)
{
    static const int VISUAL[] = {GLX_DOUBLEBUFFER, 1, GLX_RED_SIZE, 8, GLX_GREEN_SIZE, 8, GLX_BLUE_SIZE, 8,
                                 GLX_DEPTH_SIZE, 24, GLX_STENCIL_SIZE, 8, None};
    static const int CORE[] = {GLX_CONTEXT_MAJOR_VERSION_ARB, 3, GLX_CONTEXT_MINOR_VERSION_ARB, 3,
                               GLX_CONTEXT_PROFILE_MASK_ARB, GLX_CONTEXT_CORE_PROFILE_BIT_ARB, None};
    PFNGLXCREATECONTEXTATTRIBSARBPROC create;
    XSetWindowAttributes attributes = {0};
    GLXFBConfig *configs;
    XVisualInfo *visual;
    int count = 0, i;
    display = XOpenDisplay(NULL);
    EXPECT(display);
    configs = glXChooseFBConfig(display, DefaultScreen(display), VISUAL, &count);
    EXPECT(configs && count > 0);
    visual = glXGetVisualFromFBConfig(display, configs[0]);
    attributes.colormap = XCreateColormap(display, DefaultRootWindow(display), visual->visual, AllocNone);
    window = XCreateWindow(display, DefaultRootWindow(display), 0, 0, (unsigned)width, (unsigned)height, 0,
                           visual->depth, InputOutput, visual->visual, CWColormap, &attributes);
    XMapWindow(display, window);
    XSync(display, False);
    create = (PFNGLXCREATECONTEXTATTRIBSARBPROC)glXGetProcAddress((const GLubyte *)"glXCreateContextAttribsARB");
    for (i = 0; i < 2; i++) {
        contexts[i] = core ? create(display, configs[0], i ? contexts[0] : NULL, True, CORE)
                           : glXCreateContext(display, visual, i ? contexts[0] : NULL, True);
        EXPECT(contexts[i]);
    }
    XFree(visual);
    XFree(configs);
    EXPECT(contexts_make_current(NULL, 0) == 0);
}

void contexts_close(void)
{
    glXMakeCurrent(display, None, NULL);
    glXDestroyContext(display, contexts[1]);
    glXDestroyContext(display, contexts[0]);
    XDestroyWindow(display, window);
    XCloseDisplay(display);
}

#else
typedef int not_on_this_system;
#endif
