#include "target.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "gl_target.h"
#include "scenes.h"

struct target {
    wk_device *device;
    gl_target *gl; /* NULL: an own device, with the following textures */
    wk_texture *color, *depth, *classes;
    wk_own_target own;
    wk_opengl_target host;
    uint16_t halves[4 * PIXELS];
};

static bool open_own(target *t, wk_backend_flags backend)
{
    wk_device_desc desc = WK_DEVICE_DESC_INIT;
    wk_texture_desc color = WK_TEXTURE_DESC_INIT, depth, classes;
    desc.backends = backend;
    color.width = WIDTH;
    color.height = HEIGHT;
    depth = classes = color;
    color.format = WK_FORMAT_RGBA16_FLOAT;
    depth.format = WK_FORMAT_R32_FLOAT;
    classes.format = WK_FORMAT_R8_UNORM;
    t->own = (wk_own_target)WK_OWN_TARGET_INIT;
    if (!passed(wk_device_create(&desc, &t->device)) || !passed(wk_texture_create(t->device, &color, &t->color)) ||
        !passed(wk_texture_create(t->device, &depth, &t->depth)) ||
        !passed(wk_texture_create(t->device, &classes, &t->classes)))
        return false;
    t->own.color = t->color;
    t->own.depth = t->depth;
    t->own.surface_classes = t->classes;
    return true;
}

static bool open_host(target *t, const char *way)
{
    wk_opengl_host_desc desc = WK_OPENGL_HOST_DESC_INIT;
    wk_opengl_image image = WK_OPENGL_IMAGE_INIT;
    t->gl = gl_target_open(way, WIDTH, HEIGHT);
    if (!t->gl)
        return false;
    desc.get_proc = gl_target_proc;
    desc.user = t->gl;
    desc.mode = WK_OPENGL_HOST_CONTEXT;
    if (!passed(wk_device_create_opengl(&desc, &t->device)))
        return false;
    t->host = (wk_opengl_target)WK_OPENGL_TARGET_INIT;
    t->host.width = WIDTH;
    t->host.height = HEIGHT;
    image.kind = WK_OPENGL_TEXTURE;
    t->host.color = t->host.depth = t->host.surface_classes = image;
    t->host.color.name = gl_target_color(t->gl);
    t->host.depth.name = gl_target_depth(t->gl);
    t->host.surface_classes.name = gl_target_classes(t->gl);
    return true;
}

target *target_open(const char *way)
{
    target *t = calloc(1, sizeof *t);
    bool opened;
    if (!t)
        return NULL;
    if (strcmp(way, "vulkan") == 0)
        opened = open_own(t, WK_BACKEND_VULKAN);
    else if (strcmp(way, "gl") == 0)
        opened = open_own(t, WK_BACKEND_GL);
    else
        opened = open_host(t, way);
    if (opened)
        return t;
    target_close(t);
    return NULL;
}

void target_close(target *t)
{
    wk_texture *all[3];
    int i;
    if (!t)
        return;
    all[0] = t->color, all[1] = t->depth, all[2] = t->classes;
    for (i = 0; i < 3; i++)
        if (all[i])
            passed(wk_texture_destroy(all[i]));
    if (t->device)
        passed(wk_device_destroy(t->device));
    gl_target_close(t->gl);
    free(t);
}

wk_device *target_device(target *t) { return t->device; }

bool target_upside_down(const target *t) { return t->gl != NULL; }

/* A half float, rounded towards zero; the host's values are numbers from 0 to 65504. */
static uint16_t half_of(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    const int32_t exponent = (int32_t)(bits >> 23) - 127 + 15;
    return exponent <= 0 ? 0 : (uint16_t)((uint32_t)exponent << 10 | (bits >> 13 & 0x3ff));
}

static float float_of(uint16_t half)
{
    const int exponent = half >> 10 & 31, mantissa = half & 0x3ff;
    const double sign = half & 0x8000 ? -1.0 : 1.0;
    if (exponent == 31)
        return mantissa ? NAN : (float)(sign * INFINITY);
    return (float)(sign * (exponent ? ldexp(1024 + mantissa, exponent - 25) : ldexp(mantissa, -24)));
}

bool target_write(target *t, const float *color, const float *depth, const unsigned char *classes)
{
    int i;
    if (t->gl)
        return gl_target_write(t->gl, color, depth, classes);
    for (i = 0; i < 4 * PIXELS; i++)
        t->halves[i] = half_of(color[i]);
    return passed(wk_texture_write(t->color, t->halves, sizeof t->halves, WIDTH * 8)) &&
           passed(wk_texture_write(t->depth, depth, PIXELS * 4, WIDTH * 4)) &&
           passed(wk_texture_write(t->classes, classes, PIXELS, WIDTH));
}

const void *target_images(target *t) { return t->gl ? (const void *)&t->host : (const void *)&t->own; }

bool target_read(target *t, float *color)
{
    int i;
    if (t->gl)
        return gl_target_read(t->gl, color);
    if (!passed(wk_texture_read(t->color, t->halves, sizeof t->halves, WIDTH * 8)))
        return false;
    for (i = 0; i < 4 * PIXELS; i++)
        color[i] = float_of(t->halves[i]);
    return true;
}
