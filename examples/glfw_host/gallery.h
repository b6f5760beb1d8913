/* The pictures of docs/gallery.md. */
#ifndef GALLERY_H
#define GALLERY_H

#include <stdbool.h>

/*
 * Writes the pictures of these names, or all if `count` is 0, into `out`, which exists. Each pixel is the mean of 2 x 2
 * samples. Answers the process's exit code.
 */
int gallery_run(const char *data, const char *out, int width, int height, char *const *names, int count);

/* Whether the gallery has pictures of all of these names; if not, names the first that it has not on stderr. */
bool gallery_has(char *const *names, int count);

#endif
