/* Man-made and planted objects: an excavator, a row of posts at known distances, and a wood. */
#ifndef OBJECTS_H
#define OBJECTS_H

#include "ground.h"
#include "mesh.h"

#define POST_COUNT 7
extern const double POST_DISTANCES_M[POST_COUNT];

/* The eye position from which the posts' distances are measured. */
vec3 objects_survey_eye(const ground *g);

void objects_mesh(const ground *g, mesh *m);

/* A box, centred at the origin of `place`. */
typedef struct solid {
    mat4 place;
    vec3 size;
} solid;

/* A bridge over the road, about 80 m down it. The first box is the deck. */
#define BRIDGE_BOXES 9
void objects_bridge(const ground *g, solid boxes[BRIDGE_BOXES]);
void objects_bridge_mesh(const ground *g, mesh *m);

/* A barn with a porch, to windward of the excavator in the snow pictures: first its walls, then its roofs. */
#define BARN_BOXES 5
#define BARN_AZIMUTH_DEG (SITE_VIEW_AZIMUTH_DEG - 100.0)
void objects_barn(const ground *g, solid boxes[BARN_BOXES]);
void objects_barn_mesh(const ground *g, mesh *m);

#endif
