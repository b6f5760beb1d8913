/* The host's own Vulkan: instance, device, images, a render pass. Nothing here knows of Welkin. */
#ifndef VULKAN_HOST_H
#define VULKAN_HOST_H

#include <stdbool.h>
#include <stdint.h>
#include <vulkan/vulkan.h>

/* Ends the program with a sentence if a Vulkan call fails. */
#define VK_CHECK(call) vk_check((call), #call, __FILE__, __LINE__)
void vk_check(VkResult result, const char *call, const char *file, int line);

typedef struct image {
    VkImage handle;
    VkDeviceMemory memory;
    VkImageView view;
    VkFormat format;
    VkImageUsageFlags usage;
} image;

typedef struct host {
    uint32_t width, height;
    VkInstance instance;
    VkDebugUtilsMessengerEXT messenger; /* VK_NULL_HANDLE where the validation layer is not installed */
    int complaints;                     /* of the validation layer */
    VkPhysicalDevice physical_device;
    uint32_t queue_family;
    VkDevice device;
    VkQueue queue;
    VkCommandPool pool;
    VkRenderPass render_pass;
    VkFramebuffer framebuffer;
    VkSemaphore drawn, weather; /* host to Welkin, Welkin to host */
    image color, depth, mask;
} host;

/* The version that the instance is created with; Welkin is told the same. */
#define HOST_API_VERSION VK_API_VERSION_1_1

/* Fills in everything. */
void host_open(host *h, uint32_t width, uint32_t height);
/* What the device is created with: extensions and features, of which this host needs none. */
void host_device_info(VkDeviceCreateInfo *info, VkDeviceQueueCreateInfo *queue, uint32_t family);
void host_close(host *h);

/* One command buffer, begun for one submission. */
VkCommandBuffer host_begin(host *h);
/* Submits it; waits for `wait` and signals `signal` where they are not VK_NULL_HANDLE; waits for its end if asked. */
void host_submit(host *h, VkCommandBuffer commands, VkSemaphore wait, VkSemaphore signal, bool finish);
/* Changes an image's layout, ordered against everything before and after. */
void host_transition(VkCommandBuffer commands, const image *i, VkImageLayout from, VkImageLayout to);
/* Copies an image in TRANSFER_SRC_OPTIMAL to memory after `wait`: width * height * texel_bytes bytes, to be freed. */
void *host_read(host *h, const image *i, uint32_t texel_bytes, VkSemaphore wait);

#endif
