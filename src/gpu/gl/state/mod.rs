//! The host's OpenGL state while Welkin draws in the host's own context: saved, set to what wgpu takes for granted,
//! and put back.
//!
//! *Leaks in*: wgpu's backend sets most of what it needs at every pass (masks, scissor, blending, stencil, samplers),
//! but trusts a context of its own for the rest: a vertex array that is not 0, no rasteriser discard, filled polygons,
//! the default clip control, packed pixels, no logic operation, every sample covered, nothing clamped. `normalise` sets
//! that. *Leaks out*: everything it sets. One list serves both: what is saved is the union.
//!
//! Not in the list because they cannot be put aside: conditional rendering and queries that count (the `counting` room
//! refuses them).

mod bind;
mod pixel;
mod raster;

use super::{
    api::Api,
    check::{GlInfo, GlProfile},
    names::*,
};

/// One `glEnable` switch, and how a fresh context has it.
struct Toggle {
    cap: u32,
    fresh: bool,
    was: bool,
}

/// The saved state of one context. Everything is allocated when the device is made, nothing in a frame.
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

    /// Reads the host's state. Leaves the private framebuffer `probe` bound: some drivers clamp what they answer (the
    /// stencil reference, the blend colour) to what the bound framebuffer can hold, and `probe` holds everything.
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

    /// Whether the host had switch `cap` on when its state was saved.
    pub(super) fn was_on(&self, cap: u32) -> bool {
        self.toggles.iter().any(|t| t.cap == cap && t.was)
    }

    /// Sets what a fresh context has, with wgpu's vertex array `vao` bound.
    pub(super) fn normalise(&self, api: &Api, vao: u32) {
        self.bindings.normalise(api, vao);
        for t in self.toggles.iter().filter(|t| t.was != t.fresh) {
            api.set_enabled(t.cap, t.fresh);
        }
        self.raster.normalise(api);
        self.pixels.normalise(api);
    }

    /// Puts the host's state back as it was when saved. Answers the first error that OpenGL raised meanwhile.
    pub(super) fn restore(&self, api: &Api) -> u32 {
        self.bindings.restore(api);
        self.raster.restore(api);
        self.pixels.restore(api);
        let raised = api.take_error();
        raise(api, self.pending_error, self.bindings.read_framebuffer());
        // Debug output is one of these: a host that listens hears nothing of what happened in between.
        for t in &self.toggles {
            api.set_enabled(t.cap, t.was);
        }
        raised
    }
}

/// Raises the error that the host had not yet read when this call began, so that the host still finds it.
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

/// The switches that this context knows.
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
    // wgpu means an sRGB format to encode; other formats do not care. OpenGL ES has it always on.
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
    api.take_error(); // a limit that a driver does not know must not count against a later call
    list.into_iter().map(|(cap, fresh)| Toggle { cap, fresh, was: fresh }).collect()
}
