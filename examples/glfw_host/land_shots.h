/* The gallery's pictures of terrain that Welkin draws. */
#ifndef LAND_SHOTS_H
#define LAND_SHOTS_H

#include "demo.h"

/* The site's own terrain in tiles, on a clear afternoon, and in clean air under a low sun: the host draws its objects
 * alone. */
bool drawn_land(demo *d);
bool land_shadows(demo *d);

#endif
