/* The gallery's pictures of the open sea. */
#ifndef SEA_SHOTS_H
#define SEA_SHOTS_H

#include "demo.h"

/* A breeze of 5 m/s under a high sun. */
bool sea_breeze(demo *d);
/* A storm, seen from a bridge. */
bool sea_storm(demo *d);
/* The glitter of a low sun. */
bool sea_glitter(demo *d);
/* A swell that crosses the waves of the wind. */
bool sea_swell(demo *d);
/* The glitter of the moon. */
bool moonlit_sea(demo *d);
/* A vessel on the waves of a strong breeze. */
bool sea_vessel(demo *d);
/* The wake of a vessel that turns, from above. */
bool sea_wake(demo *d);
/* Fog over the water. */
bool sea_fog(demo *d);

#endif
