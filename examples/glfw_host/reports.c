/* Reads the weather reports. Also has the hours of one autumn day at the site. */
#include "reports.h"

#include <stdio.h>
#include <string.h>

/* 2026-10-22 00:00 UTC. On this day the sun sets in the camera's direction, and a half moon stands in the evening
 * sky. */
#define DAY_S 1792627200.0
#define UTC(hours, minutes) (DAY_S + (hours)*3600.0 + (minutes)*60.0)

const hour HOURS[HOUR_COUNT] = {
    {"noon", UTC(17, 20)},       /* local noon */
    {"low sun", UTC(21, 40)},
    {"sunset", UTC(22, 42)},     /* the sun's disc touches the hills */
    {"dusk", UTC(23, 10)},
    {"moonlight", UTC(25, 30)},
};

bool reports_read(report_list *list, const char *path)
{
    FILE *file = fopen(path, "r");
    char line[512], name[64] = "";
    list->count = 0;
    if (!file) {
        fprintf(stderr, "%s: cannot be read\n", path);
        return false;
    }
    while (fgets(line, sizeof line, file) && list->count < MAX_REPORTS) {
        line[strcspn(line, "\r\n")] = '\0';
        if (line[0] == '#') {
            snprintf(name, sizeof name, "%.63s", line + 1 + strspn(line + 1, " "));
        } else if (line[0] != '\0') {
            report *r = &list->items[list->count++];
            snprintf(r->name, sizeof r->name, "%s", name);
            snprintf(r->metar, sizeof r->metar, "%.255s", line);
        }
    }
    fclose(file);
    if (list->count == 0)
        fprintf(stderr, "%s: has no reports\n", path);
    return list->count > 0;
}
