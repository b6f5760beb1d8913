/* The gallery's pictures of lying snow. */
#ifndef SNOW_SHOTS_H
#define SNOW_SHOTS_H

#include "demo.h"

/* After a night with six hours of snow in wind; the tracks are those of the excavator, which arrived afterwards. */
bool after_a_night(demo *d);
/* After that night and five warm hours. */
bool thaw(demo *d);
/* After that night, with a wind of 14 m/s and no snowfall: the snow blows. */
bool blowing_snow(demo *d);
/* A barn after three hours of a snowstorm that flows around it, and the storm's wind in false colours. */
bool lee_of_a_barn(demo *d);
bool wind_in_numbers(demo *d);

#endif
