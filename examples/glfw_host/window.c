/* The window: contexts, keys, title, and the loop. */
#include "window.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "demo.h"

static GLFWwindow *windows[2]; /* the visible window, and a hidden one in whose context Welkin draws */

static const void *get_proc(void *user, const char *name)
{
    (void)user;
    GLFWglproc function = glfwGetProcAddress(name);
    const void *address;
    memcpy(&address, &function, sizeof address);
    return address;
}

static int make_current(void *user, uint32_t which)
{
    (void)user;
    glfwMakeContextCurrent(windows[which]);
    return glfwGetCurrentContext() == windows[which] ? 0 : 1;
}

static void on_fault(int code, const char *message)
{
    fprintf(stderr, "GLFW %d: %s\n", code, message);
}

bool window_possible(void)
{
#ifdef _WIN32
    return true; /* without a desktop session glfwInit fails and reports it */
#else
    return getenv("DISPLAY") || getenv("WAYLAND_DISPLAY");
#endif
}

static GLFWwindow *create(int width, int height, GLFWwindow *share, bool visible)
{
    static const int versions[][2] = {{4, 5}, {4, 3}, {3, 3}};
    glfwSetErrorCallback(NULL); /* an OpenGL version that does not exist here is no error */
    GLFWwindow *w = NULL;
    for (int v = 0; v < 3 && !w; v++) {
        glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, versions[v][0]);
        glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, versions[v][1]);
        glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
        glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
        glfwWindowHint(GLFW_VISIBLE, visible ? GLFW_TRUE : GLFW_FALSE);
        glfwWindowHint(GLFW_DEPTH_BITS, 0);
        w = glfwCreateWindow(width, height, "Welkin", NULL, share);
    }
    glfwSetErrorCallback(on_fault);
    return w;
}

bool window_contexts(platform *p, int width, int height, bool visible)
{
    *p = (platform){get_proc, make_current, NULL};
    glfwSetErrorCallback(on_fault);
    if (!glfwInit())
        return false;
    windows[CONTEXT_HOST] = create(width, height, NULL, visible);
    windows[CONTEXT_WELKIN] = windows[CONTEXT_HOST] ? create(1, 1, windows[CONTEXT_HOST], false) : NULL;
    if (!windows[CONTEXT_WELKIN])
        fprintf(stderr, "this display has no OpenGL 3.3\n");
    return windows[CONTEXT_WELKIN] && make_current(NULL, CONTEXT_HOST) == 0;
}

void window_end(void)
{
    glfwTerminate();
}

static void on_key(GLFWwindow *w, int key, int scancode, int action, int mods)
{
    (void)scancode;
    demo *d = glfwGetWindowUserPointer(w);
    int step = mods & GLFW_MOD_SHIFT ? -1 : 1;
    if (action == GLFW_RELEASE)
        return;
    switch (key) {
    case GLFW_KEY_N: demo_next_report(d, step); break;
    case GLFW_KEY_T: demo_next_hour(d, step); break;
    case GLFW_KEY_C: demo_next_camera(d, step); break;
    case GLFW_KEY_W: d->bare = !d->bare; break;
    case GLFW_KEY_ESCAPE:
    case GLFW_KEY_Q: glfwSetWindowShouldClose(w, GLFW_TRUE); break;
    default: break;
    }
}

static void set_title(GLFWwindow *w, const demo *d)
{
    char title[512];
    const report *r = &d->reports.items[d->report];
    snprintf(title, sizeof title, "Welkin %.1f ms (weather %.1f ms) | %s | %s | %s", d->ms, d->weather_ms,
             d->bare ? "no weather" : r->metar, HOURS[d->hour].name, demo_camera_name(d));
    glfwSetWindowTitle(w, title);
}

static void loop(GLFWwindow *w, demo *d, int frames)
{
    for (int frame = 0; !glfwWindowShouldClose(w) && (frames == 0 || frame < frames); frame++) {
        int width, height;
        glfwPollEvents();
        glfwGetFramebufferSize(w, &width, &height);
        if (width == 0 || height == 0) { /* minimised */
            glfwWaitEvents();
            continue;
        }
        if (!demo_resize(d, width, height) || !demo_draw(d))
            return;
        glBindFramebuffer(GL_READ_FRAMEBUFFER, d->picture.shown_frame);
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
        glBlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
        glfwSwapBuffers(w);
        set_title(w, d);
    }
}

int window_run(const char *data, const demo_world *world, int width, int height, int frames, int first)
{
    platform p;
    demo d;
    int code = 1;
    if (window_contexts(&p, width, height, true) && gl_load(&p) && demo_open(&d, &p, data, world, width, height, 1)) {
        printf("adapter: %s\nkeys: N next report, T time of day, C camera (Shift: back), W weather on and off, Q quit\n",
               weather_adapter(&d.weather));
        glfwSetWindowUserPointer(windows[CONTEXT_HOST], &d);
        glfwSetKeyCallback(windows[CONTEXT_HOST], on_key);
        demo_next_report(&d, first > 0 ? first - 1 : 0);
        d.moving = true;
        loop(windows[CONTEXT_HOST], &d, frames);
        printf("last frame: %.1f ms, of it weather %.1f ms\n", d.ms, d.weather_ms);
        demo_close(&d);
        code = 0;
    }
    window_end();
    return code;
}
