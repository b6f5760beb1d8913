/* A host that draws with its own Vulkan device. Welkin draws the weather into its images, and the host looks at the
 * pixels.
 *
 *     vulkan_host [PICTURE.ppm]                                without a window
 *     vulkan_host --window [--samples N] [--check [PICTURE.ppm]]   in a window, with 1 or 4 samples a pixel
 *
 * host.c has the host's own Vulkan, world.c what it draws, weather.c everything of Welkin's; offscreen.c and window.c
 * hand images over, without and with a swapchain. */
#include "runs.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int main(int argc, char **argv)
{
    bool window = false, check = false;
    uint32_t samples = 1;
    const char *picture = NULL;
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], "--window") == 0) window = true;
        else if (strcmp(argv[i], "--check") == 0) check = true;
        else if (strcmp(argv[i], "--samples") == 0 && i + 1 < argc) samples = (uint32_t)atoi(argv[++i]);
        else picture = argv[i];
    }
    const int complaints = window ? run_window(samples, check, picture) : run_offscreen(picture);
    if (complaints > 0) {
        fprintf(stderr, "%d complaints of the validation layer\n", complaints);
        return 1;
    }
    printf("ok\n");
    return 0;
}
