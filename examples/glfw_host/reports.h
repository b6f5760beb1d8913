/* The weather reports of examples/data/metar.txt and the times of day at which they are shown. */
#ifndef REPORTS_H
#define REPORTS_H

#include <stdbool.h>

#define MAX_REPORTS 64

typedef struct report {
    char name[64];   /* from the comment line above the report */
    char metar[256]; /* the report as an airport sends it */
} report;

typedef struct report_list {
    report items[MAX_REPORTS];
    int count;
} report_list;

/* Reads a file of `# name` lines, each followed by a report. If it has none, returns false and prints a message on
 * stderr. */
bool reports_read(report_list *list, const char *path);

typedef struct hour {
    const char *name;
    double utc_s; /* seconds since 1970-01-01 00:00 UTC, without leap seconds */
} hour;

#define HOUR_COUNT 5
extern const hour HOURS[HOUR_COUNT];

#endif
