/* A host that draws with its own Vulkan device. Welkin draws the weather into its images, and the host checks the
 * pixels.
 *
 *     vulkan_host [PICTURE.ppm]                                without a window
 *     vulkan_host --window [--samples N] [--check [PICTURE.ppm]]   in a window, with 1 or 4 samples a pixel
 *
 * host.c has the host's own Vulkan, world.c what it draws, weather.c everything that uses Welkin. offscreen.c hands
 * images over without a swapchain, window.c with one. */
#include "runs.h"

#include "../command_line.h"

static const char NAME[] = "vulkan_host";

static const char USAGE[] =
    "vulkan_host [PICTURE.ppm]\n"
    "vulkan_host --window [--samples N] [--check [PICTURE.ppm]]\n"
    "  PICTURE.ppm  where the last picture is written\n"
    "  --window     draw in a window, until it is closed; else without one, three frames\n"
    "  --samples N  1 or 4 samples a pixel (1)\n"
    "  --check      draw some frames in the window, look at their pixels, end\n"
    "  --help, --version\n";

int main(int argc, char **argv)
{
    bool window = false, check = false;
    int samples = 1;
    const char *picture = NULL;
    if (command_line_answered(argc, argv, NAME, USAGE)) return 0;
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], "--window") == 0) window = true;
        else if (strcmp(argv[i], "--check") == 0) check = true;
        else if (strcmp(argv[i], "--samples") == 0) {
            if (i + 1 == argc) return command_line_refused(NAME, argv[i], "no value after ");
            if (!command_line_number(NAME, argv[i], argv[i + 1], 1, 4, &samples)) return 2;
            if (samples != 1 && samples != 4) return command_line_refused(NAME, argv[i + 1], "--samples must be 1 or 4, got ");
            i++;
        } else if (argv[i][0] == '-' || picture) return command_line_unknown(NAME, argv[i]);
        else picture = argv[i];
    }
    const int complaints = window ? run_window((uint32_t)samples, check, picture) : run_offscreen(picture);
    if (complaints > 0) {
        fprintf(stderr, "%d complaints of the validation layer\n", complaints);
        return 1;
    }
    printf("ok\n");
    return 0;
}
