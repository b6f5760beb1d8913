/* What is shown at the moment: which report, hour and camera; draws one frame of it. */
#ifndef DEMO_H
#define DEMO_H

#include "picture.h"
#include "platform.h"
#include "reports.h"
#include "scene.h"
#include "weather_link.h"

#define CAMERA_COUNT 4

typedef struct demo {
    const platform *platform;
    scene scene;
    picture picture;
    report_list reports;
    weather_link weather;
    int report, hour, camera;
    const camera *still; /* a camera of the caller's in place of the four; NULL: none */
    lamp_pair lamps;     /* of the host; intensity 0: off */
    bool bare; /* without weather: what the host draws by itself */
    bool cut;  /* the camera jumped */
    bool measure; /* time each effect of the next frame, whose picture is of no use */
    bool history; /* frames go on from those before although time stands */
    bool moving; /* time runs, and weather changes over some seconds */
    double time_s; /* of the simulation while it stands still */
    double started_ms;
    uint64_t frame;
    double ms; /* the last frame, GPU included */
    double weather_ms; /* Welkin's part of it */
} demo;

/*
 * `data` is the folder with the terrain and the reports, `planet` the text of a planet file or NULL. The host's context is current. See
 * picture_create for the size.
 */
bool demo_open(demo *d, const platform *p, const char *data, const char *planet, int width, int height, int finer);
void demo_close(demo *d);

/* Each goes round. `step` is 1 or -1. */
bool demo_next_report(demo *d, int step);
bool demo_next_hour(demo *d, int step);
void demo_next_camera(demo *d, int step);

bool demo_resize(demo *d, int width, int height);

/* Draws the world and its weather into the picture and encodes it for the display. */
bool demo_draw(demo *d);

const char *demo_camera_name(const demo *d);

/* Milliseconds of a steady clock. */
double demo_clock_ms(void);

#endif
