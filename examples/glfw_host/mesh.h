/* Triangles in memory, and the solids from which all objects are built: boxes, prisms and cones. */
#ifndef MESH_H
#define MESH_H

#include <stddef.h>
#include <stdint.h>

#include "vec.h"

typedef struct vertex {
    float position[3]; /* metres east, north and up of the site */
    float normal[3];
    float albedo[3]; /* linear Rec. 709 reflectance */
    float road;      /* m to the right of the road's centre line; only the ground's shader reads it */
} vertex;

typedef struct mesh {
    vertex *vertices;
    uint32_t *indices;
    size_t vertex_count, vertex_room, index_count, index_room;
} mesh;

uint32_t mesh_vertex(mesh *m, vertex v);
void mesh_triangle(mesh *m, uint32_t a, uint32_t b, uint32_t c);
void mesh_free(mesh *m);

/* Adds a box of `size`, centred at the origin of `place`. */
void mesh_box(mesh *m, mat4 place, vec3 size, vec3 albedo);

/* Adds a prism from `foot` to `top` on an outline around the origin, whose corners run counterclockwise seen from
 * above. Its lid has a colour of its own. */
void mesh_prism(mesh *m, const double (*outline)[2], int corners, double foot, double top, vec3 albedo, vec3 lid);

/* Adds a cone standing on `foot`, with smooth normals. */
void mesh_cone(mesh *m, vec3 foot, double radius, double height, int sides, vec3 albedo);

#endif
