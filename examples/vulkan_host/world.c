#include "world.h"

#include <math.h>

#include "../command_line.h"

static const double BOARD_M[BOARDS] = {100.0, 500.0, 1e3, 2e3, 5e3, 20e3};

/* Colour of a matt surface. */
static VkClearValue matt(const world *w, double r, double g, double b)
{
    return (VkClearValue){.color = {.float32 = {(float)(r * w->white), (float)(g * w->white), (float)(b * w->white), 1.0f}}};
}

static void fill(const world *w, VkCommandBuffer commands, VkRect2D rect, VkClearValue color, double depth, float mask)
{
    const VkClearRect where = {.rect = rect, .layerCount = 1};
    const VkClearAttachment what[3] = {
        {VK_IMAGE_ASPECT_COLOR_BIT, 0, color},
        {VK_IMAGE_ASPECT_DEPTH_BIT, 0, {.depthStencil = {.depth = (float)depth}}},
        {VK_IMAGE_ASPECT_COLOR_BIT, 1, {.color = {.float32 = {mask, mask, mask, mask}}}},
    };
    vkCmdClearAttachments(commands, w->masked ? 3 : 2, what, 1, &where);
}

/* Returns the rectangle that board `i` covers in the picture. */
static VkRect2D board(const world *w, int i)
{
    const uint32_t pitch = w->width / BOARDS, high = w->height / 9;
    return (VkRect2D){{i * (int)pitch + (int)pitch / 4, (int)(w->height / 2 - high)}, {pitch / 2, high}};
}

void world_draw(const world *w, VkCommandBuffer commands)
{
    for (uint32_t y = w->height / 2; y < w->height; y++) {
        const double down = (2.0 * (y + 0.5) / w->height - 1.0) / FOCAL; /* tangent of the angle below the horizon */
        const VkRect2D row = {{0, (int)y}, {w->width, 1}};
        fill(w, commands, row, matt(w, 0.12, 0.14, 0.06), NEAR_M * down / EYE_M, 0.0f);
    }
    for (int i = 0; i < BOARDS; i++) {
        fill(w, commands, board(w, i), matt(w, 0.02, 0.02, 0.02), NEAR_M / BOARD_M[i], 0.0f);
    }
    if (w->masked) { /* the HUD: Welkin leaves its pixels as they are */
        const VkClearValue color = {.color = {.float32 = {0.25f, 0.5f, 1.0f, 1.0f}}};
        fill(w, commands, (VkRect2D){{0, 0}, {HUD, HUD}}, color, 1.0, 1.0f);
    }
}

static const float *pixel(const world *w, const float *rgb, uint32_t x, uint32_t y) { return rgb + 3 * (y * w->width + x); }

static double luminance(const float *p) { return 0.2126 * p[0] + 0.7152 * p[1] + 0.0722 * p[2]; }

void world_check(const world *w, const float *rgb)
{
    for (uint32_t i = 0; i < 3 * w->width * w->height; i++) {
        EXPECT(rgb[i] >= 0.0f && rgb[i] <= 1.0f, "channel %u of pixel %u is %g, no display value", i % 3, i / 3, rgb[i]);
    }
    const float *top = pixel(w, rgb, w->width / 2, w->height / 36);
    EXPECT(top[2] > top[0], "the sky overhead is blue");
    /* Air light: the farther away a dark board is, the closer its brightness gets to the sky's at the horizon. */
    double nearer = 0.0;
    for (int i = 0; i < BOARDS; i++) {
        const VkRect2D r = board(w, i);
        const uint32_t x = (uint32_t)r.offset.x + r.extent.width / 2, y = (uint32_t)r.offset.y + r.extent.height - 5;
        const double sky = luminance(pixel(w, rgb, (uint32_t)r.offset.x - w->width / 80, y));
        const double seen = luminance(pixel(w, rgb, x, y));
        printf("board at %6.0f m: %.4f of the sky's %.4f\n", BOARD_M[i], seen / sky, sky);
        EXPECT(seen > nearer && seen < 1.04 * sky, "board %d", i); /* far away it is sky, within the tables' error */
        nearer = seen;
    }
    for (uint32_t y = 0; w->masked && y < HUD; y++) {
        for (uint32_t x = 0; x < HUD; x++) {
            const float *p = pixel(w, rgb, x, y);
            EXPECT(p[0] == 0.25f && p[1] == 0.5f && p[2] == 1.0f, "HUD pixel %u, %u was touched", x, y);
        }
    }
}

void world_write(const world *w, const float *rgb, const char *path)
{
    FILE *f = fopen(part_begin(path), "wb");
    EXPECT(f, "cannot write %s", path);
    fprintf(f, "P6\n%u %u\n255\n", w->width, w->height);
    for (uint32_t i = 0; i < 3 * w->width * w->height; i++) { /* IEC 61966-2-1 */
        const double v = rgb[i];
        fputc((int)(255.0 * (v <= 0.0031308 ? 12.92 * v : 1.055 * pow(v, 1 / 2.4) - 0.055) + 0.5), f);
    }
    const bool complete = fclose(f) == 0;
    EXPECT(part_end(path, complete), "cannot write %s", path);
}
