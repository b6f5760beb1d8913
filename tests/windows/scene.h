/* The scene that these programs draw, on Windows and on Linux alike: a shower under broken cloud. Both systems'
 * pictures must be the same, byte for byte. */
#ifndef WINDOWS_SCENE_H
#define WINDOWS_SCENE_H

#include "welkin.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 192, HEIGHT = 108 };

#define CHECK(call)                                                                                    \
    do {                                                                                               \
        wk_status status_ = (call);                                                                    \
        if (status_ < 0) {                                                                             \
            fprintf(stderr, "%s: %s: %s\n", #call, wk_status_name(status_), wk_last_error_message()); \
            exit(1);                                                                                   \
        }                                                                                              \
    } while (0)

#define EXPECT(condition)                                                   \
    do {                                                                    \
        if (!(condition)) {                                                 \
            fprintf(stderr, "%s:%d: %s\n", __FILE__, __LINE__, #condition); \
            exit(1);                                                        \
        }                                                                   \
    } while (0)

static inline void scene_weather(wk_context *context)
{
    const char *report = "METAR LBBG 041600Z 24012G20KT 6000 -SHRA FEW015 BKN030 18/14 Q1009";
    wk_weather weather = WK_WEATHER_INIT;
    wk_cloud_layer layers[8] = {WK_CLOUD_LAYER_INIT};
    CHECK(wk_weather_from_metar(report, layers, 8, sizeof layers[0], &weather, NULL));
    CHECK(wk_context_set_weather(context, &weather, 0.0, 0.0));
    CHECK(wk_context_update(context, 30.0));
}

/* A camera two metres up that looks north and a little down; a single frame, drawn completely. */
static inline void scene_frame(wk_frame *frame, const void *target)
{
    static const double view[16] = {1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1};
    static const double projection[16] = {1.83, 0, 0, 0, 0, 3.25, 0, 0, 0, 0, 0, -1, 0, 0, 0.1, 0};
    memcpy(frame->view, view, sizeof view);
    memcpy(frame->projection, projection, sizeof projection);
    frame->frame_id = 1;
    frame->position_m[2] = 2.0;
    frame->flags = WK_FRAME_DEPTH_REVERSED | WK_FRAME_NO_HISTORY;
    frame->target = target;
}

/* Red, green and blue of `pixels` of four bytes each, as a binary PPM. */
static inline void scene_write(const char *path, const unsigned char *pixels, int width, int height)
{
    FILE *file = fopen(path, "wb");
    int i;
    EXPECT(file);
    fprintf(file, "P6\n%d %d\n255\n", width, height);
    for (i = 0; i < width * height; i++) EXPECT(fwrite(pixels + 4 * i, 3, 1, file) == 1);
    EXPECT(fclose(file) == 0);
}

/* Fails if the picture is all one colour. */
static inline void scene_look(const unsigned char *pixels)
{
    int i, least = 255, most = 0;
    for (i = 0; i < WIDTH * HEIGHT; i++) {
        const int blue = pixels[4 * i + 2];
        least = blue < least ? blue : least;
        most = blue > most ? blue : most;
    }
    EXPECT(most - least > 40);
}

#endif
