/* The gallery's pictures of snow that lies. */
#ifndef SNOW_SHOTS_H
#define SNOW_SHOTS_H

#include "demo.h"

/* Six hours of snow in wind, and an excavator that has come since. */
bool after_a_night(demo *d);
/* The same after five warm hours. */
bool thaw(demo *d);
/* The same in a gale. */
bool blowing_snow(demo *d);
/* A barn after three hours of a snowstorm that goes round it, and the wind of that storm in false colours. */
bool lee_of_a_barn(demo *d);
bool wind_in_numbers(demo *d);

#endif
