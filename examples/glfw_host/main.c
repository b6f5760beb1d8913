/*
 * A simulator's world in OpenGL, with Welkin's weather in it. With a display it opens a window; without one it writes
 * pictures. To add Welkin to a simulator, copy weather_link.c; the rest stands for the simulator.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../command_line.h"
#include "contact.h"
#include "gallery.h"
#include "window.h"

static const char USAGE[] =
    "glfw_host [--data DIR] [--out DIR] [--size WxH] [--headless] [--frames N] [--report N] [--planet FILE]\n"
    "          [--sea | --terrain FILE]\n"
    "glfw_host --gallery [NAME..] [--data DIR] [--out DIR] [--size WxH]\n"
    "  --data DIR   terrain and weather reports (examples/data)\n"
    "  --out DIR    where pictures go when there is no display (out); it must exist\n"
    "  --size WxH   of the picture (640x360; window and gallery 1280x720)\n"
    "  --headless   write pictures even where there is a display\n"
    "  --frames N   close the window after N frames\n"
    "  --report N   begin with report N; pictures of that one only\n"
    "  --planet FILE  a planet file, as examples/data/planet_dusty.toml, in place of the Earth\n"
    "  --sea        a vessel on the open sea in place of the land\n"
    "  --terrain FILE  heights in metres in an ESRI ASCII grid, drawn by Welkin in place of the land\n"
    "  --gallery    draw the pictures of docs/gallery.md, or those of the names given, with 2 x 2 samples a pixel\n"
    "  --help, --version\n";

static const char NAME[] = "glfw_host";

/* Parses a size, WxH with 16 to 8192 each. For anything else, returns false and prints a line on stderr. */
static bool read_size(const char *text, int *width, int *height)
{
    int end = 0;
    const bool is_size = sscanf(text, "%dx%d%n", width, height, &end) == 2 && !text[end];
    if (is_size && *width >= 16 && *height >= 16 && *width <= 8192 && *height <= 8192)
        return true;
    fprintf(stderr, "%s: --size must be WxH, each from 16 to 8192, got %s\n", NAME, text);
    return false;
}

static bool is_one_of(const char *word, const char *const *words)
{
    while (*words && strcmp(word, *words) != 0)
        words++;
    return *words != NULL;
}

/* Returns the text of a file, which the caller frees. If it cannot be read, returns NULL and prints a line on
 * stderr. */
static char *text_of(const char *path)
{
    FILE *file = fopen(path, "rb");
    long size = file && fseek(file, 0, SEEK_END) == 0 ? ftell(file) : -1;
    char *text = size >= 0 ? calloc((size_t)size + 1, 1) : NULL;
    bool ok = text && fseek(file, 0, SEEK_SET) == 0 && fread(text, 1, (size_t)size, file) == (size_t)size;
    if (file)
        fclose(file);
    if (ok)
        return text;
    free(text);
    fprintf(stderr, "%s: cannot be read\n", path);
    return NULL;
}

int main(int argc, char **argv)
{
    const char *data = "examples/data", *out = "out", *planet_file = NULL;
    demo_world world = {0};
    int width = 0, height = 0, frames = 0, report = 0;
    bool headless = !window_possible(), gallery = false;
    char **names = argv; /* collected in place, over the arguments */
    int name_count = 0;
    static const char *const WITH_VALUE[] = {"--data", "--out", "--planet", "--terrain", "--frames", "--report", "--size", NULL};
    if (command_line_answered(argc, argv, NAME, USAGE))
        return 0;
    for (int i = 1; i < argc; i++) {
        const char *option = argv[i];
        bool ok = true;
        if (is_one_of(option, WITH_VALUE) && i + 1 == argc)
            return command_line_refused(NAME, option, "no value after ");
        if (strcmp(option, "--data") == 0)
            data = argv[++i];
        else if (strcmp(option, "--out") == 0)
            out = argv[++i];
        else if (strcmp(option, "--planet") == 0)
            planet_file = argv[++i];
        else if (strcmp(option, "--frames") == 0)
            ok = command_line_number(NAME, option, argv[++i], 0, 100000000, &frames);
        else if (strcmp(option, "--report") == 0)
            ok = command_line_number(NAME, option, argv[++i], 1, 1000, &report);
        else if (strcmp(option, "--size") == 0)
            ok = read_size(argv[++i], &width, &height);
        else if (strcmp(option, "--headless") == 0)
            headless = true;
        else if (strcmp(option, "--sea") == 0)
            world.at_sea = true;
        else if (strcmp(option, "--terrain") == 0)
            world.terrain = argv[++i];
        else if (strcmp(option, "--gallery") == 0)
            gallery = true;
        else if (gallery && option[0] != '-')
            names[name_count++] = argv[i];
        else
            return command_line_unknown(NAME, option);
        if (!ok)
            return 2;
    }
    if (width == 0)
        width = headless && !gallery ? 640 : 1280, height = headless && !gallery ? 360 : 720;
    if (gallery && !gallery_has(names, name_count))
        return 2;
    if (gallery)
        return gallery_run(data, out, width, height, names, name_count);
    if (world.at_sea && world.terrain) {
        fprintf(stderr, "%s: --terrain is not drawn with --sea\n", NAME);
        return 2;
    }
    char *planet = planet_file ? text_of(planet_file) : NULL;
    if (planet_file && !planet)
        return 1;
    world.planet = planet;
    int code = headless ? contact_run(data, &world, out, width, height, report)
                        : window_run(data, &world, width, height, frames, report);
    free(planet);
    return code;
}
