/*
 * A simulator's world in OpenGL, with Welkin's weather in it. With a display it opens a window; with none it writes
 * pictures. What a simulator's author would copy is weather_link.c: the rest is the simulator.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "contact.h"
#include "window.h"

static const char USAGE[] =
    "glfw_host [--data DIR] [--out DIR] [--size WxH] [--headless] [--frames N] [--report N]\n"
    "  --data DIR   terrain and weather reports (examples/data)\n"
    "  --out DIR    where pictures go when there is no display (out); it must exist\n"
    "  --size WxH   of the picture (640x360; window 1280x720)\n"
    "  --headless   write pictures even where there is a display\n"
    "  --frames N   close the window after N frames\n"
    "  --report N   begin with report N; pictures of that one only\n";

int main(int argc, char **argv)
{
    const char *data = "examples/data", *out = "out";
    int width = 0, height = 0, frames = 0, report = 0;
    bool headless = !window_possible();
    for (int i = 1; i < argc; i++) {
        bool more = i + 1 < argc;
        if (strcmp(argv[i], "--data") == 0 && more)
            data = argv[++i];
        else if (strcmp(argv[i], "--out") == 0 && more)
            out = argv[++i];
        else if (strcmp(argv[i], "--frames") == 0 && more)
            frames = atoi(argv[++i]);
        else if (strcmp(argv[i], "--report") == 0 && more)
            report = atoi(argv[++i]);
        else if (strcmp(argv[i], "--headless") == 0)
            headless = true;
        else if (strcmp(argv[i], "--size") == 0 && more && sscanf(argv[i + 1], "%dx%d", &width, &height) == 2 &&
                 width >= 16 && height >= 16 && width <= 8192 && height <= 8192)
            i++;
        else {
            fputs(USAGE, stderr);
            return 2;
        }
    }
    if (width == 0)
        width = headless ? 640 : 1280, height = headless ? 360 : 720;
    return headless ? contact_run(data, out, width, height, report) : window_run(data, width, height, frames, report);
}
