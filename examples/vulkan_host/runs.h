/* How the example runs: each draws, looks at its pixels and answers how often the validation layer complained. */
#ifndef VULKAN_HOST_RUNS_H
#define VULKAN_HOST_RUNS_H

#include <stdbool.h>
#include <stdint.h>

int run_offscreen(const char *picture);
/* `check` ends after some frames and a resize; else it runs until the window is closed. */
int run_window(uint32_t samples, bool check, const char *picture);

#endif
