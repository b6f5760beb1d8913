/* Welkin on the host's device: set up once, then called for each frame. */
#ifndef VULKAN_HOST_WEATHER_H
#define VULKAN_HOST_WEATHER_H

#include "host.h"
#include "welkin.h"

/* Ends the program with Welkin's message if a call fails. */
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

/* An image that Welkin receives in one layout and returns in another. */
typedef struct lent {
    const image *image; /* NULL: none */
    VkImageLayout layout, final_layout;
} lent;

/* The images and semaphores that the host passes for one frame. */
typedef struct handover {
    lent color, depth, mask;
    wk_color_space color_space;
    VkSemaphore wait, signal; /* VK_NULL_HANDLE: none; the same queue needs none */
    bool first_row_at_minus_y;
} handover;

weather weather_open(host *h);
/* Draws the weather of a time and submits it. When this returns, the work is on the queue. */
void weather_draw(const weather *w, const handover *over, uint64_t frame_id, double time_s);
/* Call it when the host is about to destroy an image, or has just destroyed it. */
void weather_forget(const weather *w, const image *i);
/* Destroys children first, then the device. Destroy the VkDevice after this. */
void weather_close(weather *w);

#endif
