/* Renders pictures without a display: every report at several times of day, and one sheet of them all. */
#ifndef CONTACT_H
#define CONTACT_H

#include "demo.h"

/*
 * Writes PNG files into the existing folder `out` and prints their cost. If `only` > 0, draws that report alone. Returns
 * the process's exit code.
 */
int contact_run(const char *data, const demo_world *world, const char *out, int width, int height, int only);

#endif
