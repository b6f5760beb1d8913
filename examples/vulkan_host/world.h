/* The host's world: a plain with dark boards from 100 m to 20 km away, drawn without shaders: every row of the ground
 * and every board is a cleared rectangle of the colour and depth that a rasteriser would give it. */
#ifndef VULKAN_HOST_WORLD_H
#define VULKAN_HOST_WORLD_H

#include "host.h"

enum { BOARDS = 6, HUD = 24 };

static const double NEAR_M = 0.1, EYE_M = 2.0, FOCAL = 1.7320508; /* 60 degrees from top to bottom */

typedef struct world {
    uint32_t width, height;
    /* What reflects all light has this value: luminance in cd/m^2, or a display value. */
    double white;
    /* Attachment 1 is a mask: 1 in the HUD's pixels, which then is drawn too. */
    bool masked;
} world;

/* Inside a render pass whose attachment 0 is the colour; sky and masks are cleared to 0, depth to 0 (reversed: far). */
void world_draw(const world *w, VkCommandBuffer commands);
/* Looks at a picture with weather over it: linear RGB display values. */
void world_check(const world *w, const float *rgb);
/* Writes it as an 8-bit sRGB PPM. */
void world_write(const world *w, const float *rgb, const char *path);

#endif
