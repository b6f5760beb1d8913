//! Probe of the fog: draws targets behind fog of a given visibility and measures their contrast and transmittance
//! (`probe fog --visibility V`). It calls the functions of the composition's shader (`view_range`, `fog_along`,
//! `fog_apply`) with a synthetic depth buffer.

use glam::{DVec2, DVec3};

use super::{
    layer::{FogLayer, Law, Profile},
    model::FogModel,
    uniforms::LowAirUniform,
    viewpoint::{FogLight, Viewpoint},
    visibility::koschmieder_extinction_per_m,
};
use crate::{
    error::{Result, check_range},
    gpu::{
        Device,
        bind::{self, Slot},
        flat_texture,
        pass::{self, FullscreenDesc},
        readback,
    },
    scene::{Camera, DepthMapping, DepthUniform, ViewRays},
};

/// Width of the synthetic picture, pixels.
const WIDTH: u32 = 256;
/// Near plane, m: so near that a distance of 0 has no visible error.
const NEAR_M: f64 = 1e-6;

/// Measures, for each of `distances_m` (\[0, 1e9\] m), the contrast that is left and the transmittance at 550 nm in a
/// flat homogeneous layer of visibility `visibility_m` (\[1, 1e6\] m), as the GPU draws it.
///
/// The contrast is measured in the drawn picture: the difference between a white and a black target behind the fog.
///
/// # Errors
/// [`crate::Status::InvalidArgument`] naming the parameter; GPU faults.
pub fn probe(device: &Device, visibility_m: f64, distances_m: &[f64]) -> Result<Vec<[f64; 2]>> {
    check_range("visibility_m", visibility_m, 1.0, 1e6, "m")?;
    for d in distances_m {
        check_range("distance_m", *d, 0.0, 1e9, "m")?;
    }
    let Some(height) = std::num::NonZeroU32::new((distances_m.len() as u32).div_ceil(WIDTH)) else {
        return Ok(Vec::new());
    };
    let height = height.get();
    // The vertical field of view is so small that no ray leaves the layer before the contrast is 0.
    let mut camera = Camera::look_to(DVec3::ZERO, DVec3::Y, DVec3::Z, 0.02, 60.0, NEAR_M);
    // Hosts pass f32 matrices.
    camera.projection = camera.projection.as_mat4().as_dmat4();
    let rays = ViewRays::new(&camera, &DepthMapping { reversed: true, ..Default::default() })?;
    let mut fog = LowAirUniform::default();
    fog.set(&model(visibility_m)?);
    let depths: Vec<f32> = (0..WIDTH * height)
        .map(|i| {
            let pixel = DVec2::new(f64::from(i % WIDTH) + 0.5, f64::from(i / WIDTH) + 0.5);
            let uv = pixel / DVec2::new(f64::from(WIDTH), f64::from(height));
            let distance = distances_m.get(i as usize).copied().unwrap_or(1.0).max(2.0 * NEAR_M);
            rays.depth_at(distance, DVec2::new(2.0 * uv.x - 1.0, 1.0 - 2.0 * uv.y)) as f32
        })
        .collect();
    let texels = draw(device, (&rays.uniform(), &fog), &depths, height)?;
    Ok(texels.iter().take(distances_m.len()).map(|t| [f64::from(t[0] - t[1]), f64::from(t[2])]).collect())
}

/// Returns a layer that fills all the air, under a grey sky.
fn model(visibility_m: f64) -> Result<FogModel> {
    let layer = FogLayer {
        profile: Profile::Slab { base_m: -1e5, top_m: 1e6, base_softness_m: 0.0, top_softness_m: 0.0 },
        ..FogLayer::ground_fog(koschmieder_extinction_per_m(visibility_m), 1.0, 0.0)
    };
    let light =
        FogLight { to_sun: DVec3::Z, sun_irradiance: [0.0; 3], sky_irradiance: [1.0; 3], ground_albedo: [0.2; 3] };
    FogModel::new(&Law::Layer(layer), &light, &Viewpoint::flat(2.0))
}

/// Draws one pixel for each of `depths` and reads the texels back. Each texel has three values at 550 nm: the white
/// target behind the fog, the black target behind it, and the transmittance.
fn draw(
    device: &Device,
    (depth, fog): (&DepthUniform, &LowAirUniform),
    depths: &[f32],
    height: u32,
) -> Result<Vec<[f32; 4]>> {
    let gpu = &device.device;
    let texture = |format, usage| flat_texture(gpu, "fog probe", (WIDTH, height), format, usage);
    // Software OpenGL cannot render to 32-bit floats.
    let wide = device.adapter.get_texture_format_features(wgpu::TextureFormat::Rgba32Float).allowed_usages;
    let format = if wide.contains(wgpu::TextureUsages::RENDER_ATTACHMENT) {
        wgpu::TextureFormat::Rgba32Float
    } else {
        wgpu::TextureFormat::Rgba16Float
    };
    let target = texture(format, wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC);
    let source =
        texture(wgpu::TextureFormat::R32Float, wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST);
    let rows = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(WIDTH * 4), rows_per_image: None };
    device.queue.write_texture(source.as_image_copy(), bytemuck::cast_slice(depths), rows, source.size());
    let block = |bytes: &[u8]| {
        let buffer = bind::block(gpu, "fog probe", bytes.len());
        device.queue.write_buffer(&buffer, 0, bytes);
        buffer
    };
    let (depth, fog) = (block(bytemuck::bytes_of(depth)), block(bytemuck::bytes_of(fog)));
    let layout = layout(gpu);
    let pipeline = pass::fullscreen(
        device,
        &FullscreenDesc {
            shader: "fog/probe.wgsl",
            entry: "fog_probe",
            layouts: &[&layout],
            targets: &[format.into()],
            constants: &[],
            samples: 1,
        },
    )?;
    let group = gpu.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("fog probe"),
        layout: &layout,
        entries: &[
            wgpu::BindGroupEntry { binding: 0, resource: depth.as_entire_binding() },
            wgpu::BindGroupEntry { binding: 4, resource: fog.as_entire_binding() },
            wgpu::BindGroupEntry {
                binding: 1,
                resource: wgpu::BindingResource::TextureView(&source.create_view(&Default::default())),
            },
        ],
    });
    let mut encoder = gpu.create_command_encoder(&Default::default());
    pass::draw(&mut encoder, "fog probe", &pipeline, &[&group], &target.create_view(&Default::default()));
    device.submit_and_wait(encoder)?;
    readback::rgba(device, &target)
}

/// Creates the layout of the probe's bind group.
fn layout(gpu: &wgpu::Device) -> wgpu::BindGroupLayout {
    let slots = [
        (0, Slot::Uniform(size_of::<DepthUniform>())),
        (1, Slot::Texels),
        (4, Slot::Uniform(size_of::<LowAirUniform>())),
    ];
    bind::layout(gpu, "fog probe", wgpu::ShaderStages::FRAGMENT, &slots)
}
