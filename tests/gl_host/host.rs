//! A host of the tests: its contexts, its callbacks, and a small picture drawn through wgpu.

use std::ffi::{CStr, c_char, c_void};
use std::sync::atomic::{AtomicU32, Ordering};

use welkin::gpu::{
    HostBinding,
    gl::{GlDevice, GlHostDesc, GlMode, GlTarget, Handover, adopt},
};
use welkin_support::egl::{self, Api, Context, Window};

/// Argument of the callbacks.
pub struct Contexts {
    pub host: Context,
    pub welkin: Option<Context>,
    /// Number of calls of `make_current`.
    pub switches: AtomicU32,
    /// Value that `make_current` returns instead of switching, if it is not 0.
    pub refusal: AtomicU32,
}

pub unsafe extern "C" fn get_proc(_: *mut c_void, name: *const c_char) -> *const c_void {
    // SAFETY: Welkin passes NUL-terminated names.
    egl::proc_address(unsafe { CStr::from_ptr(name) })
}

pub unsafe extern "C" fn make_current(user: *mut c_void, which: u32) -> i32 {
    // SAFETY: `user` is what `Host::desc` passed.
    let contexts = unsafe { &*user.cast::<Contexts>() };
    contexts.switches.fetch_add(1, Ordering::Relaxed);
    let refusal = contexts.refusal.load(Ordering::Relaxed);
    if which == 1 && refusal != 0 {
        return refusal as i32;
    }
    let context = if which == 0 { &contexts.host } else { contexts.welkin.as_ref().unwrap() };
    if context.make_current() { 0 } else { -1 }
}

/// A host with its own OpenGL functions; its context is current on the thread that made it.
pub struct Host {
    pub contexts: Box<Contexts>,
    pub gl: glow::Context,
    pub mode: GlMode,
}

impl Host {
    pub fn new(api: Api, window: Window, mode: GlMode) -> Self {
        let host = Context::new(api, window);
        let welkin = (mode == GlMode::Shared).then(|| host.sharing());
        let gl = host.functions();
        let contexts = Box::new(Contexts { host, welkin, switches: AtomicU32::new(0), refusal: AtomicU32::new(0) });
        Self { contexts, gl, mode }
    }

    pub fn desc(&self) -> GlHostDesc {
        GlHostDesc {
            get_proc: Some(get_proc),
            make_current: (self.mode == GlMode::Shared).then_some(make_current as _),
            user: (&raw const *self.contexts).cast_mut().cast(),
            mode: self.mode,
            handover: Handover::Fence,
            force_tier0: false,
        }
    }

    pub fn adopt(&self) -> GlDevice {
        self.adopt_with(|_| {})
    }

    pub fn adopt_with(&self, change: impl FnOnce(&mut GlHostDesc)) -> GlDevice {
        let mut desc = self.desc();
        change(&mut desc);
        // SAFETY: the callbacks are those of this file, the contexts live as long as the host.
        let adopted = unsafe { adopt(&desc) }.unwrap_or_else(|e| panic!("{e}"));
        adopted.device.device.on_uncaptured_error(std::sync::Arc::new(|e| panic!("{e}")));
        assert!(self.contexts.host.is_current(), "the host's context is current again");
        adopted
    }
}

/// Drops the device, which enters the host's context by itself for that.
pub fn close(adopted: GlDevice) {
    assert_eq!(std::sync::Arc::strong_count(&adopted.device), 1);
    drop(adopted);
}

/// Input that the small picture reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Depth {
    None,
    One,
    /// Depth per sample, at sample rate.
    Many,
    /// The red of the picture as it was, instead of depth.
    OldColor,
    /// The red of the picture as it was, per sample.
    OldColors,
    /// The mask, instead of depth.
    Mask,
}

impl Depth {
    fn per_sample(self) -> bool {
        matches!(self, Self::Many | Self::OldColors)
    }
}

/// A full-screen picture: red rises to the right, green upwards as the host sees it, blue is the depth read, or
/// 0.25 without.
pub struct Picture {
    pipeline: wgpu::RenderPipeline,
    layout: Option<wgpu::BindGroupLayout>,
    reads: Depth,
}

const SHADER: &str = r"
struct Out { @builtin(position) at: vec4f, @location(0) ndc: vec2f }
override clip_y: f32 = 1.0;
@vertex fn corner(@builtin(vertex_index) i: u32) -> Out {
    let ndc = vec2f(f32((i & 1u) * 4u) - 1.0, f32((i >> 1u) * 4u) - 1.0);
    return Out(vec4f(ndc.x, ndc.y * clip_y, 0.5, 1.0), ndc);
}
@fragment fn plain(in: Out) -> @location(0) vec4f {
    return vec4f(in.ndc * 0.5 + 0.5, 0.25, 1.0);
}
";
const ONE: &str = r"
@group(0) @binding(0) var depth: texture_2d<f32>;
@fragment fn one(in: Out) -> @location(0) vec4f {
    return vec4f(in.ndc * 0.5 + 0.5, textureLoad(depth, vec2i(in.at.xy), 0).r, 1.0);
}
";
const MANY: &str = r"
@group(0) @binding(0) var depths: texture_multisampled_2d<f32>;
@fragment fn many(in: Out, @builtin(sample_index) sample: u32) -> @location(0) vec4f {
    return vec4f(in.ndc * 0.5 + 0.5, textureLoad(depths, vec2i(in.at.xy), i32(sample)).r, 1.0);
}
";

impl Picture {
    pub fn new(device: &wgpu::Device, target: &GlTarget, depth: Depth) -> Self {
        let (text, entry) = match depth {
            Depth::None => (SHADER.to_owned(), "plain"),
            depth if depth.per_sample() => (format!("{SHADER}{MANY}"), "many"),
            _ => (format!("{SHADER}{ONE}"), "one"),
        };
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: None,
            source: wgpu::ShaderSource::Wgsl(text.into()),
        });
        let layout = (depth != Depth::None).then(|| {
            device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
                label: None,
                entries: &[wgpu::BindGroupLayoutEntry {
                    binding: 0,
                    visibility: wgpu::ShaderStages::FRAGMENT,
                    ty: wgpu::BindingType::Texture {
                        sample_type: wgpu::TextureSampleType::Float { filterable: false },
                        view_dimension: wgpu::TextureViewDimension::D2,
                        multisampled: depth.per_sample(),
                    },
                    count: None,
                }],
            })
        });
        let groups: Vec<_> = layout.iter().map(Some).collect();
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: None,
            bind_group_layouts: &groups,
            immediate_size: 0,
        });
        let constants = [("clip_y", f64::from(welkin::gpu::gl::CLIP_Y_SIGN))];
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: None,
            layout: Some(&pipeline_layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("corner"),
                compilation_options: wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() },
                buffers: &[],
            },
            // The reversed y makes the front face clockwise: culling back faces must keep the picture.
            primitive: wgpu::PrimitiveState {
                front_face: wgpu::FrontFace::Cw,
                cull_mode: Some(wgpu::Face::Back),
                ..Default::default()
            },
            depth_stencil: None,
            multisample: wgpu::MultisampleState { count: target.samples, ..Default::default() },
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some(entry),
                compilation_options: Default::default(),
                targets: &[Some(target.color.format().into())],
            }),
            multiview_mask: None,
            cache: None,
        });
        Self { pipeline, layout, reads: depth }
    }

    pub fn draw(&self, adopted: &GlDevice, target: &GlTarget) {
        if self.reads == Depth::OldColor || self.reads == Depth::OldColors {
            adopted.host.refresh(&target.color).unwrap();
        }
        let group = self.layout.as_ref().map(|layout| {
            let (texture, aspect) = match self.reads {
                Depth::OldColor | Depth::OldColors => (&target.color_read, wgpu::TextureAspect::All),
                Depth::Mask => (&target.mask, wgpu::TextureAspect::All),
                _ => (&target.depth_read, wgpu::TextureAspect::DepthOnly),
            };
            let view = texture.as_ref().expect("something to read");
            let view = view.create_view(&wgpu::TextureViewDescriptor { aspect, ..Default::default() });
            adopted.device.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: None,
                layout,
                entries: &[wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(&view) }],
            })
        });
        let mut encoder = adopted.device.device.create_command_encoder(&Default::default());
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &target.color.create_view(&Default::default()),
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store },
            })],
            ..Default::default()
        });
        pass.set_pipeline(&self.pipeline);
        if let Some(group) = &group {
            pass.set_bind_group(0, group, &[]);
        }
        pass.draw(0..3, 0..1);
        drop(pass);
        adopted.device.queue.submit([encoder.finish()]);
    }
}
