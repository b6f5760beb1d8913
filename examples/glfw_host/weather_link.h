/*
 * The host's whole link with Welkin: nine calls. A simulator's author copies this file and weather_link.c and puts the
 * names of their own camera, picture and light in place of this host's.
 *
 * All of them are called on the thread that draws, with the host's OpenGL context current. Those that answer bool write
 * what went wrong to stderr.
 */
#ifndef WEATHER_LINK_H
#define WEATHER_LINK_H

#include "light.h"
#include "picture.h"
#include "platform.h"
#include "scene.h"

#include "welkin.h"

typedef struct weather_link {
    wk_device *device;   /* Welkin in the host's OpenGL */
    wk_context *context; /* the weather */
    wk_view *view;       /* the camera's picture of it */
    double time_s;       /* simulation time */
    uint64_t generation; /* of the picture's textures */
    wk_diagnostic diagnostic; /* a number of each pixel in false colours in place of the picture */
    wk_caps caps;
    char summary[128];
    wk_effect_cost costs[16]; /* what the effects of all measured frames took together */
    uint32_t cost_count, measured_frames;
} weather_link;

/* Whether a call of Welkin's went well; if not, stderr says why. */
bool weather_check(wk_status status);

/* Once, when the host has made its contexts. `planet_toml` is the text of a planet file; NULL: the Earth. */
bool weather_open(weather_link *w, const platform *p, const char *planet_toml);
void weather_close(weather_link *w);

/* Whenever the weather changes: a report as an airport sends it, and how long the change takes. */
bool weather_report(weather_link *w, const char *metar, double transition_s);

/* Whenever the time jumps: seconds since 1970-01-01 00:00 UTC. */
bool weather_clock(weather_link *w, double utc_s);

/* Every frame, before the host draws: moves time on and answers the light that the host's own objects stand in. */
bool weather_light(weather_link *w, const camera *c, double time_s, light *l);

/*
 * Every frame, after the host has drawn: sky, air and fog into its picture, which is tone-mapped then. `still` is for a
 * picture that stands alone and has no frames before it.
 */
bool weather_draw(weather_link *w, const picture *p, const camera *c, double cd_m2_per_unit, uint64_t frame, bool still);

/* Moves on what has a history, such as water on a windscreen, without a picture. */
bool weather_prepare(weather_link *w, const picture *p, const camera *c, double time_s, uint64_t frame);

/*
 * The same once more, with each effect waited for and timed: for figures, slower than weather_draw. Adds to what
 * weather_print_costs says.
 */
bool weather_measure(weather_link *w, const picture *p, const camera *c, double cd_m2_per_unit, uint64_t frame);

/* After the picture's textures were made anew. */
void weather_resized(weather_link *w);

/* For people: which GPU, what the weather is in numbers, what the effects cost. */
const char *weather_adapter(weather_link *w);
const char *weather_summary(weather_link *w);
void weather_print_costs(weather_link *w);

#endif
