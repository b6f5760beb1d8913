/*
 * The ground: real heights of the Jacksboro fault in Tennessee, with a road and a level pad cut into them.
 *
 * Coordinates are metres east, north and up of the site, a hillside in the data; up is height above mean sea level.
 * Beyond the data's edge the mountains go on, mirrored, as far as the eye reaches.
 */
#ifndef GROUND_H
#define GROUND_H

#include <stdbool.h>
#include <stdint.h>

#include "mesh.h"

/* Where the site lies, from the data's corners and spacing. */
#define SITE_LATITUDE_DEG 36.63283
#define SITE_LONGITUDE_DEG (-84.15175)
#define SITE_ALTITUDE_M 373.0
/* The way the valley opens and the road goes. */
#define SITE_VIEW_AZIMUTH_DEG 240.0
#define EARTH_RADIUS_M 6371000.0

typedef struct ground {
    uint16_t *heights;
    int width, height;
    float *road_profile; /* m, the road's height every ROAD_STEP_M along it */
    double pad_height;
} ground;

bool ground_load(ground *g, const char *png_path);
void ground_free(ground *g);

/* Height above sea level, m. */
double ground_height(const ground *g, double x, double y);

/* The same with the planet's curvature below the site's tangent plane: where things stand in the tangent frame. */
double ground_z(const ground *g, double x, double y);

/* How far to the right of the road's centre line a point lies, m. */
double ground_road_offset(double x, double y);

/* The point `along` m down the road (or off it by `right` m). */
void ground_road_point(double along, double right, double *x, double *y);

/* The level pad where the excavator stands. */
void ground_pad(double *x, double *y);

/* Part of the sun's disc that stands above the terrain's horizon, seen from a point, 0 to 1. */
double ground_sunlit(const ground *g, vec3 from, vec3 sun_direction);

/* Rings of triangles about the site, fine near it and coarse far away, out to 120 km. */
void ground_mesh(const ground *g, mesh *m);

#endif
