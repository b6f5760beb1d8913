/* The window on X11. */
#define _DEFAULT_SOURCE /* usleep */
#include "window.h"

#ifndef _WIN32

#include <X11/Xlib.h>
#include <X11/Xutil.h>
#include <unistd.h>

static Display *display;
static Window window;
static Atom closing;

void window_open(host_window *w, uint32_t width, uint32_t height)
{
    const wk_window named = WK_WINDOW_INIT;
    XInitThreads(); /* the driver's threads use the connection too */
    display = XOpenDisplay(NULL);
    EXPECT(display, "no X display; is DISPLAY set?");
    window = XCreateSimpleWindow(display, DefaultRootWindow(display), 0, 0, width, height, 0, 0, 0);
    XStoreName(display, window, "Welkin");
    XSelectInput(display, window, StructureNotifyMask | Button1MotionMask);
    closing = XInternAtom(display, "WM_DELETE_WINDOW", False);
    XSetWMProtocols(display, window, &closing, 1);
    XMapWindow(display, window);
    *w = (host_window){.named = named, .width = width, .height = height, .open = true};
    w->named.kind = WK_WINDOW_XLIB;
    w->named.display = display;
    w->named.screen = DefaultScreen(display);
    w->named.id = window;
}

void window_take_events(host_window *w)
{
    XSync(display, False);
    while (XPending(display)) {
        XEvent event;
        XNextEvent(display, &event);
        if (event.type == ConfigureNotify) {
            const uint32_t width = (uint32_t)event.xconfigure.width, height = (uint32_t)event.xconfigure.height;
            w->resized |= w->width != width || w->height != height;
            w->width = width;
            w->height = height;
        } else if (event.type == MotionNotify) {
            w->dragged = true;
            w->drag_x = (double)event.xmotion.x / w->width;
            w->drag_y = (double)event.xmotion.y / w->height;
        } else if (event.type == ClientMessage && (Atom)event.xclient.data.l[0] == closing) {
            w->open = false;
        }
    }
}

void window_resize(host_window *w, uint32_t width, uint32_t height)
{
    (void)w;
    XResizeWindow(display, window, width, height);
}

void window_show(host_window *w, bool shown)
{
    (void)w;
    if (shown) XMapWindow(display, window);
    else XUnmapWindow(display, window);
}

void window_close(host_window *w)
{
    w->open = false;
    XDestroyWindow(display, window);
    XCloseDisplay(display);
}

unsigned char *window_pixels(host_window *w)
{
    XSync(display, False);
    XImage *image = XGetImage(display, window, 0, 0, w->width, w->height, AllPlanes, ZPixmap);
    unsigned char *rgb = malloc((size_t)w->width * w->height * 3);
    EXPECT(image && rgb, "the window has no pixels");
    for (uint32_t i = 0; i < w->width * w->height; i++) {
        const unsigned long p = XGetPixel(image, (int)(i % w->width), (int)(i / w->width));
        rgb[3 * i] = (unsigned char)(p >> 16 & 255);
        rgb[3 * i + 1] = (unsigned char)(p >> 8 & 255);
        rgb[3 * i + 2] = (unsigned char)(p & 255);
    }
    XDestroyImage(image);
    return rgb;
}

void window_sleep_ms(unsigned ms)
{
    usleep(1000 * ms);
}

#endif
