/* Pictures without a display: every report at several times of day, and one sheet of them all. */
#ifndef CONTACT_H
#define CONTACT_H

/*
 * Writes PNG files into `out`, which exists; says what they cost. `only` > 0 takes that report alone. Answers the
 * process's exit code.
 */
int contact_run(const char *data, const char *planet, const char *out, int width, int height, int only);

#endif
