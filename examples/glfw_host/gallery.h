/* The README's gallery. */
#ifndef GALLERY_H
#define GALLERY_H

/*
 * Writes the pictures of these names, or all if `count` is 0, into `out`, which exists. Each pixel is the mean of 2 x 2
 * samples. Answers the process's exit code.
 */
int gallery_run(const char *data, const char *out, int width, int height, char *const *names, int count);

#endif
