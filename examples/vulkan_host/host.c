/* The host's own Vulkan: instance with the validation layer where it is installed, device, images, a render pass. */
#include "host.h"

#include <stdio.h>
#include <stdlib.h>
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
    fprintf(stderr, "%s is not installed: the Vulkan calls are not checked\n", VALIDATION);
    return false;
}

static void open_instance(host *h)
{
    const char *layers[] = {VALIDATION}, *extensions[] = {VK_EXT_DEBUG_UTILS_EXTENSION_NAME};
    const uint32_t validated = layer_is_there();
    const VkApplicationInfo app = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO, .apiVersion = HOST_API_VERSION};
    const VkInstanceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                       .pApplicationInfo = &app,
                                       .enabledLayerCount = validated,
                                       .ppEnabledLayerNames = layers,
                                       .enabledExtensionCount = validated,
                                       .ppEnabledExtensionNames = extensions};
    VK_CHECK(vkCreateInstance(&info, NULL, &h->instance));
    if (validated) {
        const VkDebugUtilsMessengerCreateInfoEXT messenger = {
            .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
            .messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                               VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
            .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT,
            .pfnUserCallback = on_complaint,
            .pUserData = h};
        PFN_vkCreateDebugUtilsMessengerEXT create =
            (PFN_vkCreateDebugUtilsMessengerEXT)vkGetInstanceProcAddr(h->instance, "vkCreateDebugUtilsMessengerEXT");
        VK_CHECK(create(h->instance, &messenger, NULL, &h->messenger));
    }
}

/* The first device with a queue that draws and computes. */
static void choose_device(host *h)
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
            if ((families[f].queueFlags & needed) != needed) continue;
            h->physical_device = devices[i];
            h->queue_family = f;
            return;
        }
    }
    fprintf(stderr, "no Vulkan device draws and computes on one queue\n");
    exit(1);
}

void host_device_info(VkDeviceCreateInfo *info, VkDeviceQueueCreateInfo *queue, uint32_t family)
{
    static const float priority = 1.0f;
    *queue = (VkDeviceQueueCreateInfo){.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                       .queueFamilyIndex = family,
                                       .queueCount = 1,
                                       .pQueuePriorities = &priority};
    *info = (VkDeviceCreateInfo){.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                 .queueCreateInfoCount = 1,
                                 .pQueueCreateInfos = queue};
}

static void open_device(host *h)
{
    VkDeviceQueueCreateInfo queue;
    VkDeviceCreateInfo info;
    host_device_info(&info, &queue, h->queue_family);
    VK_CHECK(vkCreateDevice(h->physical_device, &info, NULL, &h->device));
    vkGetDeviceQueue(h->device, h->queue_family, 0, &h->queue);
    const VkCommandPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                          .queueFamilyIndex = h->queue_family};
    VK_CHECK(vkCreateCommandPool(h->device, &pool, NULL, &h->pool));
    const VkSemaphoreCreateInfo semaphore = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    VK_CHECK(vkCreateSemaphore(h->device, &semaphore, NULL, &h->drawn));
    VK_CHECK(vkCreateSemaphore(h->device, &semaphore, NULL, &h->weather));
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

static image open_image(host *h, VkFormat format, VkImageUsageFlags usage)
{
    image i = {.format = format, .usage = usage};
    const VkImageCreateInfo info = {.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                                    .imageType = VK_IMAGE_TYPE_2D,
                                    .format = format,
                                    .extent = {h->width, h->height, 1},
                                    .mipLevels = 1,
                                    .arrayLayers = 1,
                                    .samples = VK_SAMPLE_COUNT_1_BIT,
                                    .usage = usage};
    VK_CHECK(vkCreateImage(h->device, &info, NULL, &i.handle));
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(h->device, i.handle, &needs);
    i.memory = allocate(h, needs, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    VK_CHECK(vkBindImageMemory(h->device, i.handle, i.memory, 0));
    const VkImageViewCreateInfo view = {.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                        .image = i.handle,
                                        .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                        .format = format,
                                        .subresourceRange = {aspect(&i), 0, 1, 0, 1}};
    VK_CHECK(vkCreateImageView(h->device, &view, NULL, &i.view));
    return i;
}

static void close_image(host *h, image *i)
{
    vkDestroyImageView(h->device, i->view, NULL);
    vkDestroyImage(h->device, i->handle, NULL);
    vkFreeMemory(h->device, i->memory, NULL);
}

/* Colour, depth and mask in one pass; each ends in the layout in which Welkin is told to find it. */
static void open_pass(host *h)
{
    const VkImageLayout depth_layout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL;
    const VkImageLayout color_layout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    VkAttachmentDescription attachments[3];
    const image *images[3] = {&h->color, &h->mask, &h->depth};
    const VkImageLayout layouts[3] = {color_layout, color_layout, depth_layout};
    for (int i = 0; i < 3; i++) {
        attachments[i] = (VkAttachmentDescription){.format = images[i]->format,
                                                   .samples = VK_SAMPLE_COUNT_1_BIT,
                                                   .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                                   .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                                   .initialLayout = VK_IMAGE_LAYOUT_UNDEFINED,
                                                   .finalLayout = layouts[i]};
    }
    const VkAttachmentReference colors[2] = {{0, color_layout}, {1, color_layout}}, depth = {2, depth_layout};
    const VkSubpassDescription subpass = {.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS,
                                          .colorAttachmentCount = 2,
                                          .pColorAttachments = colors,
                                          .pDepthStencilAttachment = &depth};
    /* The frame before, or Welkin's reading of it, is over before this one is drawn. */
    const VkSubpassDependency after = {.srcSubpass = VK_SUBPASS_EXTERNAL,
                                       .srcStageMask = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                                       .dstStageMask = VK_PIPELINE_STAGE_ALL_GRAPHICS_BIT,
                                       .srcAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT,
                                       .dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT};
    const VkRenderPassCreateInfo pass = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
                                         .attachmentCount = 3,
                                         .pAttachments = attachments,
                                         .subpassCount = 1,
                                         .pSubpasses = &subpass,
                                         .dependencyCount = 1,
                                         .pDependencies = &after};
    VK_CHECK(vkCreateRenderPass(h->device, &pass, NULL, &h->render_pass));
    const VkImageView views[3] = {h->color.view, h->mask.view, h->depth.view};
    const VkFramebufferCreateInfo framebuffer = {.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
                                                 .renderPass = h->render_pass,
                                                 .attachmentCount = 3,
                                                 .pAttachments = views,
                                                 .width = h->width,
                                                 .height = h->height,
                                                 .layers = 1};
    VK_CHECK(vkCreateFramebuffer(h->device, &framebuffer, NULL, &h->framebuffer));
}

void host_open(host *h, uint32_t width, uint32_t height)
{
    *h = (host){.width = width, .height = height};
    open_instance(h);
    choose_device(h);
    open_device(h);
    const VkImageUsageFlags color = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT, read = VK_IMAGE_USAGE_SAMPLED_BIT;
    h->color = open_image(h, VK_FORMAT_R16G16B16A16_SFLOAT, color | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
    h->depth = open_image(h, VK_FORMAT_D32_SFLOAT, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | read);
    h->mask = open_image(h, VK_FORMAT_R8_UNORM, color | read);
    open_pass(h);
}

void host_close(host *h)
{
    vkDeviceWaitIdle(h->device);
    vkDestroyFramebuffer(h->device, h->framebuffer, NULL);
    vkDestroyRenderPass(h->device, h->render_pass, NULL);
    close_image(h, &h->color);
    close_image(h, &h->depth);
    close_image(h, &h->mask);
    vkDestroySemaphore(h->device, h->drawn, NULL);
    vkDestroySemaphore(h->device, h->weather, NULL);
    vkDestroyCommandPool(h->device, h->pool, NULL);
    vkDestroyDevice(h->device, NULL);
    if (h->messenger) {
        PFN_vkDestroyDebugUtilsMessengerEXT destroy =
            (PFN_vkDestroyDebugUtilsMessengerEXT)vkGetInstanceProcAddr(h->instance, "vkDestroyDebugUtilsMessengerEXT");
        destroy(h->instance, h->messenger, NULL);
    }
    vkDestroyInstance(h->instance, NULL);
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
    VK_CHECK(vkQueueSubmit(h->queue, 1, &info, VK_NULL_HANDLE));
    if (finish) {
        VK_CHECK(vkQueueWaitIdle(h->queue));
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
    const size_t size = (size_t)h->width * h->height * texel_bytes;
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
                                      .imageExtent = {h->width, h->height, 1}};
    vkCmdCopyImageToBuffer(commands, i->handle, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, buffer, 1, &region);
    host_submit(h, commands, wait, VK_NULL_HANDLE, true);
    void *mapped, *out = malloc(size);
    VK_CHECK(vkMapMemory(h->device, memory, 0, VK_WHOLE_SIZE, 0, &mapped));
    if (out) memcpy(out, mapped, size);
    vkDestroyBuffer(h->device, buffer, NULL);
    vkFreeMemory(h->device, memory, NULL);
    return out;
}
