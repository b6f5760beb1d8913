/* The gallery's pictures of lying snow. */
#ifndef SNOW_SHOTS_H
#define SNOW_SHOTS_H

#include "demo.h"

/* After six hours of snow in wind, and an excavator that arrived afterwards. */
bool after_a_night(demo *d);
/* That scene five warm hours later. */
bool thaw(demo *d);
/* That scene after snow in a gale. */
bool blowing_snow(demo *d);
/* A barn after three hours of a snowstorm that flows around it, and the storm's wind in false colours. */
bool lee_of_a_barn(demo *d);
bool wind_in_numbers(demo *d);

#endif
