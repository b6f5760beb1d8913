/* A workboat that floats by Welkin's queries of the sea, and the region that keeps the water out of it. */
#ifndef VESSEL_H
#define VESSEL_H

#include <stdbool.h>

#include <welkin.h>

#include "mesh.h"

typedef struct vessel {
    double x, y; /* m, world, at time 0 */
    double heading_deg;
    double speed_m_s;
} vessel;

/* Eye of the helmsman, in the vessel's frame. */
extern const vec3 VESSEL_HELM;

/* Adds the vessel's solids: x to starboard, y ahead, z up from the water line. */
void vessel_mesh(mesh *m);

/* Sets a dry region of the sea with the hull's outline, which moves with the vessel's heading and speed. */
wk_status vessel_keep_dry(const vessel *v, wk_context *context);

/* Returns the pose that the vessel has at a time on water without waves. */
mat4 vessel_level(const vessel *v, double time_s);

/* Gets the pose in which the vessel lies on the waves at a time. */
wk_status vessel_float(const vessel *v, const wk_context *context, double time_s, mat4 *pose);

#endif
