/* Welkin over the host's device: what it is told once, and for each frame. */
#ifndef VULKAN_HOST_WEATHER_H
#define VULKAN_HOST_WEATHER_H

#include "host.h"
#include "welkin.h"

/* Welkin says what is wrong in words. */
#define WK_CHECK(call)                                                                                 \
    do {                                                                                               \
        wk_status status_ = (call);                                                                    \
        if (status_ < 0) {                                                                             \
            fprintf(stderr, "%s: %s: %s\n", #call, wk_status_name(status_), wk_last_error_message()); \
            exit(1);                                                                                   \
        }                                                                                              \
    } while (0)

typedef struct weather {
    wk_device *device;
    wk_context *context;
    wk_view *view;
} weather;

/* An image that Welkin takes over in one layout and gives back in another. */
typedef struct lent {
    const image *image; /* NULL: none */
    VkImageLayout layout, final_layout;
} lent;

/* What the host hands over for one frame. */
typedef struct handover {
    lent color, depth, mask;
    wk_color_space color_space;
    VkSemaphore wait, signal; /* VK_NULL_HANDLE: none; work on the same queue is in order without */
    bool first_row_at_minus_y;
} handover;

weather weather_open(host *h);
/* Draws at a time, and submits: when this returns, the work is on the queue. */
void weather_draw(const weather *w, const handover *over, uint64_t frame_id, double time_s);
/* The host is about to destroy an image, or has just done so. */
void weather_forget(const weather *w, const image *i);
/* Children first, then the device; the VkDevice comes after all of them. */
void weather_close(weather *w);

#endif
