//! Features and extensions that a host enabled on its Vulkan device, and the limits that they set on what wgpu sees.
//!
//! wgpu's Vulkan backend looks at what the *physical* device supports, because it normally creates the logical device
//! itself. On a host's device it would then use features that the host has not enabled. So the results of wgpu's
//! feature queries are limited here to what is enabled.

use std::ffi::{CStr, c_void};

use ash::vk;

/// Vulkan features that the host enabled when it created its device, as far as Welkin uses them.
///
/// The default is that nothing is enabled. Welkin then works without timeline semaphores, robust-access shortcuts and
/// so on. To list a feature that is not enabled is undefined behaviour in the driver; to leave out an enabled one only
/// costs a little speed or a capability.
#[derive(Clone, Copy, Debug, Default)]
pub struct EnabledFeatures {
    /// `VkPhysicalDeviceFeatures` as enabled.
    pub core: vk::PhysicalDeviceFeatures,
    /// `timelineSemaphore` (Vulkan 1.2 or `VK_KHR_timeline_semaphore`); needed for timeline waits and signals.
    pub timeline_semaphore: bool,
    /// `multiview` (Vulkan 1.1 or `VK_KHR_multiview`).
    pub multiview: bool,
    /// `robustImageAccess` (Vulkan 1.3 or `VK_EXT_image_robustness`).
    pub robust_image_access: bool,
    /// `robustBufferAccess2` (`VK_EXT_robustness2`).
    pub robust_buffer_access2: bool,
    /// `robustImageAccess2` (`VK_EXT_robustness2`).
    pub robust_image_access2: bool,
    /// `shaderFloat16` (Vulkan 1.2 or `VK_KHR_shader_float16_int8`).
    pub shader_float16: bool,
    /// `shaderInt8` (Vulkan 1.2 or `VK_KHR_shader_float16_int8`).
    pub shader_int8: bool,
    /// `storageBuffer16BitAccess` (Vulkan 1.1 or `VK_KHR_16bit_storage`).
    pub storage_buffer_16bit: bool,
    /// `uniformAndStorageBuffer16BitAccess` (Vulkan 1.1 or `VK_KHR_16bit_storage`).
    pub uniform_and_storage_buffer_16bit: bool,
    /// `storageInputOutput16` (Vulkan 1.1 or `VK_KHR_16bit_storage`).
    pub storage_input_output_16: bool,
    /// `maintenance4` (Vulkan 1.3 or `VK_KHR_maintenance4`).
    pub maintenance4: bool,
    /// `shaderZeroInitializeWorkgroupMemory` (Vulkan 1.3 or the KHR extension).
    pub zero_initialize_workgroup_memory: bool,
    /// `shaderIntegerDotProduct` (Vulkan 1.3 or the KHR extension).
    pub shader_integer_dot_product: bool,
    /// `shaderDrawParameters` (Vulkan 1.1).
    pub shader_draw_parameters: bool,
    /// `synchronization2` (Vulkan 1.3 or the KHR extension); allows the layouts `READ_ONLY` and `ATTACHMENT`.
    pub synchronization2: bool,
    /// `separateDepthStencilLayouts` (Vulkan 1.2 or the KHR extension); allows the depth-only layouts.
    pub separate_depth_stencil_layouts: bool,
}

impl EnabledFeatures {
    /// Reads the chain that the host gave to `vkCreateDevice`: a `VkDeviceCreateInfo`, or the
    /// `VkPhysicalDeviceFeatures2` (or any other structure) that its `pNext` points to. Null means that nothing is
    /// enabled. Structures that Welkin does not know are skipped.
    ///
    /// # Safety
    /// `chain` must be null or point to a valid chain of Vulkan structures, as `vkCreateDevice` requires.
    pub unsafe fn from_chain(chain: *const c_void) -> Self {
        let mut enabled = Self::default();
        let mut next = chain.cast::<vk::BaseInStructure<'_>>();
        while !next.is_null() {
            // SAFETY: the caller vouches for every link of the chain, and each begins with sType and pNext.
            unsafe {
                enabled.read(next);
                next = (*next).p_next;
            }
        }
        enabled
    }

    /// Reads one structure of the chain.
    ///
    /// # Safety
    /// `s` must point to a valid structure of the type that its `sType` names.
    unsafe fn read(&mut self, s: *const vk::BaseInStructure<'_>) {
        use vk::StructureType as T;
        // SAFETY: sType names the type behind the pointer, which the caller vouches for; the enabled-features
        // pointer of VkDeviceCreateInfo is null or valid by the Vulkan specification.
        unsafe {
            match (*s).s_type {
                T::DEVICE_CREATE_INFO => {
                    if let Some(core) = (*s.cast::<vk::DeviceCreateInfo<'_>>()).p_enabled_features.as_ref() {
                        self.core = *core;
                    }
                }
                T::PHYSICAL_DEVICE_FEATURES_2 => {
                    self.core = (*s.cast::<vk::PhysicalDeviceFeatures2<'_>>()).features;
                }
                T::PHYSICAL_DEVICE_VULKAN_1_1_FEATURES => self.read_1_1(&*s.cast()),
                T::PHYSICAL_DEVICE_VULKAN_1_2_FEATURES => self.read_1_2(&*s.cast()),
                T::PHYSICAL_DEVICE_VULKAN_1_3_FEATURES => self.read_1_3(&*s.cast()),
                T::PHYSICAL_DEVICE_TIMELINE_SEMAPHORE_FEATURES => {
                    let f = &*s.cast::<vk::PhysicalDeviceTimelineSemaphoreFeatures<'_>>();
                    self.timeline_semaphore |= f.timeline_semaphore != 0;
                }
                T::PHYSICAL_DEVICE_MULTIVIEW_FEATURES => {
                    self.multiview |= (*s.cast::<vk::PhysicalDeviceMultiviewFeatures<'_>>()).multiview != 0;
                }
                T::PHYSICAL_DEVICE_IMAGE_ROBUSTNESS_FEATURES => {
                    let f = &*s.cast::<vk::PhysicalDeviceImageRobustnessFeatures<'_>>();
                    self.robust_image_access |= f.robust_image_access != 0;
                }
                T::PHYSICAL_DEVICE_ROBUSTNESS_2_FEATURES_EXT => {
                    let f = &*s.cast::<vk::PhysicalDeviceRobustness2FeaturesEXT<'_>>();
                    self.robust_buffer_access2 |= f.robust_buffer_access2 != 0;
                    self.robust_image_access2 |= f.robust_image_access2 != 0;
                }
                T::PHYSICAL_DEVICE_SHADER_FLOAT16_INT8_FEATURES => {
                    let f = &*s.cast::<vk::PhysicalDeviceShaderFloat16Int8Features<'_>>();
                    self.shader_float16 |= f.shader_float16 != 0;
                    self.shader_int8 |= f.shader_int8 != 0;
                }
                T::PHYSICAL_DEVICE_16BIT_STORAGE_FEATURES => {
                    let f = &*s.cast::<vk::PhysicalDevice16BitStorageFeatures<'_>>();
                    self.storage_buffer_16bit |= f.storage_buffer16_bit_access != 0;
                    self.uniform_and_storage_buffer_16bit |= f.uniform_and_storage_buffer16_bit_access != 0;
                    self.storage_input_output_16 |= f.storage_input_output16 != 0;
                }
                _ => self.read_1_3_parts(s),
            }
        }
    }

    /// Reads the structures with a single feature: those of Vulkan 1.3, that of draw parameters (1.1), and that of
    /// separate depth and stencil layouts (1.2).
    ///
    /// # Safety
    /// The requirements of [`Self::read`].
    unsafe fn read_1_3_parts(&mut self, s: *const vk::BaseInStructure<'_>) {
        use vk::StructureType as T;
        // SAFETY: as in `read`.
        unsafe {
            match (*s).s_type {
                T::PHYSICAL_DEVICE_MAINTENANCE_4_FEATURES => {
                    self.maintenance4 |= (*s.cast::<vk::PhysicalDeviceMaintenance4Features<'_>>()).maintenance4 != 0;
                }
                T::PHYSICAL_DEVICE_ZERO_INITIALIZE_WORKGROUP_MEMORY_FEATURES => {
                    let f = &*s.cast::<vk::PhysicalDeviceZeroInitializeWorkgroupMemoryFeatures<'_>>();
                    self.zero_initialize_workgroup_memory |= f.shader_zero_initialize_workgroup_memory != 0;
                }
                T::PHYSICAL_DEVICE_SHADER_INTEGER_DOT_PRODUCT_FEATURES => {
                    let f = &*s.cast::<vk::PhysicalDeviceShaderIntegerDotProductFeatures<'_>>();
                    self.shader_integer_dot_product |= f.shader_integer_dot_product != 0;
                }
                T::PHYSICAL_DEVICE_SHADER_DRAW_PARAMETERS_FEATURES => {
                    let f = &*s.cast::<vk::PhysicalDeviceShaderDrawParametersFeatures<'_>>();
                    self.shader_draw_parameters |= f.shader_draw_parameters != 0;
                }
                T::PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES => {
                    let f = &*s.cast::<vk::PhysicalDeviceSynchronization2Features<'_>>();
                    self.synchronization2 |= f.synchronization2 != 0;
                }
                T::PHYSICAL_DEVICE_SEPARATE_DEPTH_STENCIL_LAYOUTS_FEATURES => {
                    let f = &*s.cast::<vk::PhysicalDeviceSeparateDepthStencilLayoutsFeatures<'_>>();
                    self.separate_depth_stencil_layouts |= f.separate_depth_stencil_layouts != 0;
                }
                _ => {}
            }
        }
    }

    fn read_1_1(&mut self, f: &vk::PhysicalDeviceVulkan11Features<'_>) {
        self.multiview |= f.multiview != 0;
        self.storage_buffer_16bit |= f.storage_buffer16_bit_access != 0;
        self.uniform_and_storage_buffer_16bit |= f.uniform_and_storage_buffer16_bit_access != 0;
        self.storage_input_output_16 |= f.storage_input_output16 != 0;
        self.shader_draw_parameters |= f.shader_draw_parameters != 0;
    }

    fn read_1_2(&mut self, f: &vk::PhysicalDeviceVulkan12Features<'_>) {
        self.timeline_semaphore |= f.timeline_semaphore != 0;
        self.shader_float16 |= f.shader_float16 != 0;
        self.shader_int8 |= f.shader_int8 != 0;
        self.separate_depth_stencil_layouts |= f.separate_depth_stencil_layouts != 0;
    }

    fn read_1_3(&mut self, f: &vk::PhysicalDeviceVulkan13Features<'_>) {
        self.robust_image_access |= f.robust_image_access != 0;
        self.maintenance4 |= f.maintenance4 != 0;
        self.zero_initialize_workgroup_memory |= f.shader_zero_initialize_workgroup_memory != 0;
        self.shader_integer_dot_product |= f.shader_integer_dot_product != 0;
        self.synchronization2 |= f.synchronization2 != 0;
    }

    /// Removes the core features that are not enabled from those that the driver reports.
    pub(super) fn narrow_core(&self, reported: &mut vk::PhysicalDeviceFeatures) {
        const COUNT: usize = size_of::<vk::PhysicalDeviceFeatures>() / size_of::<vk::Bool32>();
        // SAFETY: VkPhysicalDeviceFeatures is a repr(C) block of VkBool32 (u32) and nothing else, so it is an
        // array of COUNT of them; both references are valid and do not overlap.
        let (enabled, reported) = unsafe {
            let enabled = &*(&raw const self.core).cast::<[vk::Bool32; COUNT]>();
            (enabled, &mut *(&raw mut *reported).cast::<[vk::Bool32; COUNT]>())
        };
        for (r, &e) in reported.iter_mut().zip(enabled) {
            *r = vk::Bool32::from(*r != 0 && e != 0);
        }
    }

    /// Removes features that are not enabled from a whole chain, as filled in by `vkGetPhysicalDeviceFeatures2`. A
    /// feature structure that [`Self::narrow`] does not change belongs to an extension that [`visible_extension`]
    /// hides, so wgpu never asks for it.
    ///
    /// # Safety
    /// `chain` must be a valid, filled chain.
    pub(super) unsafe fn narrow_chain(&self, chain: *mut vk::PhysicalDeviceFeatures2<'_>) {
        // SAFETY: the caller vouches for the chain; each link begins with sType and pNext.
        unsafe {
            self.narrow_core(&mut (*chain).features);
            let mut next = (*chain).p_next.cast::<vk::BaseOutStructure<'_>>();
            while !next.is_null() {
                self.narrow(next);
                next = (*next).p_next;
            }
        }
    }

    /// Removes features that are not enabled from one structure of a chain.
    ///
    /// # Safety
    /// `s` must point to a valid structure of the type that its `sType` names.
    unsafe fn narrow(&self, s: *mut vk::BaseOutStructure<'_>) {
        use vk::StructureType as T;
        let keep = |field: &mut vk::Bool32, enabled: bool| *field = vk::Bool32::from(*field != 0 && enabled);
        // SAFETY: sType names the type behind the pointer, which the caller vouches for.
        unsafe {
            match (*s).s_type {
                T::PHYSICAL_DEVICE_TIMELINE_SEMAPHORE_FEATURES => {
                    let f = &mut *s.cast::<vk::PhysicalDeviceTimelineSemaphoreFeatures<'_>>();
                    keep(&mut f.timeline_semaphore, self.timeline_semaphore);
                }
                T::PHYSICAL_DEVICE_MULTIVIEW_FEATURES => {
                    let f = &mut *s.cast::<vk::PhysicalDeviceMultiviewFeatures<'_>>();
                    keep(&mut f.multiview, self.multiview);
                    keep(&mut f.multiview_geometry_shader, false);
                    keep(&mut f.multiview_tessellation_shader, false);
                }
                T::PHYSICAL_DEVICE_SAMPLER_YCBCR_CONVERSION_FEATURES => {
                    let f = &mut *s.cast::<vk::PhysicalDeviceSamplerYcbcrConversionFeatures<'_>>();
                    keep(&mut f.sampler_ycbcr_conversion, false);
                }
                T::PHYSICAL_DEVICE_IMAGE_ROBUSTNESS_FEATURES => {
                    let f = &mut *s.cast::<vk::PhysicalDeviceImageRobustnessFeatures<'_>>();
                    keep(&mut f.robust_image_access, self.robust_image_access);
                }
                T::PHYSICAL_DEVICE_ROBUSTNESS_2_FEATURES_EXT => {
                    let f = &mut *s.cast::<vk::PhysicalDeviceRobustness2FeaturesEXT<'_>>();
                    keep(&mut f.robust_buffer_access2, self.robust_buffer_access2);
                    keep(&mut f.robust_image_access2, self.robust_image_access2);
                    keep(&mut f.null_descriptor, false);
                }
                T::PHYSICAL_DEVICE_SHADER_FLOAT16_INT8_FEATURES => {
                    let f = &mut *s.cast::<vk::PhysicalDeviceShaderFloat16Int8Features<'_>>();
                    keep(&mut f.shader_float16, self.shader_float16);
                    keep(&mut f.shader_int8, self.shader_int8);
                }
                T::PHYSICAL_DEVICE_16BIT_STORAGE_FEATURES => {
                    let f = &mut *s.cast::<vk::PhysicalDevice16BitStorageFeatures<'_>>();
                    keep(&mut f.storage_buffer16_bit_access, self.storage_buffer_16bit);
                    let uniform = self.uniform_and_storage_buffer_16bit;
                    keep(&mut f.uniform_and_storage_buffer16_bit_access, uniform);
                    keep(&mut f.storage_push_constant16, false);
                    keep(&mut f.storage_input_output16, self.storage_input_output_16);
                }
                _ => self.narrow_rest(s),
            }
        }
    }

    /// Removes features as [`Self::narrow`] does, from further structures of Vulkan 1.1 to 1.3. Features of 64-bit
    /// atomics, the memory model and subgroup sizes, which Welkin never uses, are always removed.
    ///
    /// # Safety
    /// The requirements of [`Self::narrow`].
    unsafe fn narrow_rest(&self, s: *mut vk::BaseOutStructure<'_>) {
        use vk::StructureType as T;
        let keep = |field: &mut vk::Bool32, enabled: bool| *field = vk::Bool32::from(*field != 0 && enabled);
        // SAFETY: as in `narrow`.
        unsafe {
            match (*s).s_type {
                T::PHYSICAL_DEVICE_MAINTENANCE_4_FEATURES => {
                    let f = &mut *s.cast::<vk::PhysicalDeviceMaintenance4Features<'_>>();
                    keep(&mut f.maintenance4, self.maintenance4);
                }
                T::PHYSICAL_DEVICE_ZERO_INITIALIZE_WORKGROUP_MEMORY_FEATURES => {
                    let f = &mut *s.cast::<vk::PhysicalDeviceZeroInitializeWorkgroupMemoryFeatures<'_>>();
                    let zero = self.zero_initialize_workgroup_memory;
                    keep(&mut f.shader_zero_initialize_workgroup_memory, zero);
                }
                T::PHYSICAL_DEVICE_SHADER_INTEGER_DOT_PRODUCT_FEATURES => {
                    let f = &mut *s.cast::<vk::PhysicalDeviceShaderIntegerDotProductFeatures<'_>>();
                    keep(&mut f.shader_integer_dot_product, self.shader_integer_dot_product);
                }
                T::PHYSICAL_DEVICE_SHADER_DRAW_PARAMETERS_FEATURES => {
                    let f = &mut *s.cast::<vk::PhysicalDeviceShaderDrawParametersFeatures<'_>>();
                    keep(&mut f.shader_draw_parameters, self.shader_draw_parameters);
                }
                T::PHYSICAL_DEVICE_SHADER_ATOMIC_INT64_FEATURES => {
                    let f = &mut *s.cast::<vk::PhysicalDeviceShaderAtomicInt64Features<'_>>();
                    keep(&mut f.shader_buffer_int64_atomics, false);
                    keep(&mut f.shader_shared_int64_atomics, false);
                }
                T::PHYSICAL_DEVICE_VULKAN_MEMORY_MODEL_FEATURES => {
                    let f = &mut *s.cast::<vk::PhysicalDeviceVulkanMemoryModelFeatures<'_>>();
                    keep(&mut f.vulkan_memory_model, false);
                    keep(&mut f.vulkan_memory_model_device_scope, false);
                    keep(&mut f.vulkan_memory_model_availability_visibility_chains, false);
                }
                T::PHYSICAL_DEVICE_SUBGROUP_SIZE_CONTROL_FEATURES => {
                    let f = &mut *s.cast::<vk::PhysicalDeviceSubgroupSizeControlFeatures<'_>>();
                    keep(&mut f.subgroup_size_control, false);
                    keep(&mut f.compute_full_subgroups, false);
                }
                _ => {}
            }
        }
    }
}

/// Device extensions that wgpu may see on a host's device, each with the core version that includes it (`u32::MAX` if
/// none does, 0 if wgpu always sees the extension). All others stay hidden: for them wgpu would enable code that a
/// host's device need not be prepared for (ray tracing, mesh shaders, external memory).
const DEVICE_EXTENSIONS: &[(&CStr, u32)] = &[
    (ash::khr::swapchain::NAME, u32::MAX),
    (ash::khr::swapchain_mutable_format::NAME, u32::MAX),
    (ash::khr::maintenance1::NAME, vk::API_VERSION_1_1),
    (ash::khr::maintenance2::NAME, vk::API_VERSION_1_1),
    (ash::khr::maintenance3::NAME, vk::API_VERSION_1_1),
    (ash::khr::storage_buffer_storage_class::NAME, vk::API_VERSION_1_1),
    (ash::khr::multiview::NAME, vk::API_VERSION_1_1),
    (ash::khr::_16bit_storage::NAME, vk::API_VERSION_1_1),
    (ash::khr::image_format_list::NAME, vk::API_VERSION_1_2),
    // Only queried on the physical device, for which it need not be enabled.
    (ash::khr::driver_properties::NAME, 0),
    (ash::khr::timeline_semaphore::NAME, vk::API_VERSION_1_2),
    (ash::khr::shader_float16_int8::NAME, vk::API_VERSION_1_2),
    (ash::khr::maintenance4::NAME, vk::API_VERSION_1_3),
    (ash::ext::image_robustness::NAME, vk::API_VERSION_1_3),
    (ash::khr::shader_integer_dot_product::NAME, vk::API_VERSION_1_3),
    (ash::khr::zero_initialize_workgroup_memory::NAME, vk::API_VERSION_1_3),
    (ash::ext::robustness2::NAME, u32::MAX),
    (ash::ext::memory_budget::NAME, u32::MAX),
];

/// Returns the extensions enabled by the host that wgpu may see, as static names.
pub(super) fn known_extensions(enabled: &[&CStr]) -> Vec<&'static CStr> {
    let known = DEVICE_EXTENSIONS.iter().map(|&(name, _)| name);
    known.filter(|name| enabled.contains(name)).collect()
}

/// Whether wgpu sees the device extension `name`: [`DEVICE_EXTENSIONS`] lists it, and the host enabled it or the core
/// version in force includes it.
pub(super) fn visible_extension(name: &CStr, enabled: &[&'static CStr], api_version: u32) -> bool {
    let row = DEVICE_EXTENSIONS.iter().find(|(known, _)| *known == name);
    row.is_some_and(|&(known, core_since)| enabled.contains(&known) || api_version >= core_since)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_chain_of_device_creation_is_read_whole() {
        let core = vk::PhysicalDeviceFeatures::default().sampler_anisotropy(true);
        let mut v12 = vk::PhysicalDeviceVulkan12Features::default().timeline_semaphore(true).shader_int8(true);
        let mut v13 = vk::PhysicalDeviceVulkan13Features::default().synchronization2(true);
        let mut unknown = vk::PhysicalDeviceMeshShaderFeaturesEXT::default().mesh_shader(true);
        let info = vk::DeviceCreateInfo::default()
            .enabled_features(&core)
            .push_next(&mut v12)
            .push_next(&mut unknown)
            .push_next(&mut v13);
        // SAFETY: `info` heads a valid chain that lives to the end of the test.
        let e = unsafe { EnabledFeatures::from_chain((&raw const info).cast()) };
        assert_eq!(e.core.sampler_anisotropy, vk::TRUE);
        assert!(e.timeline_semaphore && e.shader_int8 && e.synchronization2);
        assert!(!e.shader_float16 && !e.robust_image_access && !e.multiview);
        // SAFETY: null is allowed.
        let none = unsafe { EnabledFeatures::from_chain(std::ptr::null()) };
        assert!(!none.timeline_semaphore && none.core.sampler_anisotropy == vk::FALSE);
    }

    #[test]
    fn narrowing_keeps_only_what_is_both_reported_and_enabled() {
        let enabled = EnabledFeatures {
            core: vk::PhysicalDeviceFeatures::default().independent_blend(true).geometry_shader(true),
            timeline_semaphore: true,
            ..EnabledFeatures::default()
        };
        let mut timeline = vk::PhysicalDeviceTimelineSemaphoreFeatures::default().timeline_semaphore(true);
        let mut robust = vk::PhysicalDeviceRobustness2FeaturesEXT::default().robust_buffer_access2(true);
        let reported = vk::PhysicalDeviceFeatures::default().independent_blend(true).sampler_anisotropy(true);
        let mut all =
            vk::PhysicalDeviceFeatures2::default().features(reported).push_next(&mut timeline).push_next(&mut robust);
        // SAFETY: `all` heads a valid chain.
        unsafe { enabled.narrow_chain(&raw mut all) };
        assert_eq!(all.features.independent_blend, vk::TRUE);
        assert_eq!(all.features.sampler_anisotropy, vk::FALSE, "reported but not enabled");
        assert_eq!(all.features.geometry_shader, vk::FALSE, "enabled but not reported");
        assert_eq!(timeline.timeline_semaphore, vk::TRUE);
        assert_eq!(robust.robust_buffer_access2, vk::FALSE);
    }

    #[test]
    fn promoted_extensions_are_visible_from_their_core_version() {
        let name = ash::khr::timeline_semaphore::NAME;
        assert!(!visible_extension(name, &[], vk::API_VERSION_1_1));
        assert!(visible_extension(name, &[], vk::API_VERSION_1_2));
        assert!(visible_extension(name, &[name], vk::API_VERSION_1_0));
        assert!(!visible_extension(ash::khr::ray_query::NAME, &[ash::khr::ray_query::NAME], vk::API_VERSION_1_3));
    }
}
