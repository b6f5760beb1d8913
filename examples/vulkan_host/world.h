/* The host's world: a plain with dark boards 100 m to 20 km away, drawn without shaders. Each row of the ground and
 * each board is a rectangle, cleared to the colour and depth that a rasteriser would give it. */
#ifndef VULKAN_HOST_WORLD_H
#define VULKAN_HOST_WORLD_H

#include "host.h"

enum { BOARDS = 6, HUD = 24 };

static const double NEAR_M = 0.1, EYE_M = 2.0, FOCAL = 1.7320508; /* vertical field of view 60 degrees */

typedef struct world {
    uint32_t width, height;
    /* Picture value of a surface that reflects all light: luminance in cd/m^2, or a display value. */
    double white;
    /* Attachment 1 is a mask with the value 1 in the HUD's pixels. If set, the HUD is drawn. */
    bool masked;
} world;

/* Call it inside a render pass whose attachment 0 is the colour. Sky and mask are cleared to 0, depth to 0 (reversed:
 * far). */
void world_draw(const world *w, VkCommandBuffer commands);
/* Checks a picture with weather in it: linear RGB display values. */
void world_check(const world *w, const float *rgb);
/* Writes the picture as an 8-bit sRGB PPM. */
void world_write(const world *w, const float *rgb, const char *path);

#endif
