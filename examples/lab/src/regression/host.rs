//! Draws a scene like a host: its own picture and depth into its images, then Welkin's stages, then the displayed
//! picture.

use std::sync::Arc;

use glam::{DMat3, DVec2, DVec3};
use image::RgbImage;
use welkin::{
    Result,
    context::{Context, ContextDesc, GivenDirection},
    frame::{Frame, FrameFlags, Shared, Stages, View, tone},
    gpu::{Device, DeviceOptions, readback},
    plan::Budget,
    scene::{Camera, ViewRays},
    sky::sun::direction,
};

use super::{
    scene::{Normals, SIZE, Scene, Target},
    world::{Hit, albedo, illuminance},
};

/// Writes a picture and its depth into single-sampled images of any format; takes every second texel of a finer
/// picture.
const COPY: &str = "
@group(0) @binding(0) var source: texture_2d<f32>;
@vertex fn corner(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
    return vec4f(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}
fn place(at: vec4f) -> vec2i { return vec2i(at.xy) * i32(textureDimensions(source).x / 240u); }
@fragment fn color(@builtin(position) at: vec4f) -> @location(0) vec4f { return textureLoad(source, place(at), 0); }
@fragment fn depth(@builtin(position) at: vec4f) -> @builtin(frag_depth) f32 { return textureLoad(source, place(at), 0).x; }
";
/// Writes a picture and its depth into multisampled images, with a different texel per sample.
const COPY_SAMPLES: &str = "
@group(0) @binding(0) var source: texture_2d<f32>;
@vertex fn corner(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
    return vec4f(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}
fn place(at: vec4f, i: u32) -> vec2i { return 2 * vec2i(at.xy) + vec2i(i32(i & 1u), i32((i >> 1u) & 1u)); }
@fragment fn color(@builtin(position) at: vec4f, @builtin(sample_index) i: u32) -> @location(0) vec4f {
    return textureLoad(source, place(at, i), 0);
}
@fragment fn depth(@builtin(position) at: vec4f, @builtin(sample_index) i: u32) -> @builtin(frag_depth) f32 {
    return textureLoad(source, place(at, i), 0).x;
}
";

type Rig = (Arc<Device>, Arc<Shared>);

/// The devices for drawing scenes, created when a scene first needs them.
#[derive(Default)]
pub struct Devices {
    usual: Option<Rig>,
    /// `None` until tried, then the result.
    tier_0: Option<Option<Rig>>,
}

impl Devices {
    fn of(&mut self, scene: &Scene) -> Result<Option<Rig>> {
        let rig = |options: &DeviceOptions| -> Result<Rig> {
            let device = Device::headless(options)?;
            let shared = Arc::new(Shared::new(&device)?);
            Ok((device, shared))
        };
        if scene.tier_0 {
            let options = DeviceOptions { backends: wgpu::Backends::GL, force_tier0: true, ..Default::default() };
            return Ok(self.tier_0.get_or_insert_with(|| rig(&options).ok()).clone());
        }
        if self.usual.is_none() {
            self.usual = Some(rig(&DeviceOptions::default())?);
        }
        Ok(self.usual.clone())
    }

    /// The scene as a display shows it; `None` if this machine has no device for it.
    ///
    /// # Errors
    /// GPU faults, and values that Welkin refuses.
    pub fn draw(&mut self, scene: &Scene) -> Result<Option<RgbImage>> {
        let Some((device, shared)) = self.of(scene)? else { return Ok(None) };
        let mut context = context(scene, &device, &shared)?;
        let turns: &[f64] = if scene.second_view { &[0.0, 50.0] } else { &[0.0] };
        let mut channels = Vec::new();
        for turn in turns {
            channels.push(Channel::new(scene, &context, scene.camera(*turn))?);
        }
        if !scene.flags.has(FrameFlags::NO_HISTORY) && scene.windscreen.is_some() {
            context.build_sky(&mut |_| true)?;
        }
        for frame in 0..=scene.frames_before {
            context.update(scene.time_s - f64::from(scene.frames_before - frame) * scene.frame_s)?;
            for channel in &mut channels {
                // Water runs down a windscreen in every frame, but only the last picture is wanted.
                let running = scene.windscreen.is_some() && frame < scene.frames_before;
                let calls = if running { &[Stages::PREPARE] } else { &scene.calls[..] };
                channel.record(scene, &context, u64::from(frame) + 1, calls)?;
            }
        }
        let mut picture = RgbImage::new(SIZE.0, SIZE.1 * channels.len() as u32);
        for (i, channel) in channels.iter().enumerate() {
            image::imageops::replace(&mut picture, &channel.shown(scene)?, 0, i64::from(SIZE.1) * i as i64);
        }
        Ok(Some(picture))
    }
}

fn context(scene: &Scene, device: &Arc<Device>, shared: &Arc<Shared>) -> Result<Context> {
    let desc = ContextDesc {
        sky: scene.sky,
        seed: 11,
        world: scene.frame,
        tone: scene.tone,
        ground: scene.ground,
        ..ContextDesc::default()
    };
    let mut context = Context::new(device.clone(), shared.clone(), desc)?;
    let given = |[azimuth_deg, elevation_deg]: [f64; 2]| GivenDirection { azimuth_deg, elevation_deg };
    context.set_sun(Some(given(scene.sun)))?;
    context.set_moon(scene.moon.map(given))?;
    for (weather, start_s, transition_s) in &scene.weather {
        context.set_weather(weather, *start_s, *transition_s)?;
    }
    context.set_fog_law(scene.law)?;
    (scene.dress)(device, &mut context)?;
    Ok(context)
}

/// Images and view of one camera.
struct Channel {
    device: Arc<Device>,
    view: View,
    camera: Camera,
    color: wgpu::Texture,
    depth: wgpu::Texture,
    mask: Option<wgpu::Texture>,
    classes: Option<wgpu::Texture>,
    normals: Option<wgpu::Texture>,
    /// The host's picture and depth as uploaded, at twice the size for multisampling.
    drawn: [wgpu::Texture; 2],
}

fn texture(device: &Device, size: (u32, u32), format: wgpu::TextureFormat, samples: u32) -> wgpu::Texture {
    use wgpu::TextureUsages as U;
    let mut usage = U::TEXTURE_BINDING;
    // Some drivers cannot draw into 32-bit floats; depth in that format is only uploaded.
    if format != wgpu::TextureFormat::R32Float {
        usage |= U::RENDER_ATTACHMENT | U::COPY_SRC;
    }
    if samples == 1 && !format.has_depth_aspect() {
        usage |= U::COPY_DST;
    }
    device.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: size.0, height: size.1, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: samples,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    })
}

/// Creates a texture from these texels, row by row.
pub fn uploaded(device: &Device, size: (u32, u32), format: wgpu::TextureFormat, bytes: &[u8]) -> wgpu::Texture {
    let made = texture(device, size, format, 1);
    let row = bytes.len() as u32 / size.1;
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None };
    device.queue.write_texture(made.as_image_copy(), bytes, layout, made.size());
    made
}

/// Luminance of the value 1 in a scene-linear picture, cd/m^2: for day, dusk or night.
fn unit(scene: &Scene) -> f64 {
    match scene.sun[1] {
        e if e > 0.0 => 1000.0,
        e if e > -6.0 => 10.0,
        _ => 1e-3,
    }
}

/// The host's colour of a hit, in its own colour space.
fn paint(scene: &Scene, hit: &Hit) -> [f64; 3] {
    let night = scene.sun[1] < -6.0;
    let [azimuth, elevation] = if night { scene.moon.unwrap_or([0.0, 20.0]) } else { scene.sun };
    let clouds = scene.weather.last().map_or(&[][..], |(w, ..)| &w.clouds);
    let deck = clouds.iter().map(|c| c.cover).fold(0.0, f64::max);
    let lux = illuminance(hit.normal, direction(azimuth, elevation), night, deck);
    albedo(hit).map(|a| match scene.target {
        Target::SceneLinear => (a * lux / std::f64::consts::PI / unit(scene)).min(6e4),
        _ => {
            let value = (a * 2.0 * (0.4 + 0.6 * hit.normal.z)).min(1.0) * if night { 0.02 } else { 1.0 };
            if scene.target == Target::SrgbBytes { tone::srgb_encode(value) } else { value }
        }
    })
}

/// The hits of a camera's rays, row by row in the textures' order, for a picture `fine` times as large in each
/// direction.
fn hits(scene: &Scene, camera: &Camera, fine: u32) -> Result<Vec<(DVec2, Option<Hit>)>> {
    let rays = ViewRays::new(camera, &scene.depth.mapping())?;
    let origin = scene.origin();
    let to_enu = scene.frame.frame_at(origin).world_to_enu;
    let (w, h) = (SIZE.0 * fine, SIZE.1 * fine);
    let of = |i: u32| {
        let (x, y) = (f64::from(i % w) + 0.5, f64::from(i / w) + 0.5);
        let down = 1.0 - 2.0 * y / f64::from(h);
        let ndc = DVec2::new(2.0 * x / f64::from(w) - 1.0, if scene.bottom_left { -down } else { down });
        let ray = rays.view_ray(ndc);
        let eye = to_enu * (camera.position - origin + ray.origin);
        (ndc, scene.world.cast(eye, to_enu * ray.direction))
    };
    Ok((0..w * h).map(of).collect())
}

impl Channel {
    fn new(scene: &Scene, context: &Context, camera: Camera) -> Result<Self> {
        let device = context.device().clone();
        let mut view = View::new(context)?;
        view.set_rain(scene.rain)?;
        if let Some(rungs) = &scene.pinned {
            view.set_budget(Budget::pinned(rungs))?;
        }
        let fine = if scene.samples[1] > 1 { 2 } else { 1 };
        let met = hits(scene, &camera, fine)?;
        let drawn = Self::picture(scene, &device, &camera, fine, &met)?;
        let whole = if fine == 1 { met } else { hits(scene, &camera, 1)? };
        let image = |format, bytes: &[u8]| uploaded(&device, SIZE, format, bytes);
        let mask = scene.masked.then(|| {
            let kept = |i: u32| if i % SIZE.0 < 40 { 255 } else { 0 };
            image(wgpu::TextureFormat::R8Unorm, &(0..SIZE.0 * SIZE.1).map(kept).collect::<Vec<u8>>())
        });
        let classes = scene.classes.then(|| {
            let bytes: Vec<u8> = whole.iter().map(|(_, h)| h.map_or(0, |h| h.class as u8)).collect();
            image(wgpu::TextureFormat::R8Unorm, &bytes)
        });
        let normals = (scene.normals != Normals::None).then(|| {
            let origin = scene.frame.frame_at(scene.origin()).world_to_enu.transpose();
            let turn = if scene.normals == Normals::Eye { camera.rotation() * origin } else { origin };
            image(wgpu::TextureFormat::Rgba16Float, bytemuck::cast_slice(&normal_texels(turn, &whole)))
        });
        let color = texture(&device, SIZE, scene.target.format(), scene.samples[0]);
        let depth = texture(&device, SIZE, scene.depth_format, scene.samples[1]);
        Ok(Self { device, view, camera, color, depth, mask, classes, normals, drawn })
    }

    /// The host's picture and depth.
    fn picture(
        scene: &Scene,
        device: &Device,
        camera: &Camera,
        fine: u32,
        met: &[(DVec2, Option<Hit>)],
    ) -> Result<[wgpu::Texture; 2]> {
        let mapping = scene.depth.mapping();
        let rays = ViewRays::new(camera, &mapping)?;
        let to_enu = scene.frame.frame_at(scene.origin()).world_to_enu;
        let eye = to_enu * (camera.position - scene.origin());
        let (mut colors, mut depths) = (Vec::new(), Vec::new());
        for (ndc, hit) in met {
            let color = hit.map_or([0.0; 3], |h| paint(scene, &h));
            colors.extend(color.iter().chain(&[1.0]).map(|v| half::f16::from_f64(*v).to_bits()));
            let from = to_enu * rays.view_ray(*ndc).origin;
            depths.push(hit.map_or(mapping.far_depth(), |h| rays.depth_at((h.at - eye - from).length(), *ndc)) as f32);
        }
        let size = (SIZE.0 * fine, SIZE.1 * fine);
        Ok([
            uploaded(device, size, wgpu::TextureFormat::Rgba16Float, bytemuck::cast_slice(&colors)),
            uploaded(device, size, wgpu::TextureFormat::R32Float, bytemuck::cast_slice(&depths)),
        ])
    }

    /// Copies one of the host's uploaded textures into its image.
    fn copy(&self, encoder: &mut wgpu::CommandEncoder, source: &wgpu::Texture, to: &wgpu::Texture) {
        let device = &self.device.device;
        let multi = source.width() > to.width() && to.sample_count() > 1;
        let code = if multi { COPY_SAMPLES } else { COPY };
        let source_code = wgpu::ShaderSource::Wgsl(code.into());
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source: source_code });
        let deep = to.format().has_depth_aspect();
        let targets = [Some(to.format().into())];
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: None,
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("corner"),
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: Default::default(),
            depth_stencil: deep.then(|| wgpu::DepthStencilState {
                format: to.format(),
                depth_write_enabled: Some(true),
                depth_compare: Some(wgpu::CompareFunction::Always),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: wgpu::MultisampleState { count: to.sample_count(), ..Default::default() },
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some(if deep { "depth" } else { "color" }),
                compilation_options: Default::default(),
                targets: if deep { &[] } else { &targets },
            }),
            multiview_mask: None,
            cache: None,
        });
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &pipeline.get_bind_group_layout(0),
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: wgpu::BindingResource::TextureView(&source.create_view(&Default::default())),
            }],
        });
        let view = to.create_view(&Default::default());
        let mut pass = pass_into(encoder, &view, None, deep);
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
    }

    /// Draws the host's picture again and records the calls of a frame over it.
    fn record(&mut self, scene: &Scene, context: &Context, frame_id: u64, calls: &[Stages]) -> Result<()> {
        let mut encoder = self.device.device.create_command_encoder(&Default::default());
        self.copy(&mut encoder, &self.drawn[0], &self.color);
        self.copy(&mut encoder, &self.drawn[1], &self.depth);
        self.device.submit_and_wait(encoder)?;
        if let Some(screen) = scene.windscreen {
            self.view.set_windscreen(Some(&screen(context.time_s())))?;
        }
        let mut frame = Frame::new(frame_id, self.camera, &self.color, Some(&self.depth));
        frame.depth_mapping = scene.depth.mapping();
        frame.color_space = scene.target.space();
        frame.cd_m2_per_unit = unit(scene);
        frame.exposure = scene.exposure;
        frame.origin_bottom_left = scene.bottom_left;
        frame.flags = scene.flags;
        if scene.normals == Normals::Eye {
            frame.flags.0 |= FrameFlags::NORMALS_IN_EYE_SPACE.0;
        }
        frame.camera_velocity_m_s = scene.velocity_m_s;
        (frame.mask, frame.surface_classes, frame.normals) =
            (self.mask.as_ref(), self.classes.as_ref(), self.normals.as_ref());
        for stages in calls {
            self.view.record(context, &frame, *stages)?;
        }
        Ok(())
    }

    /// The colour as displayed: resolved, the right way up, encoded.
    fn shown(&self, scene: &Scene) -> Result<RgbImage> {
        let single = if scene.samples[0] > 1 {
            let to = texture(&self.device, SIZE, scene.target.format(), 1);
            let (from, into) = (self.color.create_view(&Default::default()), to.create_view(&Default::default()));
            let mut encoder = self.device.device.create_command_encoder(&Default::default());
            drop(pass_into(&mut encoder, &from, Some(&into), false));
            self.device.submit_and_wait(encoder)?;
            to
        } else {
            self.color.clone()
        };
        let texels = readback::rgba(&self.device, &single)?;
        let encoded = matches!(scene.target, Target::SrgbView | Target::SrgbBytes);
        let byte = |v: f32| {
            let v = f64::from(v).clamp(0.0, 1.0);
            (255.0 * if encoded { v } else { tone::srgb_encode(v) } + 0.5) as u8
        };
        Ok(RgbImage::from_fn(SIZE.0, SIZE.1, |x, y| {
            let row = if scene.bottom_left { SIZE.1 - 1 - y } else { y };
            let t = texels[(row * SIZE.0 + x) as usize];
            image::Rgb([byte(t[0]), byte(t[1]), byte(t[2])])
        }))
    }
}

/// Begins a pass into an image that keeps its contents, except for depth.
fn pass_into<'e>(
    encoder: &'e mut wgpu::CommandEncoder,
    view: &wgpu::TextureView,
    resolve_target: Option<&wgpu::TextureView>,
    deep: bool,
) -> wgpu::RenderPass<'e> {
    let color = wgpu::RenderPassColorAttachment {
        view,
        depth_slice: None,
        resolve_target,
        ops: wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store },
    };
    let colors = [Some(color)];
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: None,
        color_attachments: if deep { &[] } else { &colors },
        depth_stencil_attachment: deep.then_some(wgpu::RenderPassDepthStencilAttachment {
            view,
            depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store }),
            stencil_ops: None,
        }),
        ..Default::default()
    })
}

/// Rotated unit normals as half floats; zeros where there is no hit.
fn normal_texels(turn: DMat3, met: &[(DVec2, Option<Hit>)]) -> Vec<[u16; 4]> {
    let of = |h: &Option<Hit>| {
        let n = turn * h.map_or(DVec3::ZERO, |h| h.normal);
        [n.x, n.y, n.z, 0.0].map(|v| half::f16::from_f64(v).to_bits())
    };
    met.iter().map(|(_, h)| of(h)).collect()
}
