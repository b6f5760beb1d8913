/*
 * The host's whole link to Welkin. To add Welkin to a simulator, copy this file and weather_link.c, and replace this
 * host's camera, picture and light by the simulator's own.
 *
 * Call all functions on the thread that draws, with the host's OpenGL context current. Functions that return bool print
 * errors on stderr.
 */
#ifndef WEATHER_LINK_H
#define WEATHER_LINK_H

#include "light.h"
#include "picture.h"
#include "platform.h"
#include "scene.h"

#include "welkin.h"

typedef struct weather_link {
    wk_device *device;   /* Welkin on the host's OpenGL */
    wk_context *context; /* the weather */
    wk_view *view;       /* one camera */
    double time_s;       /* simulation time */
    double station_altitude_m; /* altitude of the airport that sends the reports, m */
    uint64_t generation; /* counts replacements of the picture's textures */
    wk_diagnostic diagnostic; /* quantity to show in false colours in place of the picture */
    wk_caps caps;
    char summary[128];
    wk_effect_cost costs[16]; /* total cost of each effect over all measured frames */
    uint32_t cost_count, measured_frames;
} weather_link;

/* Checks a Welkin status; on failure, prints the reason on stderr and returns false. */
bool weather_check(wk_status status);

/* Called once, when the host has created its contexts. `planet_toml` is the text of a planet file; NULL: the Earth. */
bool weather_open(weather_link *w, const platform *p, const char *planet_toml);
void weather_close(weather_link *w);

/* Called whenever the weather changes: `metar` is a report as an airport sends it; the change takes the given time. */
bool weather_report(weather_link *w, const char *metar, double transition_s);

/* Called whenever the time jumps: seconds since 1970-01-01 00:00 UTC. */
bool weather_clock(weather_link *w, double utc_s);

/* Called every frame before the host draws: advances the time and returns the light for the host's own objects. */
bool weather_light(weather_link *w, const camera *c, double time_s, light *l);

/*
 * Called every frame after the host has drawn: draws the weather into its picture and tone-maps it. Set `still`
 * for a single picture without earlier frames.
 */
bool weather_draw(weather_link *w, const picture *p, const camera *c, double cd_m2_per_unit, uint64_t frame, bool still);

/* Advances effects with a history, such as water on a windscreen, without drawing a picture. */
bool weather_prepare(weather_link *w, const picture *p, const camera *c, double time_s, uint64_t frame);

/*
 * As weather_draw, but waits for each effect and times it, which is slower. Adds to the costs that weather_print_costs
 * prints.
 */
bool weather_measure(weather_link *w, const picture *p, const camera *c, double cd_m2_per_unit, uint64_t frame);

/* Called after the picture's textures were created again. */
void weather_resized(weather_link *w);

/* Text for people: the GPU, the weather in numbers, the cost of the effects. */
const char *weather_adapter(weather_link *w);
const char *weather_summary(weather_link *w);
void weather_print_costs(weather_link *w);

#endif
