//! The tests' host: its images in every depth mapping, and the walls that it draws.

use super::*;

/// A host: its images, and a view of a context with a coarse sky.
pub struct Host {
    pub device: Arc<Device>,
    pub context: Context,
    pub view: View,
    pub color: wgpu::Texture,
    pub depth: wgpu::Texture,
    pub frame_id: u64,
}

pub fn texture(device: &Device, format: wgpu::TextureFormat, samples: u32) -> wgpu::Texture {
    crate::tests::textures::texture(device, SIZE, format, samples)
}

pub fn view_of(texture: &wgpu::Texture) -> wgpu::TextureView {
    texture.create_view(&Default::default())
}

/// One convention of a host's depth.
#[derive(Clone, Copy, Debug)]
pub struct Mapped {
    pub camera: Camera,
    pub mapping: DepthMapping,
}

/// Creates a convention with a camera that looks north and a little down; `projection` makes the matrix from a focal
/// length.
pub fn mapped(kind: DepthKind, reversed: bool, clip: ClipSpace, projection: impl Fn(f64) -> DMat4) -> Mapped {
    let mut camera = Camera::look_to(EYE, DVec3::new(0.05, 1.0, -0.12), DVec3::Z, 1.0, ASPECT, 0.5);
    camera.projection = projection(1.0 / 0.5f64.tan());
    Mapped { camera, mapping: DepthMapping { kind, reversed, clip } }
}

/// Perspective projection with clip z = a z + b, where z is the eye-space depth, and w = -z.
pub fn perspective(focal: f64, a: f64, b: f64) -> DMat4 {
    DMat4::from_cols(
        DVec4::new(focal / ASPECT, 0.0, 0.0, 0.0),
        DVec4::new(0.0, focal, 0.0, 0.0),
        DVec4::new(0.0, 0.0, a, -1.0),
        DVec4::new(0.0, 0.0, b, 0.0),
    )
}

/// Parallel projection of a picture 80 m high with clip z = a z + b and w = 1.
pub fn parallel(a: f64, b: f64) -> DMat4 {
    DMat4::from_cols(
        DVec4::new(1.0 / 40.0 / ASPECT, 0.0, 0.0, 0.0),
        DVec4::new(0.0, 1.0 / 40.0, 0.0, 0.0),
        DVec4::new(0.0, 0.0, a, 0.0),
        DVec4::new(0.0, 0.0, b, 1.0),
    )
}

pub fn mappings() -> [(&'static str, Mapped); 8] {
    use ClipSpace::{MinusOneToOne as Gl, ZeroToOne};
    use DepthKind::{Orthographic, Perspective};
    let (near, far) = (0.5, 2000.0);
    let log = DepthKind::Logarithmic { c: 0.01, far_m: 1e5 };
    [
        ("reversed, infinite", mapped(Perspective, true, ZeroToOne, |f| perspective(f, 0.0, near))),
        (
            "reversed, finite",
            mapped(Perspective, true, ZeroToOne, |f| perspective(f, near / (far - near), far * near / (far - near))),
        ),
        (
            "ordinary",
            mapped(Perspective, false, ZeroToOne, |f| perspective(f, -far / (far - near), -far * near / (far - near))),
        ),
        (
            "OpenGL's",
            mapped(Perspective, false, Gl, |f| {
                perspective(f, -(far + near) / (far - near), -2.0 * far * near / (far - near))
            }),
        ),
        ("orthographic", mapped(Orthographic, false, ZeroToOne, |_| parallel(-1.0 / far, 0.0))),
        ("orthographic, reversed, OpenGL's", mapped(Orthographic, true, Gl, |_| parallel(2.0 / far, 1.0))),
        ("logarithmic", mapped(log, false, Gl, |f| perspective(f, -1.0, -0.2))),
        ("logarithmic, reversed", mapped(log, true, ZeroToOne, |f| perspective(f, 0.0, near))),
    ]
}

impl Mapped {
    pub fn rays(&self) -> ViewRays {
        ViewRays::new(&self.camera, &self.mapping).unwrap()
    }
}

/// Normalised device coordinates of the middle of a pixel; pixels count from the picture's top left.
pub fn ndc(pixel: usize) -> DVec2 {
    let (x, y) = (pixel % SIZE.0 as usize, pixel / SIZE.0 as usize);
    DVec2::new((x as f64 + 0.5) / f64::from(SIZE.0) * 2.0 - 1.0, 1.0 - (y as f64 + 0.5) / f64::from(SIZE.1) * 2.0)
}

pub fn pixels() -> std::ops::Range<usize> {
    0..(SIZE.0 * SIZE.1) as usize
}

/// Distance along the pixel's ray to the host's wall, m: the wall is 60 m north of the camera, 24 m wide, from the
/// world's floor to 15 m.
pub fn to_wall(rays: &ViewRays, ndc: DVec2) -> f64 {
    let ray = rays.view_ray(ndc);
    let range = (60.0 - ray.origin.y) / ray.direction.y;
    let place = ray.origin + ray.direction * range + EYE;
    let hit = range > 0.0 && (place.x - EYE.x).abs() < 12.0 && (0.0..15.0).contains(&place.z);
    if hit { range } else { RANGE_SKY_M }
}

/// Distance along the pixel's ray to Welkin's plane, m, and the luminance of the square that the ray meets.
pub fn to_plane(rays: &ViewRays, ndc: DVec2) -> (f64, f64) {
    let ray = rays.view_ray(ndc);
    let range = (PLANE_M - EYE.z - ray.origin.z) / ray.direction.z;
    let place = ray.origin + ray.direction * range;
    if !(range > 0.0 && place.x.abs() < HALF_SIZE_M && place.y.abs() < HALF_SIZE_M) {
        return (RANGE_SKY_M, 0.0);
    }
    let square = ((place.x + EYE.x) / SQUARE_M).floor() + ((place.y + EYE.y) / SQUARE_M).floor();
    (range, CD_M2[square.rem_euclid(2.0) as usize])
}

const COVER: &str = "
@group(0) @binding(0) var depths: texture_2d<f32>;
@vertex fn corner(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
    return vec4f(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.5, 1.0);
}
struct Pixel { @location(0) color: vec4f, @builtin(frag_depth) depth: f32 }
@fragment fn host(@builtin(position) at: vec4f) -> Pixel {
    let texel = textureLoad(depths, vec2i(at.xy), 0);
    return Pixel(vec4f(vec3f(texel.g), 0.25), texel.r);
}
";
const READ: &str = "
@vertex fn corner(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
    return vec4f(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.5, 1.0);
}
@fragment fn read(@builtin(position) at: vec4f) -> @location(0) vec4f {
    return textureLoad(source, vec2i(at.xy), SAMPLE);
}
";

/// Creates the pipeline of a triangle over the whole picture, and the layout of its one texture.
fn covering(
    device: &wgpu::Device,
    text: &str,
    multisampled: bool,
    (color, depth): (&wgpu::Texture, Option<&wgpu::Texture>),
) -> (wgpu::RenderPipeline, wgpu::BindGroupLayout) {
    let source = wgpu::ShaderSource::Wgsl(text.into());
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
    let slots = [(0, Slot::texels(multisampled))];
    let layout = bind::layout(device, "covering", wgpu::ShaderStages::FRAGMENT, &slots);
    let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: &[Some(&layout)],
        immediate_size: 0,
    });
    let depth_stencil = depth.map(|texture| wgpu::DepthStencilState {
        format: texture.format(),
        depth_write_enabled: Some(true),
        depth_compare: Some(wgpu::CompareFunction::Always),
        stencil: Default::default(),
        bias: Default::default(),
    });
    let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: Some(&pipeline_layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: None,
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil,
        multisample: wgpu::MultisampleState { count: color.sample_count(), ..Default::default() },
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: None,
            compilation_options: Default::default(),
            targets: &[Some(color.format().into())],
        }),
        multiview_mask: None,
        cache: None,
    });
    (pipeline, layout)
}

/// Draws a triangle over the whole picture by a shader that reads `source` as its binding 0; depth is cleared before.
pub fn cover(
    device: &Device,
    text: &str,
    source: &wgpu::Texture,
    (color, depth): (&wgpu::Texture, Option<(&wgpu::Texture, f32)>),
) {
    let to = (color, depth.map(|d| d.0));
    let (pipeline, layout) = covering(&device.device, text, source.sample_count() > 1, to);
    let aspect = if source.format().has_depth_aspect() { wgpu::TextureAspect::DepthOnly } else { Default::default() };
    let view = source.create_view(&wgpu::TextureViewDescriptor { aspect, ..Default::default() });
    let group = device.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &layout,
        entries: &[wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(&view) }],
    });
    let (target, tested) = (view_of(color), depth.map(|(texture, _)| view_of(texture)));
    let store = wgpu::StoreOp::Store;
    let mut encoder = device.device.create_command_encoder(&Default::default());
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: &target,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load: wgpu::LoadOp::Load, store },
        })],
        depth_stencil_attachment: tested.as_ref().zip(depth).map(|(view, (texture, far))| {
            let stencil = texture.format().has_stencil_aspect();
            wgpu::RenderPassDepthStencilAttachment {
                view,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(far), store }),
                stencil_ops: stencil.then_some(wgpu::Operations { load: wgpu::LoadOp::Clear(0x5a), store }),
            }
        }),
        ..Default::default()
    });
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &group, &[]);
    pass.draw(0..3, 0..1);
    drop(pass);
    device.submit_and_wait(encoder).unwrap();
}

impl Host {
    pub fn new(color: wgpu::TextureFormat, depth: wgpu::TextureFormat, samples: u32) -> Self {
        let device = Device::headless(&DeviceOptions::default()).expect("a software driver is installed");
        let shared = Arc::new(Shared::new(&device).unwrap());
        let sky = SkySettings {
            orders: 3,
            suns: 16,
            altitudes: 8,
            zeniths: 9,
            azimuths: 5,
            rule_zeniths: 4,
            rule_azimuths: 6,
            build_panels: 2,
            ..SkySettings::default()
        };
        let context = Context::new(device.clone(), shared, ContextDesc { sky, ..ContextDesc::default() }).unwrap();
        let view = View::new(&context).unwrap();
        let (color, depth) = (texture(&device, color, samples), texture(&device, depth, samples));
        Self { device, context, view, color, depth, frame_id: 0 }
    }

    /// Draws the host's picture: its wall, and far depth around it; the first row is the picture's bottom if `bottom`.
    pub fn draw_own(&self, case: &Mapped, bottom: bool) {
        let rays = case.rays();
        let far = case.mapping.far_depth() as f32;
        let texels: Vec<[f32; 4]> = pixels()
            .map(|i| {
                let at = ndc(i) * if bottom { DVec2::new(1.0, -1.0) } else { DVec2::ONE };
                let range = to_wall(&rays, at);
                if range < RANGE_SKY_M {
                    [rays.depth_at(range, at) as f32, HOST_CD_M2, 0.0, 0.0]
                } else {
                    [far, BACK_CD_M2, 0.0, 0.0]
                }
            })
            .collect();
        let from = texture(&self.device, wgpu::TextureFormat::Rgba32Float, 1);
        let rows = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(16 * SIZE.0), rows_per_image: None };
        self.device.queue.write_texture(from.as_image_copy(), bytemuck::cast_slice(&texels), rows, from.size());
        cover(&self.device, COVER, &from, (&self.color, Some((&self.depth, far))));
    }

    /// Reads one sample of each pixel of a texture.
    pub fn read(&self, texture_of: &wgpu::Texture, sample: u32) -> Vec<[f32; 4]> {
        let kind = if texture_of.sample_count() > 1 { "texture_multisampled_2d" } else { "texture_2d" };
        let text =
            format!("@group(0) @binding(0) var source: {kind}<f32>;{}", READ.replace("SAMPLE", &sample.to_string()));
        let to = texture(&self.device, wgpu::TextureFormat::Rgba32Float, 1);
        cover(&self.device, &text, texture_of, (&to, None));
        readback::rgba(&self.device, &to).unwrap()
    }

    pub fn depths(&self, sample: u32) -> Vec<f32> {
        self.read(&self.depth, sample).iter().map(|p| p[0]).collect()
    }

    pub fn colors(&self) -> Vec<[f32; 4]> {
        self.read(&self.color, 0)
    }

    /// Records a frame with a new number, after `change` has modified it.
    pub fn record(&mut self, case: &Mapped, stages: Stages, change: impl FnOnce(&mut Frame<'_>)) {
        let (color, depth) = (self.color.clone(), self.depth.clone());
        self.frame_id += 1;
        let mut frame = Frame::new(self.frame_id, case.camera, &color, Some(&depth));
        (frame.depth_mapping, frame.depth_access) = (case.mapping, DepthAccess::ReadWrite);
        change(&mut frame);
        self.view.record(&self.context, &frame, stages).unwrap();
    }
}
