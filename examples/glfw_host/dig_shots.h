/* The gallery's picture of soil that was dug. */
#ifndef DIG_SHOTS_H
#define DIG_SHOTS_H

#include "demo.h"

/* A trench before the excavator and its spoil, on terrain that Welkin draws. */
bool dug_soil(demo *d);

#endif
