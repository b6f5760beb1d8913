/* A small windowed engine: a swapchain, two frames in flight, a thread that uploads on the same queue, resizing. With
 * one sample, Welkin draws into the swapchain's images. With several, it draws into the host's image, which the host
 * then resolves. Colours are display values. */
#include "runs.h"
#include "native.h"
#include "weather.h"
#include "world.h"

#include <math.h>
#include <stdatomic.h>
#include <string.h>

enum { IN_FLIGHT = 2, MAX_IMAGES = 8 };

typedef struct in_flight {
    VkCommandBuffer world, resolve;
    VkSemaphore acquired;
    VkFence done; /* signalled by the host's last submission of the frame */
} in_flight;

typedef struct window {
    native native;
    uint32_t samples;
    VkSurfaceKHR surface;
    VkSurfaceFormatKHR format;
    VkRenderPass pass;
    VkCommandPool pool;
    in_flight frames[IN_FLIGHT];
    uint64_t frame_id;
    /* Created again for each size. */
    VkSwapchainKHR swapchain;
    uint32_t count;
    image shown[MAX_IMAGES]; /* the swapchain's images */
    image color, depth;      /* colour is used only with several samples */
    VkFramebuffer framebuffers[MAX_IMAGES];
    VkSemaphore weather[MAX_IMAGES]; /* signalled when the image may be presented: by Welkin or by the resolve */
    world world;
} window;

static const VkImageLayout ATTACHED = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
static const VkImageLayout DEPTH_READ = VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL;

/* ---- what lasts as long as the window ---- */

/* Picks an 8-bit sRGB format, so that the host's colours are blended linearly. Without one, the program ends. */
static VkSurfaceFormatKHR choose_format(host *h, VkSurfaceKHR surface)
{
    VkSurfaceFormatKHR formats[32];
    uint32_t count = 32;
    EXPECT(vkGetPhysicalDeviceSurfaceFormatsKHR(h->physical_device, surface, &count, formats) >= 0, "no formats");
    const VkFormat wanted[] = {VK_FORMAT_B8G8R8A8_SRGB, VK_FORMAT_R8G8B8A8_SRGB};
    for (size_t f = 0; f < sizeof wanted / sizeof *wanted; f++) {
        for (uint32_t i = 0; i < count; i++) {
            if (formats[i].format == wanted[f]) return formats[i];
        }
    }
    EXPECT(false, "no 8-bit sRGB format to present");
    return formats[0];
}

static VkAttachmentDescription attachment(const window *w, VkFormat format, VkImageLayout layout)
{
    return (VkAttachmentDescription){.format = format,
                                     .samples = (VkSampleCountFlagBits)w->samples,
                                     .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                     .storeOp = VK_ATTACHMENT_STORE_OP_STORE, /* for depth as well: Welkin reads it */
                                     .initialLayout = VK_IMAGE_LAYOUT_UNDEFINED,
                                     .finalLayout = layout};
}

static void open_pass(host *h, window *w)
{
    const VkAttachmentDescription attachments[2] = {attachment(w, w->format.format, ATTACHED),
                                                    attachment(w, VK_FORMAT_D32_SFLOAT, DEPTH_READ)};
    const VkAttachmentReference color = {0, ATTACHED}, depth = {1, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
    const VkSubpassDescription subpass = {.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS,
                                          .colorAttachmentCount = 1,
                                          .pColorAttachments = &color,
                                          .pDepthStencilAttachment = &depth};
    /* All frames in flight share one depth image, so the reads of the previous frame must end before it is cleared. */
    const VkSubpassDependency after = {.srcSubpass = VK_SUBPASS_EXTERNAL,
                                       .srcStageMask = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                                       .dstStageMask = VK_PIPELINE_STAGE_ALL_GRAPHICS_BIT,
                                       .srcAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT,
                                       .dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT};
    const VkRenderPassCreateInfo pass = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
                                         .attachmentCount = 2,
                                         .pAttachments = attachments,
                                         .subpassCount = 1,
                                         .pSubpasses = &subpass,
                                         .dependencyCount = 1,
                                         .pDependencies = &after};
    VK_CHECK(vkCreateRenderPass(h->device, &pass, NULL, &w->pass));
}

static void open_frames(host *h, window *w)
{
    const VkCommandPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                          .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                          .queueFamilyIndex = h->queue_family};
    VK_CHECK(vkCreateCommandPool(h->device, &pool, NULL, &w->pool));
    const VkCommandBufferAllocateInfo commands = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, .commandPool = w->pool, .commandBufferCount = 1};
    const VkSemaphoreCreateInfo semaphore = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    const VkFenceCreateInfo fence = {.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO, .flags = VK_FENCE_CREATE_SIGNALED_BIT};
    for (int i = 0; i < IN_FLIGHT; i++) {
        VK_CHECK(vkAllocateCommandBuffers(h->device, &commands, &w->frames[i].world));
        VK_CHECK(vkAllocateCommandBuffers(h->device, &commands, &w->frames[i].resolve));
        VK_CHECK(vkCreateSemaphore(h->device, &semaphore, NULL, &w->frames[i].acquired));
        VK_CHECK(vkCreateFence(h->device, &fence, NULL, &w->frames[i].done));
    }
}

/* ---- what is created for each size ---- */

static void open_images(host *h, window *w, VkSwapchainKHR old)
{
    VkSurfaceCapabilitiesKHR can;
    VK_CHECK(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(h->physical_device, w->surface, &can));
    const VkExtent2D size = can.currentExtent;
    const VkImageUsageFlags color = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT, copied = VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    /* Welkin copies the colour image that it draws into, which needs TRANSFER_SRC. A swapchain has it only on
     * request. */
    const VkImageUsageFlags usage = color | copied | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    EXPECT((can.supportedUsageFlags & usage) == usage, "draw into an image of your own and blit it to this swapchain");
    uint32_t count = can.minImageCount > 3 ? can.minImageCount : 3;
    if (can.maxImageCount && count > can.maxImageCount) count = can.maxImageCount;
    const VkSwapchainCreateInfoKHR info = {.sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR,
                                           .surface = w->surface,
                                           .minImageCount = count,
                                           .imageFormat = w->format.format,
                                           .imageColorSpace = w->format.colorSpace,
                                           .imageExtent = size,
                                           .imageArrayLayers = 1,
                                           .imageUsage = usage,
                                           .preTransform = can.currentTransform,
                                           .compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR,
                                           .presentMode = VK_PRESENT_MODE_FIFO_KHR,
                                           .clipped = VK_TRUE,
                                           .oldSwapchain = old};
    VK_CHECK(vkCreateSwapchainKHR(h->device, &info, NULL, &w->swapchain));
    w->count = MAX_IMAGES;
    VkImage images[MAX_IMAGES];
    EXPECT(vkGetSwapchainImagesKHR(h->device, w->swapchain, &w->count, images) == VK_SUCCESS, "more images than expected");
    w->depth = host_image(h, VK_FORMAT_D32_SFLOAT, size.width, size.height, w->samples,
                          VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT);
    if (w->samples > 1) {
        w->color = host_image(h, w->format.format, size.width, size.height, w->samples, color | copied);
    }
    const VkSemaphoreCreateInfo semaphore = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    for (uint32_t i = 0; i < w->count; i++) {
        w->shown[i] = (image){.handle = images[i],
                              .format = w->format.format,
                              .usage = usage,
                              .width = size.width,
                              .height = size.height,
                              .samples = 1};
        w->shown[i].view = host_view(h, &w->shown[i]);
        const VkImageView views[2] = {w->samples > 1 ? w->color.view : w->shown[i].view, w->depth.view};
        const VkFramebufferCreateInfo framebuffer = {.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
                                                     .renderPass = w->pass,
                                                     .attachmentCount = 2,
                                                     .pAttachments = views,
                                                     .width = size.width,
                                                     .height = size.height,
                                                     .layers = 1};
        VK_CHECK(vkCreateFramebuffer(h->device, &framebuffer, NULL, &w->framebuffers[i]));
        VK_CHECK(vkCreateSemaphore(h->device, &semaphore, NULL, &w->weather[i]));
    }
    w->world = (world){.width = size.width, .height = size.height, .white = 1.5};
}

/* Destroys everything in `w` that depends on the size, the swapchain last. The GPU must have finished with it. */
static void close_images(host *h, const window *w)
{
    for (uint32_t i = 0; i < w->count; i++) {
        vkDestroyFramebuffer(h->device, w->framebuffers[i], NULL);
        vkDestroySemaphore(h->device, w->weather[i], NULL);
        host_close_image(h, &w->shown[i]);
    }
    host_close_image(h, &w->depth);
    if (w->samples > 1) host_close_image(h, &w->color);
    vkDestroySwapchainKHR(h->device, w->swapchain, NULL);
}

static void resize(host *h, window *w, const weather *welkin)
{
    host_wait(h);
    w->native.resized = false;
    const window old = *w;
    open_images(h, w, old.swapchain);
    close_images(h, &old);
    /* Tell Welkin before the first frame on new images, because these may have the old ones' handles. The old images
     * may be destroyed already. */
    for (uint32_t i = 0; i < old.count; i++) weather_forget(welkin, &old.shown[i]);
    weather_forget(welkin, &old.depth);
    if (w->samples > 1) weather_forget(welkin, &old.color);
}

/* ---- a frame ---- */

static void begin(VkCommandBuffer commands)
{
    const VkCommandBufferBeginInfo info = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                           .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    VK_CHECK(vkBeginCommandBuffer(commands, &info));
}

static void submit(host *h, VkCommandBuffer commands, VkSemaphore wait, VkSemaphore signal, VkFence fence)
{
    VK_CHECK(vkEndCommandBuffer(commands));
    const VkPipelineStageFlags all = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
    const VkSubmitInfo info = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                               .waitSemaphoreCount = wait != VK_NULL_HANDLE,
                               .pWaitSemaphores = &wait,
                               .pWaitDstStageMask = &all,
                               .commandBufferCount = 1,
                               .pCommandBuffers = &commands,
                               .signalSemaphoreCount = signal != VK_NULL_HANDLE,
                               .pSignalSemaphores = &signal};
    lock_take(&h->queue_lock);
    VK_CHECK(vkQueueSubmit(h->queue, 1, &info, fence));
    lock_give(&h->queue_lock);
}

static void draw_world(window *w, in_flight *frame, uint32_t at)
{
    begin(frame->world);
    const VkClearValue clear[2] = {0}; /* colour, and depth 0: infinitely far away, as depth is reversed */
    const VkRenderPassBeginInfo pass = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
                                        .renderPass = w->pass,
                                        .framebuffer = w->framebuffers[at],
                                        .renderArea = {{0, 0}, {w->world.width, w->world.height}},
                                        .clearValueCount = 2,
                                        .pClearValues = clear};
    vkCmdBeginRenderPass(frame->world, &pass, VK_SUBPASS_CONTENTS_INLINE);
    world_draw(&w->world, frame->world);
    vkCmdEndRenderPass(frame->world);
}

static void resolve(host *h, window *w, in_flight *frame, uint32_t at, VkImageLayout final_layout)
{
    const VkImageLayout from = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    begin(frame->resolve);
    host_transition(frame->resolve, &w->shown[at], VK_IMAGE_LAYOUT_UNDEFINED, to);
    const VkImageSubresourceLayers layer = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    const VkImageResolve region = {
        .srcSubresource = layer, .dstSubresource = layer, .extent = {w->world.width, w->world.height, 1}};
    vkCmdResolveImage(frame->resolve, w->color.handle, from, w->shown[at].handle, to, 1, &region);
    host_transition(frame->resolve, &w->shown[at], to, final_layout);
    submit(h, frame->resolve, VK_NULL_HANDLE, w->weather[at], frame->done);
}

/* Reads the current picture as linear RGB; the caller frees it. The image is in TRANSFER_SRC_OPTIMAL and is left ready
 * for presenting. */
static float *read_picture(host *h, window *w, uint32_t at)
{
    const image *i = &w->shown[at];
    uint8_t *bytes = host_read(h, i, 4, w->weather[at]);
    float *rgb = malloc(3 * (size_t)i->width * i->height * sizeof *rgb);
    EXPECT(bytes && rgb, "out of memory");
    const bool bgr = i->format == VK_FORMAT_B8G8R8A8_SRGB;
    for (uint32_t p = 0; p < 3 * i->width * i->height; p++) {
        const double v = bytes[4 * (p / 3) + (bgr ? 2 - p % 3 : p % 3)] / 255.0;
        rgb[p] = (float)(v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4));
    }
    free(bytes);
    VkCommandBuffer commands = host_begin(h);
    host_transition(commands, i, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR);
    host_submit(h, commands, VK_NULL_HANDLE, w->weather[at], false);
    return rgb;
}

/* Draws one frame, from acquisition to presentation; `rgb` gets the picture unless it is NULL. */
static void draw(host *h, window *w, const weather *welkin, float **rgb)
{
    /* Not every driver reports that the swapchain's size no longer matches the window. */
    native_take_events(&w->native);
    if (w->native.resized) resize(h, w, welkin);
    in_flight *frame = &w->frames[w->frame_id % IN_FLIGHT];
    VK_CHECK(vkWaitForFences(h->device, 1, &frame->done, VK_TRUE, UINT64_MAX));
    uint32_t at = 0;
    VkResult result = vkAcquireNextImageKHR(h->device, w->swapchain, UINT64_MAX, frame->acquired, VK_NULL_HANDLE, &at);
    if (result == VK_ERROR_OUT_OF_DATE_KHR) {
        resize(h, w, welkin);
        return;
    }
    VK_CHECK(result);
    VK_CHECK(vkResetFences(h->device, 1, &frame->done));
    const bool several = w->samples > 1;
    const VkImageLayout end = rgb ? VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL : VK_IMAGE_LAYOUT_PRESENT_SRC_KHR;
    /* The host's drawing waits for the image. Welkin's drawing follows on the same queue, so it needs no semaphore. The
     * last submission signals that the image may be presented. */
    draw_world(w, frame, at);
    submit(h, frame->world, frame->acquired, VK_NULL_HANDLE, several ? VK_NULL_HANDLE : frame->done);
    const handover over = {
        .color = several ? (lent){&w->color, ATTACHED, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL}
                         : (lent){&w->shown[at], ATTACHED, end},
        .depth = {&w->depth, DEPTH_READ, DEPTH_READ},
        .color_space = WK_COLOR_DISPLAY_SRGB,
        .signal = several ? VK_NULL_HANDLE : w->weather[at],
        .first_row_at_minus_y = true,
    };
    weather_draw(welkin, &over, w->frame_id, (double)w->frame_id / 60.0);
    if (several) resolve(h, w, frame, at, end);
    if (rgb) *rgb = read_picture(h, w, at);
    const VkPresentInfoKHR present = {.sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR,
                                      .waitSemaphoreCount = 1,
                                      .pWaitSemaphores = &w->weather[at],
                                      .swapchainCount = 1,
                                      .pSwapchains = &w->swapchain,
                                      .pImageIndices = &at};
    lock_take(&h->queue_lock);
    result = vkQueuePresentKHR(h->queue, &present);
    lock_give(&h->queue_lock);
    w->frame_id++;
    if (result == VK_ERROR_OUT_OF_DATE_KHR || result == VK_SUBOPTIMAL_KHR) resize(h, w, welkin);
    else VK_CHECK(result);
}

/* ---- the rest of an engine: a thread that submits on the same queue, as an uploading thread does ---- */

typedef struct uploader {
    host *host;
    atomic_bool stop;
    unsigned submissions;
    thread thread;
} uploader;

static THREAD_RESULT upload(void *user)
{
    uploader *u = user;
    while (!atomic_load(&u->stop)) {
        lock_take(&u->host->queue_lock);
        VK_CHECK(vkQueueSubmit(u->host->queue, 0, NULL, VK_NULL_HANDLE));
        lock_give(&u->host->queue_lock);
        u->submissions++;
        sleep_ms(2);
    }
    return 0;
}

static void check(host *h, window *w, const weather *welkin, const char *picture)
{
    const uint32_t sizes[2][2] = {{480, 270}, {640, 360}};
    for (int s = 0; s < 2; s++) {
        native_resize(sizes[s][0], sizes[s][1]);
        for (int i = 0; i < 50 && w->world.width != sizes[s][0]; i++) draw(h, w, welkin, NULL);
        float *rgb = NULL;
        for (int i = 0; i < 6 && !rgb; i++) draw(h, w, welkin, i < 3 ? NULL : &rgb);
        EXPECT(rgb && w->world.width == sizes[s][0] && w->world.height == sizes[s][1], "the window's size is not followed");
        world_check(&w->world, rgb);
        if (picture) world_write(&w->world, rgb, picture);
        free(rgb);
    }
}

int run_window(uint32_t samples, bool only_check, const char *picture)
{
    host h;
    window w = {.samples = samples};
    native_open(&w.native, 320, 180);
    host_open_instance(&h, true);
    w.surface = native_surface(h.instance);
    host_open_device(&h, w.surface);
    w.format = choose_format(&h, w.surface);
    open_pass(&h, &w);
    open_frames(&h, &w);
    open_images(&h, &w, VK_NULL_HANDLE);
    weather welkin = weather_open(&h);
    uploader u = {.host = &h};
    EXPECT(thread_start(&u.thread, upload, &u), "no thread");

    if (only_check) check(&h, &w, &welkin, picture);
    while (w.native.open && !only_check) {
        draw(&h, &w, &welkin, NULL);
    }

    /* Shutdown order: all use of the queue ends; then Welkin, the images it drew into, the device, and last the
     * window. */
    atomic_store(&u.stop, true);
    thread_join(u.thread);
    EXPECT(u.submissions > 0, "the other thread never got the queue");
    weather_close(&welkin);
    host_wait(&h);
    close_images(&h, &w);
    for (int i = 0; i < IN_FLIGHT; i++) {
        vkDestroySemaphore(h.device, w.frames[i].acquired, NULL);
        vkDestroyFence(h.device, w.frames[i].done, NULL);
    }
    vkDestroyCommandPool(h.device, w.pool, NULL);
    vkDestroyRenderPass(h.device, w.pass, NULL);
    host_close_device(&h);
    vkDestroySurfaceKHR(h.instance, w.surface, NULL);
    host_close_instance(&h);
    native_close(&w.native);
    return h.complaints;
}
