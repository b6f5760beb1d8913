/* A host that draws with its own Vulkan device: a plain with dark boards from 100 m to 20 km away, and a HUD. Welkin
 * draws the weather into its image, and the host looks at the pixels.
 *
 *     vulkan_host [PICTURE.ppm]
 *
 * The scene needs no shaders: every row of the ground and every board is a cleared rectangle of the colour and depth
 * that a rasteriser would give it. */
#include "host.h"
#include "welkin.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 640, HEIGHT = 360, BOARDS = 6, HUD = 24 };

static const double NEAR_M = 0.1, EYE_M = 2.0, FOCAL = 1.7320508; /* 60 degrees from top to bottom */
static const double BOARD_M[BOARDS] = {100.0, 500.0, 1e3, 2e3, 5e3, 20e3};
static const double VISIBILITY_M = 5e3;
static const double GROUND_LUX = 60e3, PI = 3.14159265358979;

/* Welkin says what is wrong in words. */
#define WK_CHECK(call)                                                                                   \
    do {                                                                                                 \
        wk_status status_ = (call);                                                                      \
        if (status_ < 0) {                                                                               \
            fprintf(stderr, "%s: %s: %s\n", #call, wk_status_name(status_), wk_last_error_message());   \
            exit(1);                                                                                     \
        }                                                                                                \
    } while (0)

#define EXPECT(condition, ...)                                           \
    do {                                                                 \
        if (!(condition)) {                                              \
            fprintf(stderr, "%s:%d: %s: ", __FILE__, __LINE__, #condition); \
            fprintf(stderr, __VA_ARGS__);                                \
            fputc('\n', stderr);                                         \
            exit(1);                                                     \
        }                                                                \
    } while (0)

/* ---- the host's picture ---- */

/* Luminance of a matt surface, cd/m^2. */
static VkClearValue matt(double r, double g, double b)
{
    const double lit = GROUND_LUX / PI;
    return (VkClearValue){.color = {.float32 = {(float)(r * lit), (float)(g * lit), (float)(b * lit), 1.0f}}};
}

static void fill(VkCommandBuffer commands, VkRect2D rect, VkClearValue color, double depth, float mask)
{
    const VkClearRect where = {.rect = rect, .layerCount = 1};
    const VkClearAttachment what[3] = {
        {VK_IMAGE_ASPECT_COLOR_BIT, 0, color},
        {VK_IMAGE_ASPECT_COLOR_BIT, 1, {.color = {.float32 = {mask, mask, mask, mask}}}},
        {VK_IMAGE_ASPECT_DEPTH_BIT, 0, {.depthStencil = {.depth = (float)depth}}},
    };
    vkCmdClearAttachments(commands, 3, what, 1, &where);
}

/* The rectangle in which board `i` is seen. */
static VkRect2D board(int i)
{
    const int pitch = WIDTH / BOARDS;
    return (VkRect2D){{i * pitch + pitch / 4, HEIGHT / 2 - 40}, {(uint32_t)(pitch / 2), 40}};
}

static void draw_world(host *h, VkSemaphore signal)
{
    VkCommandBuffer commands = host_begin(h);
    VkClearValue clear[3];
    memset(clear, 0, sizeof clear); /* colour, mask, and depth 0: infinitely far, as depth is reversed */
    const VkRenderPassBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
                                         .renderPass = h->render_pass,
                                         .framebuffer = h->framebuffer,
                                         .renderArea = {{0, 0}, {WIDTH, HEIGHT}},
                                         .clearValueCount = 3,
                                         .pClearValues = clear};
    vkCmdBeginRenderPass(commands, &begin, VK_SUBPASS_CONTENTS_INLINE);
    for (int y = HEIGHT / 2; y < HEIGHT; y++) {
        const double down = (2.0 * (y + 0.5) / HEIGHT - 1.0) / FOCAL; /* tangent of the angle below the horizon */
        fill(commands, (VkRect2D){{0, y}, {WIDTH, 1}}, matt(0.12, 0.14, 0.06), NEAR_M * down / EYE_M, 0.0f);
    }
    for (int i = 0; i < BOARDS; i++) fill(commands, board(i), matt(0.02, 0.02, 0.02), NEAR_M / BOARD_M[i], 0.0f);
    /* The HUD: its pixels are masked and stay as they are. */
    fill(commands, (VkRect2D){{0, 0}, {HUD, HUD}}, (VkClearValue){.color = {.float32 = {0.25f, 0.5f, 1.0f, 1.0f}}}, 1.0,
         1.0f);
    vkCmdEndRenderPass(commands);
    host_submit(h, commands, VK_NULL_HANDLE, signal, false);
}

/* ---- Welkin ---- */

static wk_device *open_welkin(host *h)
{
    VkDeviceQueueCreateInfo queue;
    VkDeviceCreateInfo info;
    host_device_info(&info, &queue, h->queue_family);
    wk_vulkan_host_desc desc = WK_VULKAN_HOST_DESC_INIT;
    desc.get_instance_proc_addr = (wk_vulkan_get_proc_fn)vkGetInstanceProcAddr;
    desc.instance = h->instance;
    desc.instance_api_version = HOST_API_VERSION;
    desc.physical_device = h->physical_device;
    desc.device = h->device;
    desc.queue_family_index = h->queue_family;
    desc.enabled_features = &info;
    wk_device *device = NULL;
    WK_CHECK(wk_device_create_vulkan(&desc, &device));
    wk_device *second = NULL;
    EXPECT(wk_device_create_vulkan(&desc, &second) == WK_ERROR_ALREADY_WRAPPED && !second, "one device a queue");
    return device;
}

static wk_vulkan_image lend(const image *i, VkImageLayout layout, VkImageLayout final_layout)
{
    wk_vulkan_image lent = WK_VULKAN_IMAGE_INIT;
    lent.image = (uint64_t)i->handle;
    lent.format = (uint32_t)i->format;
    lent.width = WIDTH;
    lent.height = HEIGHT;
    lent.usage = i->usage;
    lent.layout = (uint32_t)layout;
    lent.final_layout = (uint32_t)final_layout;
    return lent;
}

static wk_vulkan_semaphore binary(VkSemaphore handle)
{
    wk_vulkan_semaphore s = WK_VULKAN_SEMAPHORE_INIT;
    s.semaphore = (uint64_t)handle;
    return s;
}

/* Takes the images over after `drawn`, gives the colour back ready to be copied, signals `weather`. */
static void draw_weather(host *h, wk_view *view, uint64_t frame_id)
{
    const VkImageLayout attached = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    const VkImageLayout depth_layout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL;
    const wk_vulkan_image color = lend(&h->color, attached, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    const wk_vulkan_image depth = lend(&h->depth, depth_layout, depth_layout);
    const wk_vulkan_image mask = lend(&h->mask, attached, attached);
    const wk_vulkan_semaphore waits[1] = {binary(h->drawn)}, signals[1] = {binary(h->weather)};
    wk_vulkan_target target = WK_VULKAN_TARGET_INIT;
    target.color = &color;
    target.depth = &depth;
    target.mask = &mask;
    target.waits = waits;
    target.wait_count = 1;
    target.signals = signals;
    target.signal_count = 1;

    wk_frame frame = WK_FRAME_INIT;
    frame.frame_id = frame_id;
    frame.target = &target;
    frame.flags = WK_FRAME_DEPTH_REVERSED;
    frame.position_m[2] = EYE_M;
    /* Looking north: eye x is east, eye y is up, eye z is south. Column by column. */
    const double view_matrix[16] = {1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1};
    memcpy(frame.view, view_matrix, sizeof view_matrix);
    /* Perspective with depth NEAR_M / distance, and the first row on top. */
    const double projection[16] = {FOCAL * HEIGHT / WIDTH, 0, 0, 0, 0, FOCAL, 0, 0, 0, 0, 0, -1, 0, 0, NEAR_M, 0};
    memcpy(frame.projection, projection, sizeof projection);
    WK_CHECK(wk_view_record(view, &frame, WK_STAGE_ALL));
}

/* ---- looking at the result ---- */

static double half_value(uint16_t h)
{
    const int exponent = (h >> 10) & 31, fraction = h & 1023;
    const double magnitude = exponent == 0    ? ldexp(fraction, -24)
                             : exponent == 31 ? (fraction ? NAN : INFINITY)
                                              : ldexp(1024 + fraction, exponent - 25);
    return h & 0x8000 ? -magnitude : magnitude;
}

static double channel(const uint16_t *pixels, int x, int y, int c) { return half_value(pixels[4 * (y * WIDTH + x) + c]); }

static double luminance(const uint16_t *pixels, int x, int y)
{
    return 0.2126 * channel(pixels, x, y, 0) + 0.7152 * channel(pixels, x, y, 1) + 0.0722 * channel(pixels, x, y, 2);
}

static void check_pixels(const uint16_t *pixels)
{
    for (int i = 0; i < WIDTH * HEIGHT * 4; i++) {
        const double v = half_value(pixels[i]);
        EXPECT(v >= 0.0 && v <= 1.0, "channel %d of pixel %d is %g, not a display value", i % 4, i / 4, v);
    }
    EXPECT(channel(pixels, 320, 10, 2) > channel(pixels, 320, 10, 0), "the sky overhead is blue");
    /* Air light: the farther a dark board, the more it takes on the brightness of the sky at the horizon. */
    double nearer = 0.0;
    for (int i = 0; i < BOARDS; i++) {
        const VkRect2D r = board(i);
        const int x = r.offset.x + (int)r.extent.width / 2, y = r.offset.y + 35;
        const double seen = luminance(pixels, x, y), sky = luminance(pixels, r.offset.x - 8, y);
        printf("board at %6.0f m: %.4f of the sky's %.4f\n", BOARD_M[i], seen / sky, sky);
        EXPECT(seen > nearer && seen < 1.04 * sky, "board %d", i); /* far enough away it is the sky, to the tables' error in haze */
        nearer = seen;
    }
    for (int y = 0; y < HUD; y++) {
        for (int x = 0; x < HUD; x++) {
            const bool same = channel(pixels, x, y, 0) == 0.25 && channel(pixels, x, y, 1) == 0.5 &&
                              channel(pixels, x, y, 2) == 1.0;
            EXPECT(same, "HUD pixel %d, %d was touched", x, y);
        }
    }
}

/* Display-linear half floats as an 8-bit sRGB picture (IEC 61966-2-1). */
static void write_picture(const char *path, const uint16_t *pixels)
{
    FILE *f = fopen(path, "wb");
    EXPECT(f, "cannot write %s", path);
    fprintf(f, "P6\n%d %d\n255\n", WIDTH, HEIGHT);
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        for (int c = 0; c < 3; c++) {
            const double v = half_value(pixels[4 * i + c]);
            fputc((int)(255.0 * (v <= 0.0031308 ? 12.92 * v : 1.055 * pow(v, 1 / 2.4) - 0.055) + 0.5), f);
        }
    }
    EXPECT(fclose(f) == 0, "cannot write %s", path);
}

int main(int argc, char **argv)
{
    host h;
    host_open(&h, WIDTH, HEIGHT);
    wk_device *device = open_welkin(&h);
    wk_caps caps = WK_CAPS_INIT;
    WK_CHECK(wk_device_get_caps(device, &caps));
    printf("%s (%s), tier %u\n", caps.adapter_name, caps.driver, caps.tier);
    wk_context *context = NULL;
    wk_view *view = NULL;
    WK_CHECK(wk_context_create(device, NULL, &context));
    wk_given_direction sun = WK_GIVEN_DIRECTION_INIT;
    sun.azimuth_deg = 140.0;
    sun.elevation_deg = 40.0;
    WK_CHECK(wk_context_set_sun(context, &sun));
    wk_weather weather = WK_WEATHER_INIT;
    weather.visibility_m = VISIBILITY_M;
    WK_CHECK(wk_context_set_weather(context, &weather, 0.0, 0.0));
    WK_CHECK(wk_view_create(context, NULL, &view));

    uint16_t *pixels = NULL;
    for (uint64_t frame_id = 0; frame_id < 3; frame_id++) {
        free(pixels);
        WK_CHECK(wk_context_update(context, (double)frame_id / 60.0));
        draw_world(&h, h.drawn);
        draw_weather(&h, view, frame_id);
        pixels = host_read(&h, &h.color, 8, h.weather);
        EXPECT(pixels, "out of memory");
    }
    check_pixels(pixels);
    if (argc > 1) write_picture(argv[1], pixels);
    free(pixels);

    WK_CHECK(wk_view_destroy(view));
    WK_CHECK(wk_context_destroy(context));
    WK_CHECK(wk_device_destroy(device));

    /* Welkin is gone; everything of the host's is still there and works. */
    draw_world(&h, VK_NULL_HANDLE);
    VkCommandBuffer commands = host_begin(&h);
    host_transition(commands, &h.color, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    host_submit(&h, commands, VK_NULL_HANDLE, VK_NULL_HANDLE, true);
    pixels = host_read(&h, &h.color, 8, VK_NULL_HANDLE);
    EXPECT(pixels && channel(pixels, 320, 10, 0) == 0.0 && channel(pixels, 2, 2, 1) == 0.5, "the host's own picture");
    free(pixels);
    host_close(&h);
    EXPECT(h.complaints == 0, "%d complaints of the validation layer", h.complaints);
    printf("ok\n");
    return 0;
}
