/* Twelve small scenes that together use every effect, each with its weather and camera. */
#ifndef SCENES_H
#define SCENES_H

#include <stdbool.h>
#include <welkin.h>

typedef struct scene {
    const char *name;
    /* Eye above level ground, m; the view's elevation and its height, degrees. It looks north. */
    double eye_m, elevation_deg, fov_y_deg;
    /* Surface class beside the road, a wk_surface_class. */
    unsigned char class_of_land;
    /* Simulation time of the picture, s. */
    double time_s;
    bool (*prepare)(wk_context *context, wk_view *view);
} scene;

extern const scene SCENES[];
extern const int SCENE_COUNT;

/* False, with a line on standard error, where a call failed. */
bool passed(wk_status status);

#endif
