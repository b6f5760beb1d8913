/* The command line of the C and C++ examples, and safe writing of their files. --help and --version print to standard
 * output. A wrong argument is named on standard error, with exit status 2. A file gets its final name only when it is
 * complete, even if Ctrl-C ends the program. */
#ifndef COMMAND_LINE_H
#define COMMAND_LINE_H

#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "welkin.h"

/* Handles --help and --version at any position; the program then ends with status 0. */
static inline bool command_line_answered(int argc, char **argv, const char *name, const char *usage)
{
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], "--help") == 0 || strcmp(argv[i], "-h") == 0) {
            fputs(usage, stdout);
            return true;
        }
        if (strcmp(argv[i], "--version") == 0) {
            uint32_t major = 0, minor = 0, patch = 0;
            wk_version(&major, &minor, &patch);
            printf("%s (Welkin %u.%u.%u)\n", name, (unsigned)major, (unsigned)minor, (unsigned)patch);
            return true;
        }
    }
    return false;
}

/* Prints what is wrong with an argument and returns the program's exit status. */
static inline int command_line_refused(const char *name, const char *argument, const char *why)
{
    fprintf(stderr, "%s: %s%s; %s --help lists the options\n", name, why, argument, name);
    return 2;
}

/* Reports an argument that no option takes. */
static inline int command_line_unknown(const char *name, const char *argument)
{
    return command_line_refused(name, argument, argument[0] == '-' ? "unknown option " : "unexpected argument ");
}

/* Parses a whole number within a range. For anything else, returns false and prints a line on stderr. */
static inline bool command_line_number(const char *name, const char *option, const char *text, int least, int most, int *value)
{
    char *end = NULL;
    const long number = strtol(text, &end, 10);
    if (end == text || *end || number < least || number > most) {
        fprintf(stderr, "%s: %s must be a whole number from %d to %d, got %s\n", name, option, least, most, text);
        return false;
    }
    *value = (int)number;
    return true;
}

static char part_name[1200];

static inline void part_interrupted(int which)
{
    remove(part_name);
    signal(which, SIG_DFL);
    raise(which);
}

/* Temporary name of a file until it is complete: picture.part.png for picture.png. One file at a time. */
static inline const char *part_begin(const char *path)
{
    const char *dot = strrchr(path, '.'), *slash = strrchr(path, '/');
    if (!dot || (slash && dot < slash)) dot = path + strlen(path);
    snprintf(part_name, sizeof part_name, "%.*s.part%s", (int)(dot - path), path, dot);
    signal(SIGINT, part_interrupted);
    signal(SIGTERM, part_interrupted);
    return part_name;
}

/* Renames the complete file to `path`, or removes the temporary file. Returns false if `path` was not written. */
static inline bool part_end(const char *path, bool complete)
{
#ifdef _WIN32
    if (complete) remove(path); /* on Windows, rename does not replace an existing file */
#endif
    const bool ok = complete && rename(part_name, path) == 0;
    if (!ok) remove(part_name);
    signal(SIGINT, SIG_DFL);
    signal(SIGTERM, SIG_DFL);
    return ok;
}

#endif
