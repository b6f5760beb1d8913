/* The command line of the examples in C and C++, and the files that they write: --help and --version are answered on
 * standard output, wrong arguments are named on standard error with status 2, and a file has its name only when it is
 * complete, also where Ctrl-C ends the program. */
#ifndef COMMAND_LINE_H
#define COMMAND_LINE_H

#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "welkin.h"

/* Answers --help and --version wherever they stand; the program then ends with status 0. */
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

/* Names what is wrong with an argument, and answers the program's status. */
static inline int command_line_refused(const char *name, const char *argument, const char *why)
{
    fprintf(stderr, "%s: %s%s; %s --help lists the options\n", name, why, argument, name);
    return 2;
}

/* For an argument that no option takes. */
static inline int command_line_unknown(const char *name, const char *argument)
{
    return command_line_refused(name, argument, argument[0] == '-' ? "unknown option " : "unexpected argument ");
}

/* A whole number between two others; false, with a line on stderr, for anything else. */
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

/* The name to write a file under until it is complete: picture.part.png for picture.png. One file at a time. */
static inline const char *part_begin(const char *path)
{
    const char *dot = strrchr(path, '.'), *slash = strrchr(path, '/');
    if (!dot || (slash && dot < slash)) dot = path + strlen(path);
    snprintf(part_name, sizeof part_name, "%.*s.part%s", (int)(dot - path), path, dot);
    signal(SIGINT, part_interrupted);
    signal(SIGTERM, part_interrupted);
    return part_name;
}

/* Gives the file its name, or removes what there is of it; false if it is not there. */
static inline bool part_end(const char *path, bool complete)
{
#ifdef _WIN32
    if (complete) remove(path); /* rename replaces no file there */
#endif
    const bool ok = complete && rename(part_name, path) == 0;
    if (!ok) remove(part_name);
    signal(SIGINT, SIG_DFL);
    signal(SIGTERM, SIG_DFL);
    return ok;
}

#endif
