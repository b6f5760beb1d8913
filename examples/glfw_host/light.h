/* The light on the host's own objects: by Welkin (weather_link.c), or fixed values without weather. */
#ifndef LIGHT_H
#define LIGHT_H

#include "vec.h"

/* Two lamps side by side with the same beam. */
typedef struct lamp_pair {
    vec3 position[2], direction[2];
    float intensity_cd[3];      /* of each lamp along its axis, linear Rec. 709 channels; 0: no lamps */
    double inner_deg, outer_deg; /* angle from the axis at which the beam starts to fade, and at which it ends */
} lamp_pair;

typedef struct light {
    vec3 sun_direction;    /* towards the sun, or towards the moon when that is brighter */
    float illuminance[3];  /* lux in linear Rec. 709 channels, on a surface facing sun_direction */
    float ambient[9][3];   /* cd/m^2: radiance of sky and ground as real spherical harmonics */
    double cd_m2_per_unit; /* luminance of the value 1: keeps half floats in range by day and night */
    lamp_pair lamps;
} light;

#endif
