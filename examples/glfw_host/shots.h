/* The pictures of docs/gallery.md: where each is taken from, when, and in what weather. */
#ifndef SHOTS_H
#define SHOTS_H

#include "demo.h"
#include "objects.h"

enum world { WORLD, WITH_BRIDGE, WITH_BARN, NO_WORLD /* from so high that the host's land would end in the picture */ };

typedef struct shot {
    const char *name, *caption;
    /* Where the camera stands: down the road and right of it, above the ground, m. */
    double along_m, right_m, up_m;
    double azimuth_deg, elevation_deg, fov_y_deg;
    /* Sets sun and weather, and all else that is there. */
    bool (*prepare)(demo *d);
    enum world world;
    /* The window that the camera looks through at a time: it has been in the rain for 50 s. NULL: none. */
    bool (*windscreen)(demo *d, double time_s);
    /* Written at half the size: of grain or of few things. */
    bool small;
} shot;

extern const shot SHOTS[];
extern const int SHOT_COUNT;

/* Puts the sun there from now on. */
bool sun_at(demo *d, double azimuth_deg, double elevation_deg);

/* Tells Welkin of boxes that keep weather off. */
#define MOST_SHELTERS BRIDGE_BOXES
bool shelter(demo *d, const solid *boxes, int count);

camera shot_camera(const shot *s, const ground *g);

#endif
