//! Every kind of image, format, sample count and colour space that a host can hand over, in both modes, drawn into by
//! wk_view_record with all stages in rain, while the host's OpenGL is in an unusual state. Each picture must equal that
//! of Welkin's own Vulkan device.

use std::{cell::RefCell, collections::HashMap, ptr::null_mut};

use glow::HasContext;
use welkin::capi::{
    device::*, frame::*, opengl::*, status::*, texture::*, timeline::*, view::*, weather::*, weather_kinds::*,
};
use welkin::gpu::gl::{GlImage, GlMode};
use welkin_support::{
    accept,
    c_scene::{Scene, init, message, ok},
    egl::{Api, Window},
};

use crate::{
    SIZE,
    capi::{device, target},
    frame,
    host::Host,
    images::*,
    painter::{GROUND, Painter, depth_of_row, is_float},
    snapshot::Snapshot,
    unusual,
};

/// A picture, 1 being white, rows from the bottom.
pub type Picture = Vec<[f32; 4]>;

const SPACES: [wk_color_space; 3] = [WK_COLOR_DISPLAY_SRGB, WK_COLOR_DISPLAY_LINEAR, WK_COLOR_SCENE_LINEAR];

/// Rain that has wetted the ground, in thin fog.
pub fn rain(scene: &Scene) {
    let weather = wk_weather {
        visibility_m: 20_000.0,
        precipitation_kind: WK_PRECIPITATION_RAIN,
        precipitation_rate_mm_h: 40.0,
        ..init("wk_weather")
    };
    // SAFETY: live pointers.
    unsafe {
        ok(wk_context_set_weather(scene.context, &weather, -600.0, 0.0));
        ok(wk_context_update(scene.context, 1.0));
    }
}

/// Returns the frame of all cases, which shows nothing of earlier frames.
pub fn the_frame(color_space: wk_color_space) -> wk_frame {
    let mut frame = frame(7);
    frame.flags |= WK_FRAME_NO_HISTORY;
    wk_frame { color_space, cd_m2_per_unit: 2e4, ..frame }
}

/// Records the frame. Every case uses the same frame number, because dither depends on it, so another frame is recorded
/// in between.
pub fn record(scene: &Scene, frame: &wk_frame, stages: wk_stage_flags) -> wk_status {
    let other = wk_frame { frame_id: frame.frame_id + 1, target: std::ptr::null(), ..*frame };
    // SAFETY: live handles and targets, the caller says.
    unsafe {
        ok(wk_view_record(scene.view, &other, WK_STAGE_PREPARE));
        wk_view_record(scene.view, frame, stages)
    }
}

/// Pictures of Welkin's own Vulkan device for each format and colour space, drawn at the first request.
pub struct Truth {
    device: *mut wk_device,
    scene: Scene,
    drawn: RefCell<HashMap<(wk_format, wk_color_space), Picture>>,
}

impl Truth {
    pub fn new() -> Self {
        let desc = wk_device_desc { backends: WK_BACKEND_VULKAN, ..init("wk_device_desc") };
        let mut device = null_mut();
        // SAFETY: live pointers.
        ok(unsafe { wk_device_create(&desc, &mut device) });
        let scene = Scene::new(device);
        rain(&scene);
        Self { device, scene, drawn: RefCell::default() }
    }

    /// The picture for an internal format of OpenGL.
    pub fn of(&self, internal: u32, space: wk_color_space) -> Picture {
        let format = match internal {
            glow::SRGB8_ALPHA8 => WK_FORMAT_RGBA8_SRGB,
            i if is_float(i) => WK_FORMAT_RGBA16_FLOAT,
            _ => WK_FORMAT_RGBA8_UNORM,
        };
        let draw = || own(self.device, &self.scene, format, space, WK_STAGE_ALL);
        self.drawn.borrow_mut().entry((format, space)).or_insert_with(draw).clone()
    }

    /// Checks that the scene contains everything that the cases test.
    fn assert_shows_all(&self) {
        let whole = self.of(glow::RGBA8, WK_COLOR_DISPLAY_SRGB);
        for without in [WK_STAGE_SURFACE, WK_STAGE_PARTICLES] {
            let stages = WK_STAGE_ALL & !without & !WK_STAGE_TONE;
            let less = own(self.device, &self.scene, WK_FORMAT_RGBA8_UNORM, WK_COLOR_DISPLAY_SRGB, stages);
            let other = whole.iter().zip(&less).filter(|(a, b)| off(a, b) > 0.5 / 255.0).count();
            assert!(other > 100, "stage {without:#x} changes {other} pixels");
        }
        assert!(whole[..SIZE.0 as usize].iter().all(|t| t[0] > 0.02), "ground");
        assert!(whole.iter().rev().take(SIZE.0 as usize).all(|t| t[2] > 0.2), "sky");
    }

    pub fn destroy(self) {
        self.scene.destroy();
        // SAFETY: a live handle.
        ok(unsafe { wk_device_destroy(self.device) });
    }
}

/// The largest difference of a channel; infinite where one is no number.
fn off(a: &[f32; 4], b: &[f32; 4]) -> f32 {
    if !a.iter().chain(b).all(|v| v.is_finite()) {
        return f32::INFINITY;
    }
    (0..3).map(|i| (a[i] - b[i]).abs()).fold(0.0, f32::max)
}

fn own(device: *mut wk_device, scene: &Scene, format: wk_format, space: wk_color_space, stages: u32) -> Picture {
    let pixels = (SIZE.0 * SIZE.1) as usize;
    let rows = || (0..SIZE.1).rev().flat_map(|y| std::iter::repeat_n(depth_of_row(y), SIZE.0 as usize));
    let depths: Vec<f32> = rows().collect();
    let stored: Vec<[u8; 4]> =
        rows().map(|d| if d > 0.0 { [GROUND[0], GROUND[1], GROUND[2], 255] } else { [0, 0, 0, 255] }).collect();
    let half = |v: u8| half::f16::from_f32(f32::from(v) / 255.0).to_bits();
    let halves: Vec<[u16; 4]> = stored.iter().map(|t| t.map(half)).collect();
    let float = format == WK_FORMAT_RGBA16_FLOAT;
    let bytes: &[u8] = if float { bytemuck::cast_slice(&halves) } else { stored.as_flattened() };
    let row = bytes.len() as u32 / SIZE.1;
    let mut back = vec![0_u8; bytes.len()];
    let (mut color, mut depth) = (null_mut(), null_mut());
    let texture = wk_texture_desc { width: SIZE.0, height: SIZE.1, format, ..init("wk_texture_desc") };
    let depth_desc = wk_texture_desc { format: WK_FORMAT_R32_FLOAT, ..texture };
    // SAFETY: live pointers with the sizes given.
    unsafe {
        ok(wk_texture_create(device, &texture, &mut color));
        ok(wk_texture_create(device, &depth_desc, &mut depth));
        ok(wk_texture_write(color, bytes.as_ptr().cast(), bytes.len(), row));
        ok(wk_texture_write(depth, depths.as_ptr().cast(), 4 * pixels, 4 * SIZE.0));
        let target = wk_own_target { color, depth, ..init("wk_own_target") };
        let frame = wk_frame { target: (&raw const target).cast(), ..the_frame(space) };
        ok(record(scene, &frame, stages));
        ok(wk_texture_read(color, back.as_mut_ptr().cast(), back.len(), row));
        ok(wk_texture_destroy(color));
        ok(wk_texture_destroy(depth));
    }
    let texels: Picture = if float {
        let read = |b: &[u8]| half::f16::from_le_bytes([b[0], b[1]]).to_f32();
        back.chunks_exact(8).map(|t| [0, 2, 4, 6].map(|i| read(&t[i..]))).collect()
    } else {
        back.chunks_exact(4).map(|t| [0, 1, 2, 3].map(|i| f32::from(t[i]) / 255.0)).collect()
    };
    texels.chunks_exact(SIZE.0 as usize).rev().flatten().copied().collect()
}

/// A name for an image of one case.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum ImageKind {
    Texture,
    Renderbuffer,
    /// A framebuffer of the host's with these textures.
    Framebuffer,
}

fn make(painter: &Painter, host: &Host, kind: ImageKind, internal: u32, samples: i32) -> GlImage {
    painter.make(host, |gl| match (kind, samples) {
        (ImageKind::Renderbuffer, _) => image_of_buffer(renderbuffer(gl, internal, samples)),
        (_, 1) => image_of(texture(gl, internal)),
        _ => image_of_samples(multisampled_texture(gl, internal, samples)),
    })
}

fn delete(painter: &Painter, host: &Host, image: GlImage) {
    // SAFETY: names of the share group, used no more.
    painter.make(host, |gl| unsafe {
        match image {
            GlImage::Texture { name, .. } => gl.delete_texture(glow::NativeTexture(name.try_into().unwrap())),
            GlImage::Renderbuffer { name } => {
                gl.delete_renderbuffer(glow::NativeRenderbuffer(name.try_into().unwrap()))
            }
            GlImage::Framebuffer { .. } => {}
        }
    });
}

/// Compares with the truth: at most `few` pixels may differ by more than `most`.
#[track_caller]
pub fn assert_close(got: &Picture, wanted: &Picture, most: f32, few: usize, what: &str) {
    let far = got
        .iter()
        .zip(wanted)
        .filter(|(a, b)| off(a, b) > most * b[..3].iter().fold(1.0, |m, v| f32::max(m, *v)))
        .count();
    if far > few {
        let worst = got.iter().zip(wanted).enumerate().max_by(|a, b| off(a.1.0, a.1.1).total_cmp(&off(b.1.0, b.1.1)));
        panic!("{what}: {far} pixels differ by more than {most}; worst: {worst:?}");
    }
}

/// All cases of one kind of context.
fn matrix(truth: &Truth, api: Api, mode: GlMode, formats: &[(u32, usize)]) {
    let window =
        if mode == GlMode::HostContext { Window::Pbuffer(WIDTH as i32, HEIGHT as i32, 0) } else { Window::None };
    let host = Host::new(api, window, mode);
    let es = matches!(api, Api::Es(..));
    let device = device(&host);
    let scene = Scene::new(device);
    rain(&scene);
    let painter = Painter::new(&host, api);
    let objects = unusual::set(&host, api);
    let before = Snapshot::take(&host.gl, &objects);
    let depths = [
        glow::DEPTH_COMPONENT32F,
        glow::DEPTH_COMPONENT24,
        glow::DEPTH24_STENCIL8,
        glow::DEPTH32F_STENCIL8,
        glow::DEPTH_COMPONENT16,
    ];
    let kinds: &[ImageKind] = match mode {
        GlMode::Shared => &[ImageKind::Texture, ImageKind::Renderbuffer],
        GlMode::HostContext => &[ImageKind::Texture, ImageKind::Renderbuffer, ImageKind::Framebuffer],
    };
    let (mut next_depth, mut next_space, mut cases) = (0, 0, 0);
    for &kind in kinds {
        for (samples, multisample) in
            [(1, WK_OPENGL_MULTISAMPLE_EACH), (4, WK_OPENGL_MULTISAMPLE_EACH), (4, WK_OPENGL_MULTISAMPLE_RESOLVE)]
        {
            if es && samples > 1 {
                continue;
            }
            for &(internal, spaces) in formats {
                let color = make(&painter, &host, kind, internal, samples);
                let depth_format = depths[next_depth % depths.len()];
                next_depth += 1;
                let depth = make(&painter, &host, kind, depth_format, samples);
                for space in SPACES.into_iter().cycle().skip(next_space).take(spaces) {
                    next_space = (next_space + 1) % if spaces == 3 { 3 } else { 2 };
                    cases += 1;
                    let what = format!(
                        "{api:?} {mode:?} {kind:?} {internal:#x} {depth_format:#x} {samples} {multisample} {space}"
                    );
                    painter.paint(&host, (color, internal), depth, false);
                    let fbo = (kind == ImageKind::Framebuffer).then(|| host_framebuffer(&host, color, depth));
                    let images = fbo.map_or((color, depth), |f| {
                        let image = GlImage::Framebuffer { name: f.0.get() };
                        (image, image)
                    });
                    let target = wk_opengl_target { multisample, ..target(images.0, images.1) };
                    let frame = wk_frame { target: (&raw const target).cast(), ..the_frame(space) };
                    let status = record(&scene, &frame, WK_STAGE_ALL);
                    assert_eq!(status, 0, "{what}: {}", message());
                    if let Some(fbo) = fbo {
                        // SAFETY: as above; a framebuffer of this test's.
                        unsafe { host.gl.delete_framebuffer(fbo) };
                    }
                    let got = painter.read(&host, color, internal);
                    assert_close(&got, &truth.of(internal, space), 4.0 / 255.0, 0, &what);
                }
                delete(&painter, &host, color);
                delete(&painter, &host, depth);
            }
        }
    }
    assert!(cases >= 4 && (es || cases >= 14), "{cases}");
    let differences = before.differences(&Snapshot::take(&host.gl, &objects));
    assert!(differences.is_empty(), "{api:?} {mode:?}:\n{}", differences.join("\n"));
    scene.destroy();
    // SAFETY: a live handle.
    ok(unsafe { wk_device_destroy(device) });
}

/// A framebuffer of the host's, made while its state is unusual; what is bound stays.
fn host_framebuffer(host: &Host, color: GlImage, depth: GlImage) -> glow::Framebuffer {
    let gl = &host.gl;
    // SAFETY: the host's context is current.
    unsafe {
        let bound = [glow::DRAW_FRAMEBUFFER_BINDING, glow::READ_FRAMEBUFFER_BINDING]
            .map(|b| std::num::NonZeroU32::new(gl.get_parameter_i32(b) as u32).map(glow::NativeFramebuffer));
        let fbo = framebuffer(gl, color, Some(depth));
        gl.bind_framebuffer(glow::DRAW_FRAMEBUFFER, bound[0]);
        gl.bind_framebuffer(glow::READ_FRAMEBUFFER, bound[1]);
        fbo
    }
}

/// All formats, with the number of colour spaces in which each is drawn.
const ALL: [(u32, usize); 7] = [
    (glow::RGBA8, 3),
    (glow::RGB8, 1),
    (glow::SRGB8_ALPHA8, 1),
    (glow::RGB10_A2, 1),
    (glow::RGBA16F, 3),
    (glow::RGBA32F, 1),
    (glow::R11F_G11F_B10F, 1),
];

#[test]
fn every_image_is_drawn_as_an_own_device_draws_it() {
    let truth = Truth::new();
    truth.assert_shows_all();
    let few = [(glow::RGBA8, 1), (glow::RGBA16F, 1)];
    // OpenGL ES allocates an image without alpha in one way only.
    let few_es = [(glow::RGBA8, 1), (glow::RGB8, 1), (glow::RGBA16F, 1)];
    // Formats that hardly differ from another one are tested in the long run only.
    let most: Vec<_> = ALL.into_iter().filter(|f| !matches!(f.0, glow::RGB8 | glow::RGBA32F)).collect();
    // In the long run every kind of context but the oldest sees all formats, or all that differ from one another.
    for (api, mode, short, long) in [
        (Api::Core(4, 5), GlMode::Shared, &most[..], &ALL[..]),
        (Api::Compatibility(4, 5), GlMode::HostContext, &few, &most[..]),
        (Api::Es(3, 1), GlMode::Shared, &few_es, &ALL),
        (Api::Es(3, 0), GlMode::HostContext, &few, &few),
    ] {
        matrix(&truth, api, mode, if accept() { long } else { short });
    }
    truth.destroy();
}
