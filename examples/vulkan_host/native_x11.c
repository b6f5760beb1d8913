/* The window on X11. */
#ifndef _WIN32
#define VK_USE_PLATFORM_XLIB_KHR
#endif
#include "host.h"
#include "native.h"

#ifndef _WIN32

#include <X11/Xlib.h>

static Display *display;
static Window window;
static Atom closing;

const char *native_extension(void) { return VK_KHR_XLIB_SURFACE_EXTENSION_NAME; }

void native_open(native *n, uint32_t width, uint32_t height)
{
    XInitThreads();
    display = XOpenDisplay(NULL);
    EXPECT(display, "no X display; is DISPLAY set?");
    window = XCreateSimpleWindow(display, DefaultRootWindow(display), 0, 0, width, height, 0, 0, 0);
    XStoreName(display, window, "Welkin on a host's Vulkan");
    closing = XInternAtom(display, "WM_DELETE_WINDOW", False);
    XSetWMProtocols(display, window, &closing, 1);
    XSelectInput(display, window, StructureNotifyMask);
    XMapWindow(display, window);
    XSync(display, False);
    *n = (native){.width = width, .height = height, .open = true};
}

void native_take_events(native *n)
{
    while (XPending(display)) {
        XEvent event;
        XNextEvent(display, &event);
        if (event.type == ConfigureNotify) {
            const uint32_t width = (uint32_t)event.xconfigure.width, height = (uint32_t)event.xconfigure.height;
            n->resized |= width != n->width || height != n->height;
            n->width = width;
            n->height = height;
        }
        if (event.type == ClientMessage && (Atom)event.xclient.data.l[0] == closing) n->open = false;
    }
}

void native_resize(uint32_t width, uint32_t height)
{
    XResizeWindow(display, window, width, height);
    XSync(display, False);
}

VkSurfaceKHR native_surface(VkInstance instance)
{
    const VkXlibSurfaceCreateInfoKHR info = {
        .sType = VK_STRUCTURE_TYPE_XLIB_SURFACE_CREATE_INFO_KHR, .dpy = display, .window = window};
    VkSurfaceKHR surface;
    VK_CHECK(vkCreateXlibSurfaceKHR(instance, &info, NULL, &surface));
    return surface;
}

void native_close(native *n)
{
    n->open = false;
    XDestroyWindow(display, window);
    XCloseDisplay(display);
}

#endif
