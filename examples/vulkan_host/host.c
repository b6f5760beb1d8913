/* The host's own Vulkan: instance with the validation layer, device and images. */
#include "host.h"
#include "native.h"

#include <string.h>

static const char VALIDATION[] = "VK_LAYER_KHRONOS_validation";

void vk_check(VkResult result, const char *call, const char *file, int line)
{
    if (result >= 0) return;
    fprintf(stderr, "%s:%d: %s: VkResult %d\n", file, line, call, (int)result);
    exit(1);
}

static VKAPI_ATTR VkBool32 VKAPI_CALL on_complaint(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                                   VkDebugUtilsMessageTypeFlagsEXT kind,
                                                   const VkDebugUtilsMessengerCallbackDataEXT *data, void *user)
{
    (void)severity;
    (void)kind;
    fprintf(stderr, "validation: %s\n", data->pMessage);
    ++((host *)user)->complaints;
    return VK_FALSE;
}

static bool layer_is_there(void)
{
    VkLayerProperties layers[64];
    uint32_t count = 64;
    vkEnumerateInstanceLayerProperties(&count, layers);
    for (uint32_t i = 0; i < count; i++) {
        if (strcmp(layers[i].layerName, VALIDATION) == 0) return true;
    }
    EXPECT(getenv("WELKIN_WITHOUT_VALIDATION"), "%s is not installed; set WELKIN_WITHOUT_VALIDATION=1 to go without it",
           VALIDATION);
    return false;
}

void host_open_instance(host *h, bool windowed)
{
    *h = (host){.app = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO, .apiVersion = VK_API_VERSION_1_1}};
    lock_open(&h->queue_lock);
    const uint32_t validated = layer_is_there();
    if (windowed) {
        h->instance_extensions[h->instance_extension_count++] = VK_KHR_SURFACE_EXTENSION_NAME;
        h->instance_extensions[h->instance_extension_count++] = native_extension();
    }
    if (validated) h->instance_extensions[h->instance_extension_count++] = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
    const char *layers[] = {VALIDATION};
    const VkValidationFeatureEnableEXT checks[] = {VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
    const VkValidationFeaturesEXT synchronisation = {.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
                                                     .enabledValidationFeatureCount = 1,
                                                     .pEnabledValidationFeatures = checks};
    const VkInstanceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                       .pNext = validated ? &synchronisation : NULL,
                                       .pApplicationInfo = &h->app,
                                       .enabledLayerCount = validated,
                                       .ppEnabledLayerNames = layers,
                                       .enabledExtensionCount = h->instance_extension_count,
                                       .ppEnabledExtensionNames = h->instance_extensions};
    VK_CHECK(vkCreateInstance(&info, NULL, &h->instance));
    if (validated) {
        const VkDebugUtilsMessengerCreateInfoEXT messenger = {
            .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
            .messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                               VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
            .messageType =
                VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT,
            .pfnUserCallback = on_complaint,
            .pUserData = h};
        PFN_vkCreateDebugUtilsMessengerEXT create =
            (PFN_vkCreateDebugUtilsMessengerEXT)vkGetInstanceProcAddr(h->instance, "vkCreateDebugUtilsMessengerEXT");
        VK_CHECK(create(h->instance, &messenger, NULL, &h->messenger));
    }
}

/* Picks the first device with a queue that draws and computes, and that presents to the surface if there is one. */
static void choose_device(host *h, VkSurfaceKHR surface)
{
    VkPhysicalDevice devices[16];
    uint32_t count = 16;
    vkEnumeratePhysicalDevices(h->instance, &count, devices);
    const VkQueueFlags needed = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    for (uint32_t i = 0; i < count; i++) {
        VkQueueFamilyProperties families[32];
        uint32_t family_count = 32;
        vkGetPhysicalDeviceQueueFamilyProperties(devices[i], &family_count, families);
        for (uint32_t f = 0; f < family_count; f++) {
            VkBool32 presents = VK_TRUE;
            if (surface) VK_CHECK(vkGetPhysicalDeviceSurfaceSupportKHR(devices[i], f, surface, &presents));
            if ((families[f].queueFlags & needed) != needed || !presents) continue;
            h->physical_device = devices[i];
            h->queue_family = f;
            return;
        }
    }
    EXPECT(false, "no Vulkan device draws, computes and presents on one queue");
}

void host_open_device(host *h, VkSurfaceKHR surface)
{
    static const float priority = 1.0f;
    choose_device(h, surface);
    h->queue_info = (VkDeviceQueueCreateInfo){.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                              .queueFamilyIndex = h->queue_family,
                                              .queueCount = 1,
                                              .pQueuePriorities = &priority};
    /* Allows Welkin to draw into multisampled colour per sample. */
    VkPhysicalDeviceFeatures able;
    vkGetPhysicalDeviceFeatures(h->physical_device, &able);
    h->features.sampleRateShading = able.sampleRateShading;
    h->device_info = (VkDeviceCreateInfo){.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                          .queueCreateInfoCount = 1,
                                          .pQueueCreateInfos = &h->queue_info,
                                          .ppEnabledExtensionNames = h->device_extensions,
                                          .pEnabledFeatures = &h->features};
    /* Welkin returns images in the layout for presenting only if the device has this extension. */
    if (surface) h->device_extensions[h->device_info.enabledExtensionCount++] = VK_KHR_SWAPCHAIN_EXTENSION_NAME;
    VK_CHECK(vkCreateDevice(h->physical_device, &h->device_info, NULL, &h->device));
    vkGetDeviceQueue(h->device, h->queue_family, 0, &h->queue);
    const VkCommandPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                          .queueFamilyIndex = h->queue_family};
    VK_CHECK(vkCreateCommandPool(h->device, &pool, NULL, &h->pool));
}

void host_close_device(host *h)
{
    vkDestroyCommandPool(h->device, h->pool, NULL);
    vkDestroyDevice(h->device, NULL);
}

void host_close_instance(host *h)
{
    if (h->messenger) {
        PFN_vkDestroyDebugUtilsMessengerEXT destroy =
            (PFN_vkDestroyDebugUtilsMessengerEXT)vkGetInstanceProcAddr(h->instance, "vkDestroyDebugUtilsMessengerEXT");
        destroy(h->instance, h->messenger, NULL);
    }
    vkDestroyInstance(h->instance, NULL);
    lock_close(&h->queue_lock);
}

static VkDeviceMemory allocate(host *h, VkMemoryRequirements needs, VkMemoryPropertyFlags flags)
{
    VkPhysicalDeviceMemoryProperties memory;
    vkGetPhysicalDeviceMemoryProperties(h->physical_device, &memory);
    for (uint32_t i = 0; i < memory.memoryTypeCount; i++) {
        if (!(needs.memoryTypeBits & (1u << i)) || (memory.memoryTypes[i].propertyFlags & flags) != flags) continue;
        const VkMemoryAllocateInfo info = {
            .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, .allocationSize = needs.size, .memoryTypeIndex = i};
        VkDeviceMemory made;
        VK_CHECK(vkAllocateMemory(h->device, &info, NULL, &made));
        return made;
    }
    fprintf(stderr, "no memory type serves\n");
    exit(1);
}

static VkImageAspectFlags aspect(const image *i)
{
    return i->format == VK_FORMAT_D32_SFLOAT ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
}

VkImageView host_view(host *h, const image *i)
{
    const VkImageViewCreateInfo info = {.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                        .image = i->handle,
                                        .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                        .format = i->format,
                                        .subresourceRange = {aspect(i), 0, 1, 0, 1}};
    VkImageView view;
    VK_CHECK(vkCreateImageView(h->device, &info, NULL, &view));
    return view;
}

image host_image(host *h, VkFormat format, uint32_t width, uint32_t height, uint32_t samples, VkImageUsageFlags usage)
{
    image i = {.format = format, .usage = usage, .width = width, .height = height, .samples = samples};
    const VkImageCreateInfo info = {.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                                    .imageType = VK_IMAGE_TYPE_2D,
                                    .format = format,
                                    .extent = {width, height, 1},
                                    .mipLevels = 1,
                                    .arrayLayers = 1,
                                    .samples = (VkSampleCountFlagBits)samples,
                                    .usage = usage};
    VK_CHECK(vkCreateImage(h->device, &info, NULL, &i.handle));
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(h->device, i.handle, &needs);
    i.memory = allocate(h, needs, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    VK_CHECK(vkBindImageMemory(h->device, i.handle, i.memory, 0));
    i.view = host_view(h, &i);
    return i;
}

void host_close_image(host *h, const image *i)
{
    vkDestroyImageView(h->device, i->view, NULL);
    if (i->memory) vkDestroyImage(h->device, i->handle, NULL); /* the swapchain destroys its own images */
    vkFreeMemory(h->device, i->memory, NULL);
}

void host_wait(host *h)
{
    lock_take(&h->queue_lock);
    VK_CHECK(vkDeviceWaitIdle(h->device));
    lock_give(&h->queue_lock);
}

VkCommandBuffer host_begin(host *h)
{
    const VkCommandBufferAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                              .commandPool = h->pool,
                                              .commandBufferCount = 1};
    const VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                            .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    VkCommandBuffer commands;
    VK_CHECK(vkAllocateCommandBuffers(h->device, &info, &commands));
    VK_CHECK(vkBeginCommandBuffer(commands, &begin));
    return commands;
}

void host_submit(host *h, VkCommandBuffer commands, VkSemaphore wait, VkSemaphore signal, bool finish)
{
    const VkPipelineStageFlags all = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
    const VkSubmitInfo info = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                               .waitSemaphoreCount = wait != VK_NULL_HANDLE,
                               .pWaitSemaphores = &wait,
                               .pWaitDstStageMask = &all,
                               .commandBufferCount = 1,
                               .pCommandBuffers = &commands,
                               .signalSemaphoreCount = signal != VK_NULL_HANDLE,
                               .pSignalSemaphores = &signal};
    VK_CHECK(vkEndCommandBuffer(commands));
    lock_take(&h->queue_lock);
    VK_CHECK(vkQueueSubmit(h->queue, 1, &info, VK_NULL_HANDLE));
    if (finish) VK_CHECK(vkQueueWaitIdle(h->queue));
    lock_give(&h->queue_lock);
    if (finish) {
        VK_CHECK(vkResetCommandPool(h->device, h->pool, VK_COMMAND_POOL_RESET_RELEASE_RESOURCES_BIT));
    }
}

void host_transition(VkCommandBuffer commands, const image *i, VkImageLayout from, VkImageLayout to)
{
    const VkAccessFlags all = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
    const VkImageMemoryBarrier barrier = {.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
                                          .srcAccessMask = all,
                                          .dstAccessMask = all,
                                          .oldLayout = from,
                                          .newLayout = to,
                                          .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                          .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                          .image = i->handle,
                                          .subresourceRange = {aspect(i), 0, 1, 0, 1}};
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0, NULL, 0,
                         NULL, 1, &barrier);
}

void *host_read(host *h, const image *i, uint32_t texel_bytes, VkSemaphore wait)
{
    const size_t size = (size_t)i->width * i->height * texel_bytes;
    const VkBufferCreateInfo info = {.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                                     .size = size,
                                     .usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT};
    VkBuffer buffer;
    VK_CHECK(vkCreateBuffer(h->device, &info, NULL, &buffer));
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(h->device, buffer, &needs);
    VkDeviceMemory memory =
        allocate(h, needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
    VK_CHECK(vkBindBufferMemory(h->device, buffer, memory, 0));
    VkCommandBuffer commands = host_begin(h);
    const VkBufferImageCopy region = {.imageSubresource = {aspect(i), 0, 0, 1},
                                      .imageExtent = {i->width, i->height, 1}};
    vkCmdCopyImageToBuffer(commands, i->handle, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, buffer, 1, &region);
    host_submit(h, commands, wait, VK_NULL_HANDLE, true);
    void *mapped, *out = malloc(size);
    VK_CHECK(vkMapMemory(h->device, memory, 0, VK_WHOLE_SIZE, 0, &mapped));
    if (out) memcpy(out, mapped, size);
    vkDestroyBuffer(h->device, buffer, NULL);
    vkFreeMemory(h->device, memory, NULL);
    return out;
}
