/* The pictures of docs/gallery.md. */
#ifndef GALLERY_H
#define GALLERY_H

#include <stdbool.h>

/*
 * Writes the pictures with these names, or all if `count` is 0, into the existing folder `out`. Each pixel is the mean
 * of 2 x 2 samples. Returns the process's exit code.
 */
int gallery_run(const char *data, const char *out, int width, int height, char *const *names, int count);

/* Checks that the gallery has pictures with all of these names; if not, prints the first unknown name on stderr. */
bool gallery_has(char *const *names, int count);

#endif
