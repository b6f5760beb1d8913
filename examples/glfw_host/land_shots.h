/* The gallery's picture of terrain that Welkin draws. */
#ifndef LAND_SHOTS_H
#define LAND_SHOTS_H

#include "demo.h"

/* The site's own terrain in tiles, on a clear afternoon: the host draws its objects alone. */
bool drawn_land(demo *d);

#endif
