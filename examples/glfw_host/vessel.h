/* A workboat that floats by Welkin's queries of the sea, the region that keeps the water out of it, and its wake. */
#ifndef VESSEL_H
#define VESSEL_H

#include <stdbool.h>

#include <welkin.h>

#include "mesh.h"

typedef struct vessel {
    double x, y; /* m, world, at time at_s */
    double heading_deg; /* at time at_s */
    double speed_m_s;
    double turn_deg_s; /* clockwise */
    double at_s;
} vessel;

/* Eye of the helmsman, in the vessel's frame. */
extern const vec3 VESSEL_HELM;

/* Adds the vessel's solids: x to starboard, y ahead, z up from the water line. */
void vessel_mesh(mesh *m);

/* Returns the vessel as it is at a time, on its course. */
vessel vessel_at(const vessel *v, double time_s);

/* Sets a dry region of the sea with the hull's outline, which moves with the vessel's heading and speed. Called in
   every frame for a vessel that turns: regions move along lines. */
wk_status vessel_keep_dry(const vessel *v, wk_context *context);

/* Sets the hull that raises the vessel's wake. Called when speed or rate of turn change, or in every frame. */
wk_status vessel_raise_wake(const vessel *v, wk_context *context);

/* Returns the pose that the vessel has at a time on water without waves. */
mat4 vessel_level(const vessel *v, double time_s);

/* Gets the pose in which the vessel lies on the waves at a time. */
wk_status vessel_float(const vessel *v, const wk_context *context, double time_s, mat4 *pose);

#endif
