/* The pictures of docs/gallery.md: from where each is taken, when, and in what weather. */
#ifndef SHOTS_H
#define SHOTS_H

#include "demo.h"
#include "objects.h"

enum world {
    WORLD,
    WITH_BRIDGE,
    WITH_BARN,
    NO_WORLD, /* seen from so high that the host's land would end */
    OPEN_SEA, /* nothing but Welkin's sea, whose level is 0 */
    WITH_VESSEL, /* a vessel on that sea */
    LANDLESS, /* the host's objects on terrain that Welkin draws */
};

typedef struct shot {
    const char *name, *caption;
    /* Camera position: metres down the road, to the right of it, and above the ground or the sea. */
    double along_m, right_m, up_m;
    double azimuth_deg, elevation_deg, fov_y_deg;
    /* Sets sun, weather and everything else in the shot. */
    bool (*prepare)(demo *d);
    enum world world;
    /* Sets the window through which the camera looks, as it is at a time. The picture shows it after 50 s of rain.
     * NULL: no window. */
    bool (*windscreen)(demo *d, double time_s);
    /* The picture is written at half the size, because it has grain or few objects. */
    bool small;
} shot;

extern const shot SHOTS[];
extern const int SHOT_COUNT;

/* Sets the sun from now on. */
bool sun_at(demo *d, double azimuth_deg, double elevation_deg);

/* Gives Welkin boxes that keep off the weather. */
#define MOST_SHELTERS BRIDGE_BOXES
bool shelter(demo *d, const solid *boxes, int count);

camera shot_camera(const shot *s, const ground *g);

#endif
