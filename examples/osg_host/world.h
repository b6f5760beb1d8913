/* The world of ../glfw_host (measured terrain, a road, an excavator, posts and a wood) as plain arrays for a C++
 * program. */
#ifndef WORLD_H
#define WORLD_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Floats per vertex: position, normal, albedo (linear Rec. 709) and metres to the right of the road's centre line. */
enum { WORLD_FLOATS = 10 };

typedef struct world_mesh {
    const float *vertices;
    const uint32_t *indices;
    size_t vertex_count, index_count;
} world_mesh;

typedef struct world_site {
    double latitude_deg, longitude_deg, altitude_m, azimuth_deg;
    double pad[3]; /* where the excavator stands */
    double eye[3]; /* on the hillside; the posts' distances are measured from here */
} world_site;

/* Returns 0 if the heights cannot be read, and prints the reason on stderr. */
int world_load(const char *heights_png, world_site *site);
double world_height(double east, double north);
/* Valid until world_free. */
world_mesh world_ground(void);
world_mesh world_objects(void);
void world_free(void);

#ifdef __cplusplus
}
#endif

#endif
