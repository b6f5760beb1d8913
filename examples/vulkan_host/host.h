/* The host's own Vulkan: instance, device, queue, images. This file does not use Welkin. */
#ifndef VULKAN_HOST_H
#define VULKAN_HOST_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <vulkan/vulkan.h>

#include "sync.h"

/* Ends the program with a message if a Vulkan call fails. */
#define VK_CHECK(call) vk_check((call), #call, __FILE__, __LINE__)
void vk_check(VkResult result, const char *call, const char *file, int line);

#define EXPECT(condition, ...)                                              \
    do {                                                                    \
        if (!(condition)) {                                                 \
            fprintf(stderr, "%s:%d: %s: ", __FILE__, __LINE__, #condition); \
            fprintf(stderr, __VA_ARGS__);                                   \
            fputc('\n', stderr);                                            \
            exit(1);                                                        \
        }                                                                   \
    } while (0)

typedef struct image {
    VkImage handle;
    VkDeviceMemory memory; /* VK_NULL_HANDLE for a swapchain image */
    VkImageView view;
    VkFormat format;
    VkImageUsageFlags usage;
    uint32_t width, height, samples;
} image;

enum { MAX_NAMES = 4 };

typedef struct host {
    /* How instance and device were created. Welkin gets exactly the same. */
    VkApplicationInfo app;
    const char *instance_extensions[MAX_NAMES], *device_extensions[MAX_NAMES];
    uint32_t instance_extension_count;
    VkPhysicalDeviceFeatures features;
    VkDeviceQueueCreateInfo queue_info;
    VkDeviceCreateInfo device_info;

    VkInstance instance;
    VkDebugUtilsMessengerEXT messenger; /* VK_NULL_HANDLE without the validation layer */
    int complaints;                     /* number of messages from the validation layer */
    VkPhysicalDevice physical_device;
    uint32_t queue_family;
    VkDevice device;
    VkQueue queue;
    lock queue_lock; /* held during each use of the queue, including vkQueuePresentKHR and vkDeviceWaitIdle */
    VkCommandPool pool;
} host;

/* With a window, create its surface between these two calls. Otherwise pass `windowed` false and VK_NULL_HANDLE. */
void host_open_instance(host *h, bool windowed);
void host_open_device(host *h, VkSurfaceKHR surface);
void host_close_device(host *h);
void host_close_instance(host *h);

image host_image(host *h, VkFormat format, uint32_t width, uint32_t height, uint32_t samples, VkImageUsageFlags usage);
VkImageView host_view(host *h, const image *i);
void host_close_image(host *h, const image *i);

/* Begins a command buffer for one submission. */
VkCommandBuffer host_begin(host *h);
/* Submits it. Waits for `wait` and signals `signal` unless they are VK_NULL_HANDLE. With `finish`, waits until it is
 * done. */
void host_submit(host *h, VkCommandBuffer commands, VkSemaphore wait, VkSemaphore signal, bool finish);
/* Waits until the device is idle. Holds the lock meanwhile, because vkDeviceWaitIdle uses every queue. */
void host_wait(host *h);
/* Changes an image's layout, ordered after all earlier commands and before all later ones. */
void host_transition(VkCommandBuffer commands, const image *i, VkImageLayout from, VkImageLayout to);
/* Copies an image in TRANSFER_SRC_OPTIMAL to memory after `wait`: width * height * texel_bytes bytes. The caller frees
 * it. */
void *host_read(host *h, const image *i, uint32_t texel_bytes, VkSemaphore wait);

#endif
