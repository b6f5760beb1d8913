/* The light that falls on the host's own objects. Welkin answers it (weather_link.c); without weather it is made up. */
#ifndef LIGHT_H
#define LIGHT_H

#include "vec.h"

/* Two lamps side by side with one beam. */
typedef struct lamp_pair {
    vec3 position[2], direction[2];
    float intensity_cd[3];      /* of each in its middle, linear Rec. 709 channels; 0: there are none */
    double inner_deg, outer_deg; /* from the middle: where the beam is full, where it has ended */
} lamp_pair;

typedef struct light {
    vec3 sun_direction;    /* towards the sun, or the moon where that is brighter */
    float illuminance[3];  /* lux in linear Rec. 709 channels, on a surface that faces it */
    float ambient[9][3];   /* cd/m^2: radiance of the sky and the ground, real spherical harmonics */
    double cd_m2_per_unit; /* luminance of the value 1 in the picture: keeps half floats in their range by day and night */
    lamp_pair lamps;
} light;

#endif
