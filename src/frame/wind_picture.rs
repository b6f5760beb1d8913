//! Diagnostic picture of the wind: the bind group 1 of its pipeline (`shaders/frame/wind_picture.wgsl`).

use bytemuck::{Pod, Zeroable};

use crate::{
    error::Result,
    gpu::{
        Device,
        bind::{self, Slot},
    },
    moment::SceneMoment,
    surroundings::WindMap,
};

/// Period after which positions repeat for the arrows, m: a distant position has too few digits in f32.
const PERIOD_M: f64 = 65_536.0;

/// `WindPicture` in the shader.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct WindUniform {
    map: WindMap,
    /// The weather's wind, m/s (east, north, up).
    weathers: [f32; 3],
    /// 1 if there is a wind that varies in space, else 0.
    varies: u32,
    /// Position of the camera east and north of a fixed point, m, modulo [`PERIOD_M`].
    eye: [f32; 2],
    pad: [u32; 2],
}

/// Layout and sampler of all wind pictures.
pub(super) struct WindPicture {
    pub layout: wgpu::BindGroupLayout,
    sampler: wgpu::Sampler,
}

impl WindPicture {
    pub fn new(device: &Device) -> Self {
        let slots = [(0, Slot::Uniform(size_of::<WindUniform>())), (1, Slot::FilteredVolume), (2, Slot::Sampler)];
        Self {
            layout: bind::layout(&device.device, "wind picture", wgpu::ShaderStages::FRAGMENT, &slots),
            sampler: device.device.create_sampler(&wgpu::SamplerDescriptor {
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                ..Default::default()
            }),
        }
    }

    /// Creates the bind group of the wind at a moment.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] for a time that the weather does not cover.
    pub fn bind(&self, device: &Device, now: &SceneMoment<'_>) -> Result<wgpu::BindGroup> {
        let (found, map) = now.wind_texture(device);
        let uniform = WindUniform {
            map: map.unwrap_or_default(),
            weathers: now.carrying()?.velocity_m_s().as_vec3().to_array(),
            varies: u32::from(map.is_some()),
            eye: [now.eye.x, now.eye.y].map(|v| v.rem_euclid(PERIOD_M) as f32),
            pad: [0; 2],
        };
        let block = bind::block(&device.device, "wind picture", size_of::<WindUniform>());
        device.write_buffer(&block, 0, bytemuck::bytes_of(&uniform));
        Ok(device.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("wind picture"),
            layout: &self.layout,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: block.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::TextureView(&found.view) },
                bind::sampler(2, &self.sampler),
            ],
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::shader;

    #[test]
    fn offsets_agree_with_the_shader() {
        shader::assert_layout!("frame/wind_picture.wgsl", "WindPicture", WindUniform, [map, weathers, varies, eye]);
    }
}
