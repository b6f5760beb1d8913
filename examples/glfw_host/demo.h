/* What the demonstration currently shows (report, hour and camera), and the function that draws a frame of it. */
#ifndef DEMO_H
#define DEMO_H

#include "picture.h"
#include "platform.h"
#include "reports.h"
#include "scene.h"
#include "terrain_file.h"
#include "vessel.h"
#include "weather_link.h"

#define CAMERA_COUNT 4

/* What stands in the demonstration's world in place of its own land, planet and sky. */
typedef struct demo_world {
    const char *planet;  /* text of a planet file; NULL: the Earth */
    const char *terrain; /* path of a file of heights that Welkin draws; NULL: the host's land */
    bool at_sea;         /* a vessel on the open sea */
} demo_world;

typedef struct demo {
    const platform *platform;
    scene scene;
    picture picture;
    report_list reports;
    weather_link weather;
    int report, hour, camera;
    const camera *still; /* a camera from the caller in place of the four built-in ones; NULL: none */
    lamp_pair lamps;     /* the host's lamps; intensity 0: off */
    bool bare; /* without weather: only what the host itself draws */
    bool cut;  /* the camera jumped */
    bool measure; /* time each effect in the next frame; that frame's picture is not used */
    bool at_sea;  /* a vessel on the open sea in place of the land */
    bool on_terrain; /* the terrain of a file in place of the land */
    terrain_file terrain;
    vec3 standing; /* point of that terrain below the cameras */
    vessel boat;
    mat4 pose; /* pose of the boat in the last frame */
    bool history; /* use the history of earlier frames although time stands still */
    bool moving; /* time runs, and the weather changes over some seconds */
    double time_s; /* simulation time while it stands still */
    double started_ms;
    uint64_t frame;
    double ms; /* duration of the last frame, GPU included */
    double weather_ms; /* Welkin's share of it */
} demo;

/*
 * `data` is the folder with the terrain and the reports. The host's OpenGL context must be current. For the size, see
 * picture_create.
 */
bool demo_open(demo *d, const platform *p, const char *data, const demo_world *world, int width, int height, int finer);
void demo_close(demo *d);

/* Step through reports, hours and cameras, wrapping around at the ends. `step` is 1 or -1. */
bool demo_next_report(demo *d, int step);
bool demo_next_hour(demo *d, int step);
void demo_next_camera(demo *d, int step);

bool demo_resize(demo *d, int width, int height);

/* Draws the world and its weather into the picture and encodes it for the display. */
bool demo_draw(demo *d);

const char *demo_camera_name(const demo *d);

/* Time of a clock, ms: UTC, or a counter on Windows. Only differences have a meaning. */
double demo_clock_ms(void);

#endif
