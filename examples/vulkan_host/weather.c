#include "weather.h"
#include "world.h"

#include <string.h>

static const double VISIBILITY_M = 5e3;

static void lock_queue(void *user) { lock_take(&((host *)user)->queue_lock); }

static void unlock_queue(void *user) { lock_give(&((host *)user)->queue_lock); }

weather weather_open(host *h)
{
    weather w;
    wk_vulkan_host_desc desc = WK_VULKAN_HOST_DESC_INIT;
    desc.get_instance_proc_addr = (wk_vulkan_get_proc_fn)vkGetInstanceProcAddr;
    desc.instance = h->instance;
    desc.instance_api_version = h->app.apiVersion;
    desc.enabled_instance_extensions = h->instance_extensions;
    desc.instance_extension_count = h->instance_extension_count;
    desc.physical_device = h->physical_device;
    desc.device = h->device;
    desc.enabled_device_extensions = h->device_info.ppEnabledExtensionNames;
    desc.device_extension_count = h->device_info.enabledExtensionCount;
    desc.enabled_features = &h->device_info; /* with the chain of structs that follows it */
    desc.queue_family_index = h->queue_family;
    desc.lock_queue = lock_queue;
    desc.unlock_queue = unlock_queue;
    desc.user = h;
    WK_CHECK(wk_device_create_vulkan(&desc, &w.device));
    wk_device *second = NULL;
    EXPECT(wk_device_create_vulkan(&desc, &second) == WK_ERROR_ALREADY_WRAPPED && !second, "one device a queue");
    wk_caps caps = WK_CAPS_INIT;
    WK_CHECK(wk_device_get_caps(w.device, &caps));
    printf("%s (%s), tier %u\n", caps.adapter_name, caps.driver, caps.tier);

    WK_CHECK(wk_context_create(w.device, NULL, &w.context));
    wk_given_direction sun = WK_GIVEN_DIRECTION_INIT;
    sun.azimuth_deg = 140.0;
    sun.elevation_deg = 40.0;
    WK_CHECK(wk_context_set_sun(w.context, &sun));
    wk_weather haze = WK_WEATHER_INIT;
    haze.visibility_m = VISIBILITY_M;
    WK_CHECK(wk_context_set_weather(w.context, &haze, 0.0, 0.0));
    WK_CHECK(wk_view_create(w.context, NULL, &w.view));
    return w;
}

static wk_vulkan_image lend(const lent *l)
{
    wk_vulkan_image i = WK_VULKAN_IMAGE_INIT;
    if (!l->image) return i;
    i.image = (uint64_t)l->image->handle;
    i.format = (uint32_t)l->image->format;
    i.width = l->image->width;
    i.height = l->image->height;
    i.samples = l->image->samples;
    i.usage = l->image->usage;
    i.layout = (uint32_t)l->layout;
    i.final_layout = (uint32_t)l->final_layout;
    return i;
}

static wk_vulkan_semaphore binary(VkSemaphore handle)
{
    wk_vulkan_semaphore s = WK_VULKAN_SEMAPHORE_INIT;
    s.semaphore = (uint64_t)handle;
    return s;
}

void weather_draw(const weather *w, const handover *over, uint64_t frame_id, double time_s)
{
    const wk_vulkan_image color = lend(&over->color), depth = lend(&over->depth), mask = lend(&over->mask);
    const wk_vulkan_semaphore waits[1] = {binary(over->wait)}, signals[1] = {binary(over->signal)};
    wk_vulkan_target target = WK_VULKAN_TARGET_INIT;
    target.color = &color;
    target.depth = &depth;
    if (over->mask.image) target.mask = &mask;
    target.wait_semaphores = waits;
    target.wait_count = over->wait != VK_NULL_HANDLE;
    target.signal_semaphores = signals;
    target.signal_count = over->signal != VK_NULL_HANDLE;

    wk_frame frame = WK_FRAME_INIT;
    frame.frame_id = frame_id;
    frame.target = &target;
    frame.color_space = over->color_space;
    frame.flags = WK_FRAME_DEPTH_REVERSED;
    frame.position_m[2] = EYE_M;
    /* Looks north: eye x is east, eye y is up, eye z is south. Column by column. */
    const double view_matrix[16] = {1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1};
    memcpy(frame.view, view_matrix, sizeof view_matrix);
    /* Reversed depth: NEAR_M / distance, 0 infinitely far away. A viewport of positive height, as in this host's
     * window, puts clip y = -1 in the first row. The projection then flips y, and Welkin is told so. A viewport of
     * negative height needs neither. */
    const double aspect = (double)color.width / color.height, y = over->first_row_at_minus_y ? -FOCAL : FOCAL;
    const double projection[16] = {FOCAL / aspect, 0, 0, 0, 0, y, 0, 0, 0, 0, 0, -1, 0, 0, NEAR_M, 0};
    memcpy(frame.projection, projection, sizeof projection);
    if (over->first_row_at_minus_y) frame.flags |= WK_FRAME_FIRST_ROW_AT_MINUS_Y;
    WK_CHECK(wk_context_update(w->context, time_s));
    WK_CHECK(wk_view_record(w->view, &frame, WK_STAGE_ALL));
}

void weather_forget(const weather *w, const image *i)
{
    WK_CHECK(wk_device_forget_vulkan_image(w->device, (uint64_t)i->handle));
}

void weather_close(weather *w)
{
    WK_CHECK(wk_view_destroy(w->view));
    WK_CHECK(wk_context_destroy(w->context));
    WK_CHECK(wk_device_destroy(w->device));
}
