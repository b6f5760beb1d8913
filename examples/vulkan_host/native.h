/* The window, through the window system's own functions: native_x11.c and native_win32.c. */
#ifndef VULKAN_HOST_NATIVE_H
#define VULKAN_HOST_NATIVE_H

#include <stdbool.h>
#include <stdint.h>
#include <vulkan/vulkan.h>

typedef struct native {
    uint32_t width, height; /* size of the drawing area, pixels */
    bool open;
    bool resized; /* since the host last created images for it */
} native;

/* Name of the instance extension that creates a surface for this kind of window. */
const char *native_extension(void);

void native_open(native *n, uint32_t width, uint32_t height);
/* Handles the events since the last call. */
void native_take_events(native *n);
void native_resize(uint32_t width, uint32_t height);
VkSurfaceKHR native_surface(VkInstance instance);
void native_close(native *n);

#endif
