/* The two ways to run the example. Each draws, checks its pixels and returns the number of validation messages. */
#ifndef VULKAN_HOST_RUNS_H
#define VULKAN_HOST_RUNS_H

#include <stdbool.h>
#include <stdint.h>

int run_offscreen(const char *picture);
/* With `check`, ends after some frames and resizes; otherwise runs until the window is closed. */
int run_window(uint32_t samples, bool check, const char *picture);

#endif
