/*
 * The terrain: measured heights of the Jacksboro fault in Tennessee, with a road and a level pad cut into them.
 *
 * Coordinates are metres east, north and up of the site, a hillside in the data; up is height above mean sea level.
 * Beyond the edge of the data the mountains continue, mirrored, as far as the eye can see.
 */
#ifndef GROUND_H
#define GROUND_H

#include <stdbool.h>
#include <stdint.h>

#include "mesh.h"

/* Position of the site, from the data's corners and spacing. */
#define SITE_LATITUDE_DEG 36.63283
#define SITE_LONGITUDE_DEG (-84.15175)
#define SITE_ALTITUDE_M 373.0
/* Direction in which the valley opens and the road runs. */
#define SITE_VIEW_AZIMUTH_DEG 240.0
#define EARTH_RADIUS_M 6371000.0

typedef struct ground {
    uint16_t *heights;
    int width, height;
    float *road_profile; /* height of the road every ROAD_STEP_M along it, m */
    double pad_height;
} ground;

bool ground_load(ground *g, const char *png_path);
void ground_free(ground *g);

/* Height above sea level, m. */
double ground_height(const ground *g, double x, double y);

/* As ground_height, lowered by the planet's curvature below the site's tangent plane: the z of the ground in the
 * tangent frame. */
double ground_z(const ground *g, double x, double y);

/* Distance of a point to the right of the road's centre line, m; negative to the left, 1e4 beyond the road's ends. */
double ground_road_offset(double x, double y);

/* Point `along` metres down the road and `right` metres to the right of it. */
void ground_road_point(double along, double right, double *x, double *y);

/* Centre of the level pad on which the excavator stands. */
void ground_pad(double *x, double *y);

/* Share of the sun's disc that the terrain does not hide from a point, 0 to 1. `sun_direction` is a unit vector. */
double ground_sunlit(const ground *g, vec3 from, vec3 sun_direction);

/* Builds rings of triangles around the site, fine near it and coarse far away, out to 120 km. */
void ground_mesh(const ground *g, mesh *m);

#endif
