/* A host without a window, in scene luminance; Welkin tone-maps the picture. Semaphores order host and Welkin, as they
 * would on two queues. */
#include "runs.h"
#include "weather.h"
#include "world.h"

#include <math.h>

enum { WIDTH = 640, HEIGHT = 360 };

static const double GROUND_LUX = 60e3, PI = 3.14159265358979;

typedef struct target {
    image color, depth, mask;
    VkRenderPass pass;
    VkFramebuffer framebuffer;
    VkSemaphore drawn, weather; /* signalled by the host for Welkin; by Welkin for the host */
} target;

static const VkImageLayout ATTACHED = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
static const VkImageLayout DEPTH_ATTACHED = VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL;

/* Colour, mask and depth in one pass. Each is stored, and ends in the layout that the host states to Welkin. */
static void open_pass(host *h, target *t)
{
    VkAttachmentDescription attachments[3];
    const image *images[3] = {&t->color, &t->mask, &t->depth};
    const VkImageLayout layouts[3] = {ATTACHED, ATTACHED, DEPTH_ATTACHED};
    for (int i = 0; i < 3; i++) {
        attachments[i] = (VkAttachmentDescription){.format = images[i]->format,
                                                   .samples = VK_SAMPLE_COUNT_1_BIT,
                                                   .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                                   .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                                   .initialLayout = VK_IMAGE_LAYOUT_UNDEFINED,
                                                   .finalLayout = layouts[i]};
    }
    const VkAttachmentReference colors[2] = {{0, ATTACHED}, {1, ATTACHED}}, depth = {2, DEPTH_ATTACHED};
    const VkSubpassDescription subpass = {.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS,
                                          .colorAttachmentCount = 2,
                                          .pColorAttachments = colors,
                                          .pDepthStencilAttachment = &depth};
    /* The previous frame, and Welkin's reads of it, end before this one is drawn. */
    const VkSubpassDependency after = {.srcSubpass = VK_SUBPASS_EXTERNAL,
                                       .srcStageMask = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                                       .dstStageMask = VK_PIPELINE_STAGE_ALL_GRAPHICS_BIT,
                                       .srcAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT,
                                       .dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT};
    const VkRenderPassCreateInfo pass = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
                                         .attachmentCount = 3,
                                         .pAttachments = attachments,
                                         .subpassCount = 1,
                                         .pSubpasses = &subpass,
                                         .dependencyCount = 1,
                                         .pDependencies = &after};
    VK_CHECK(vkCreateRenderPass(h->device, &pass, NULL, &t->pass));
    const VkImageView views[3] = {t->color.view, t->mask.view, t->depth.view};
    const VkFramebufferCreateInfo framebuffer = {.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
                                                 .renderPass = t->pass,
                                                 .attachmentCount = 3,
                                                 .pAttachments = views,
                                                 .width = WIDTH,
                                                 .height = HEIGHT,
                                                 .layers = 1};
    VK_CHECK(vkCreateFramebuffer(h->device, &framebuffer, NULL, &t->framebuffer));
}

static target open_target(host *h)
{
    target t;
    const VkImageUsageFlags color = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT, read = VK_IMAGE_USAGE_SAMPLED_BIT;
    t.color = host_image(h, VK_FORMAT_R16G16B16A16_SFLOAT, WIDTH, HEIGHT, 1, color | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
    t.depth =
        host_image(h, VK_FORMAT_D32_SFLOAT, WIDTH, HEIGHT, 1, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | read);
    t.mask = host_image(h, VK_FORMAT_R8_UNORM, WIDTH, HEIGHT, 1, color | read);
    open_pass(h, &t);
    const VkSemaphoreCreateInfo semaphore = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    VK_CHECK(vkCreateSemaphore(h->device, &semaphore, NULL, &t.drawn));
    VK_CHECK(vkCreateSemaphore(h->device, &semaphore, NULL, &t.weather));
    return t;
}

static void close_target(host *h, target *t)
{
    vkDestroyFramebuffer(h->device, t->framebuffer, NULL);
    vkDestroyRenderPass(h->device, t->pass, NULL);
    host_close_image(h, &t->color);
    host_close_image(h, &t->depth);
    host_close_image(h, &t->mask);
    vkDestroySemaphore(h->device, t->drawn, NULL);
    vkDestroySemaphore(h->device, t->weather, NULL);
}

static void draw_world(host *h, const target *t, const world *w, VkSemaphore signal)
{
    VkCommandBuffer commands = host_begin(h);
    const VkClearValue clear[3] = {0}; /* colour, mask, and depth 0: infinitely far away, as depth is reversed */
    const VkRenderPassBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
                                         .renderPass = t->pass,
                                         .framebuffer = t->framebuffer,
                                         .renderArea = {{0, 0}, {WIDTH, HEIGHT}},
                                         .clearValueCount = 3,
                                         .pClearValues = clear};
    vkCmdBeginRenderPass(commands, &begin, VK_SUBPASS_CONTENTS_INLINE);
    world_draw(w, commands);
    vkCmdEndRenderPass(commands);
    host_submit(h, commands, VK_NULL_HANDLE, signal, false);
}

static float half_value(uint16_t h)
{
    const int exponent = (h >> 10) & 31, fraction = h & 1023;
    const double magnitude = exponent == 0    ? ldexp(fraction, -24)
                             : exponent == 31 ? (fraction ? NAN : INFINITY)
                                              : ldexp(1024 + fraction, exponent - 25);
    return (float)(h & 0x8000 ? -magnitude : magnitude);
}

/* Reads the picture after `wait`: RGB. The caller frees it. */
static float *read_picture(host *h, const target *t, VkSemaphore wait)
{
    uint16_t *halves = host_read(h, &t->color, 8, wait);
    float *rgb = malloc(3 * WIDTH * HEIGHT * sizeof *rgb);
    EXPECT(halves && rgb, "out of memory");
    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++) rgb[i] = half_value(halves[4 * (i / 3) + i % 3]);
    free(halves);
    return rgb;
}

int run_offscreen(const char *picture)
{
    const world w = {.width = WIDTH, .height = HEIGHT, .white = GROUND_LUX / PI, .masked = true};
    host h;
    host_open_instance(&h, false);
    host_open_device(&h, VK_NULL_HANDLE);
    target t = open_target(&h);
    weather welkin = weather_open(&h);
    /* Colour comes back ready for copying. */
    const handover over = {.color = {&t.color, ATTACHED, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL},
                           .depth = {&t.depth, DEPTH_ATTACHED, DEPTH_ATTACHED},
                           .mask = {&t.mask, ATTACHED, ATTACHED},
                           .color_space = WK_COLOR_SCENE_LINEAR,
                           .wait = t.drawn,
                           .signal = t.weather};
    float *rgb = NULL;
    for (uint64_t frame_id = 0; frame_id < 3; frame_id++) {
        free(rgb);
        draw_world(&h, &t, &w, t.drawn);
        weather_draw(&welkin, &over, frame_id, (double)frame_id / 60.0);
        rgb = read_picture(&h, &t, t.weather);
    }
    world_check(&w, rgb);
    if (picture) world_write(&w, rgb, picture);
    free(rgb);
    weather_close(&welkin);

    /* Welkin is gone; all of the host's objects are still there and work. */
    draw_world(&h, &t, &w, VK_NULL_HANDLE);
    VkCommandBuffer commands = host_begin(&h);
    host_transition(commands, &t.color, ATTACHED, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    host_submit(&h, commands, VK_NULL_HANDLE, VK_NULL_HANDLE, true);
    rgb = read_picture(&h, &t, VK_NULL_HANDLE);
    EXPECT(rgb[3 * (10 * WIDTH + 320)] == 0.0f && rgb[3 * (2 * WIDTH + 2) + 1] == 0.5f, "the host's own picture");
    free(rgb);
    host_wait(&h);
    close_target(&h, &t);
    host_close_device(&h);
    host_close_instance(&h);
    return h.complaints;
}
