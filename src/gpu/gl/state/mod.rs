//! Host's OpenGL state in [`super::GlMode::HostContext`]: saved before Welkin draws, set to what wgpu assumes, and
//! restored after.
//!
//! *Host state that would affect wgpu*: wgpu's backend sets most of what it needs at every pass (masks, scissor,
//! blending, stencil, samplers). For the rest it assumes a context of its own: a vertex array other than 0, no
//! rasteriser discard, filled polygons, the default clip control, tightly packed pixels, no logic operation, full
//! sample coverage, no colour clamping. `normalise` sets this rest. *wgpu state that would affect the host*: everything
//! that wgpu sets. The saved state is the union of the two.
//!
//! Conditional rendering and active queries are not part of the saved state, because they cannot be suspended;
//! `src/gpu/gl/counting.rs` refuses them.

mod bind;
mod pixel;
mod raster;

use super::{
    api::Api,
    check::{GlInfo, GlProfile},
    names::*,
};

/// One `glEnable` switch, with the value that wgpu assumes and the host's value.
struct Toggle {
    /// Name of the switch.
    cap: u32,
    /// Value that wgpu assumes: that of a fresh context, except for sRGB encoding and seamless cube maps, which are on.
    fresh: bool,
    /// Value that the host had set.
    was: bool,
}

/// Saved state of one context. All memory is allocated with the device, none during a frame.
pub(super) struct HostState {
    toggles: Vec<Toggle>,
    raster: raster::Raster,
    pixels: pixel::PixelState,
    bindings: bind::Bindings,
    pending_error: u32,
}

impl HostState {
    pub(super) fn new(api: &Api, info: &GlInfo) -> Self {
        Self {
            toggles: toggles(api, info),
            raster: raster::Raster::new(api, info),
            pixels: pixel::PixelState::new(info),
            bindings: bind::Bindings::new(api, info),
            pending_error: NO_ERROR,
        }
    }

    /// Reads the host's state. Leaves the private framebuffer `probe` bound, because some drivers clamp values that
    /// they return (the stencil reference, the blend colour) to the range of the bound framebuffer; that of `probe` is
    /// wide enough for all.
    pub(super) fn save(&mut self, api: &Api, probe: u32) {
        self.pending_error = api.take_error();
        for t in &mut self.toggles {
            t.was = api.IsEnabled(t.cap) != 0;
        }
        self.bindings.save(api);
        api.BindFramebuffer(FRAMEBUFFER, probe);
        self.raster.save(api);
        self.pixels.save(api);
    }

    /// Whether the host had switch `cap` on when the state was saved.
    pub(super) fn was_on(&self, cap: u32) -> bool {
        self.toggles.iter().any(|t| t.cap == cap && t.was)
    }

    /// Sets the state that wgpu assumes, with its vertex array `vao` bound.
    pub(super) fn normalise(&self, api: &Api, vao: u32) {
        self.bindings.normalise(api, vao);
        for t in self.toggles.iter().filter(|t| t.was != t.fresh) {
            api.set_enabled(t.cap, t.fresh);
        }
        self.raster.normalise(api);
        self.pixels.normalise(api);
    }

    /// Restores the host's saved state. Returns the first error flag that OpenGL has raised since its flags were last
    /// read.
    pub(super) fn restore(&self, api: &Api) -> u32 {
        self.bindings.restore(api);
        self.raster.restore(api);
        self.pixels.restore(api);
        let raised = api.take_error();
        raise(api, self.pending_error, self.bindings.read_framebuffer());
        // The switches come last, because one of them is debug output: the host's debug callback then gets no messages
        // about the calls before this loop.
        for t in &self.toggles {
            api.set_enabled(t.cap, t.was);
        }
        raised
    }
}

/// Raises the error that was pending when the state was saved, so that the host still finds it. Only the three kinds
/// below can be raised at will; an error of another kind is lost.
fn raise(api: &Api, error: u32, read_framebuffer: u32) {
    match error {
        INVALID_ENUM => api.Enable(NONE),
        INVALID_VALUE => api.Scissor(0, 0, -1, -1),
        INVALID_OPERATION => {
            // The window's framebuffer has no such attachment.
            api.BindFramebuffer(READ_FRAMEBUFFER, 0);
            api.ReadBuffer(COLOR_ATTACHMENT0);
            api.BindFramebuffer(READ_FRAMEBUFFER, read_framebuffer);
        }
        _ => {}
    }
}

/// Lists the switches that exist in this context.
fn toggles(api: &Api, info: &GlInfo) -> Vec<Toggle> {
    let es = info.is_es();
    let mut list: Vec<(u32, bool)> = vec![
        (CULL_FACE, false),
        (DEPTH_TEST, false),
        (STENCIL_TEST, false),
        (DITHER, true),
        (POLYGON_OFFSET_FILL, false),
        (SAMPLE_ALPHA_TO_COVERAGE, false),
        (SAMPLE_COVERAGE, false),
        (RASTERIZER_DISCARD, false),
    ];
    let mut add = |known: bool, cap: u32, fresh: bool| {
        if known {
            list.push((cap, fresh));
        }
    };
    add(info.knows((4, 0), (3, 2), &["GL_ARB_sample_shading", "GL_OES_sample_shading"]), SAMPLE_SHADING, false);
    add(info.at_least((3, 2), (3, 1)), SAMPLE_MASK, false);
    add(info.knows((4, 3), (3, 0), &["GL_ARB_ES3_compatibility"]), PRIMITIVE_RESTART_FIXED_INDEX, false);
    add(info.knows((4, 3), (3, 2), &["GL_KHR_debug"]), DEBUG_OUTPUT, false);
    add(!es || info.has("GL_EXT_depth_clamp"), DEPTH_CLAMP, false);
    // wgpu expects an sRGB format to encode; the switch has no effect on other formats. In OpenGL ES it is always on.
    add(!es || info.has("GL_EXT_sRGB_write_control"), FRAMEBUFFER_SRGB, true);
    add(!es || info.has("GL_EXT_multisample_compatibility"), MULTISAMPLE, true);
    add(!es || info.has("GL_EXT_multisample_compatibility"), SAMPLE_ALPHA_TO_ONE, false);
    for cap in [
        COLOR_LOGIC_OP,
        LINE_SMOOTH,
        POLYGON_SMOOTH,
        POLYGON_OFFSET_POINT,
        POLYGON_OFFSET_LINE,
        PRIMITIVE_RESTART,
        PROGRAM_POINT_SIZE,
        TEXTURE_CUBE_MAP_SEAMLESS,
    ] {
        add(!es, cap, cap == TEXTURE_CUBE_MAP_SEAMLESS);
    }
    if !es || info.has("GL_EXT_clip_cull_distance") {
        for i in 0..api.uint(MAX_CLIP_DISTANCES).min(16) {
            add(true, CLIP_DISTANCE0 + i, false);
        }
    }
    add(info.has("GL_EXT_depth_bounds_test"), DEPTH_BOUNDS_TEST_EXT, false);
    for cap in [ALPHA_TEST, POLYGON_STIPPLE, LINE_STIPPLE] {
        add(info.profile == GlProfile::Compatibility, cap, false);
    }
    api.take_error(); // An unknown limit raises an error on some drivers, which must not be blamed on a later call.
    list.into_iter().map(|(cap, fresh)| Toggle { cap, fresh, was: fresh }).collect()
}
