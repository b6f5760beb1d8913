//! Viewports, scissors, depth, stencil, polygons and blending of the host's context.

use super::super::{
    api::Api,
    check::{GlInfo, GlProfile},
    names::*,
};

/// Viewport with its scissor and depth range.
#[derive(Clone, Copy, Default)]
struct GlViewport {
    /// Left, lower edge, width and height, pixels.
    rect: [f32; 4],
    scissor: [i32; 4],
    scissor_test: bool,
    depth: [f64; 2],
}

/// Blending and mask of one colour buffer. `func` has the source and destination factors of colour, then those of
/// alpha; `equation` has that of colour, then that of alpha.
#[derive(Clone, Copy, Default)]
struct Target {
    blend: bool,
    func: [u32; 4],
    equation: [u32; 2],
    mask: [u8; 4],
}

/// One face's state of the stencil test.
#[derive(Clone, Copy, Default)]
struct Stencil {
    func: u32,
    reference: i32,
    read_mask: u32,
    write_mask: u32,
    ops: [u32; 3],
}

/// Queries of a colour buffer's four blend factors.
const FUNC_NAMES: [u32; 4] = [BLEND_SRC_RGB, BLEND_DST_RGB, BLEND_SRC_ALPHA, BLEND_DST_ALPHA];
/// Queries of a colour buffer's two blend equations.
const EQUATION_NAMES: [u32; 2] = [BLEND_EQUATION_RGB, BLEND_EQUATION_ALPHA];
/// Queries of the front face's stencil state, in the order of the fields of [`Stencil`].
const FRONT_NAMES: [u32; 7] = [
    STENCIL_FUNC,
    STENCIL_REF,
    STENCIL_VALUE_MASK,
    STENCIL_WRITEMASK,
    STENCIL_FAIL,
    STENCIL_PASS_DEPTH_FAIL,
    STENCIL_PASS_DEPTH_PASS,
];
/// Queries of the back face's stencil state, in the order of the fields of [`Stencil`].
const BACK_NAMES: [u32; 7] = [
    STENCIL_BACK_FUNC,
    STENCIL_BACK_REF,
    STENCIL_BACK_VALUE_MASK,
    STENCIL_BACK_WRITEMASK,
    STENCIL_BACK_FAIL,
    STENCIL_BACK_PASS_DEPTH_FAIL,
    STENCIL_BACK_PASS_DEPTH_PASS,
];

/// Saved rasteriser and blending state.
#[derive(Default)]
pub(super) struct Raster {
    views: Vec<GlViewport>,
    targets: Vec<Target>,
    /// Whether each viewport has its own state (OpenGL 4.1).
    many_views: bool,
    /// Whether each colour buffer has its own mask and blend switch (OpenGL 3.0, ES 3.2).
    many_masks: bool,
    /// Whether each colour buffer has its own blend function (OpenGL 4.0, ES 3.2).
    many_blends: bool,
    desktop: bool,
    compatibility: bool,
    clip_control: bool,
    offset_clamp: bool,
    stencil: [Stencil; 2],
    depth_func: u32,
    depth_write: u8,
    depth_clear: f64,
    stencil_clear: i32,
    blend_color: [f32; 4],
    cull_face: u32,
    front_face: u32,
    polygon_mode: [u32; 2],
    polygon_offset: [f32; 3],
    provoking_vertex: u32,
    clip: [u32; 2],
    clamp: [u32; 3],
}

/// Targets of colour clamping.
const CLAMPS: [u32; 3] = [CLAMP_READ_COLOR, CLAMP_VERTEX_COLOR, CLAMP_FRAGMENT_COLOR];

impl Raster {
    pub(super) fn new(api: &Api, info: &GlInfo) -> Self {
        let many_views = info.knows((4, 1), (0, 0), &["GL_ARB_viewport_array"]);
        // Reading a buffer's mask needs a function of ES 3.1.
        let indexed: &[&str] = match info.is_es() {
            true if info.version >= (3, 1) => &["GL_EXT_draw_buffers_indexed", "GL_OES_draw_buffers_indexed"],
            true => &[],
            false => &["GL_ARB_draw_buffers_blend"],
        };
        let many_masks = info.knows((3, 0), (3, 2), indexed);
        let views = if many_views { api.uint(MAX_VIEWPORTS).clamp(1, 64) } else { 1 };
        let targets = if many_masks { api.uint(MAX_DRAW_BUFFERS).clamp(1, 32) } else { 1 };
        Self {
            views: vec![GlViewport::default(); views as usize],
            targets: vec![Target::default(); targets as usize],
            many_views,
            many_masks,
            many_blends: info.knows((4, 0), (3, 2), indexed),
            desktop: !info.is_es(),
            compatibility: info.profile == GlProfile::Compatibility,
            clip_control: info.knows((4, 5), (0, 0), &["GL_ARB_clip_control", "GL_EXT_clip_control"]),
            offset_clamp: info.knows((4, 6), (0, 0), &["GL_ARB_polygon_offset_clamp", "GL_EXT_polygon_offset_clamp"]),
            ..Self::default()
        }
    }

    pub(super) fn save(&mut self, api: &Api) {
        self.save_views(api);
        self.save_targets(api);
        for (side, names) in self.stencil.iter_mut().zip([FRONT_NAMES, BACK_NAMES]) {
            let v = names.map(|n| api.int(n));
            *side = Stencil {
                func: v[0] as u32,
                reference: v[1],
                read_mask: v[2] as u32,
                write_mask: v[3] as u32,
                ops: [v[4] as u32, v[5] as u32, v[6] as u32],
            };
        }
        self.depth_func = api.uint(DEPTH_FUNC);
        self.depth_write = u8::from(api.int(DEPTH_WRITEMASK) != 0);
        self.depth_clear = api.doubles::<1>(DEPTH_CLEAR_VALUE, self.desktop)[0];
        self.stencil_clear = api.int(STENCIL_CLEAR_VALUE);
        self.cull_face = api.uint(CULL_FACE_MODE);
        self.front_face = api.uint(FRONT_FACE);
        self.polygon_offset[0] = api.floats::<1>(POLYGON_OFFSET_FACTOR)[0];
        self.polygon_offset[1] = api.floats::<1>(POLYGON_OFFSET_UNITS)[0];
        if self.offset_clamp {
            self.polygon_offset[2] = api.floats::<1>(POLYGON_OFFSET_CLAMP)[0];
        }
        if self.desktop {
            // A core profile has one polygon mode, of which a driver writes one value or, if it is older, two.
            let modes = api.ints::<4>(POLYGON_MODE);
            let back = if self.compatibility { modes[1] } else { modes[0] };
            self.polygon_mode = [modes[0] as u32, back as u32];
            self.provoking_vertex = api.uint(PROVOKING_VERTEX);
            for (value, name) in self.clamp.iter_mut().zip(CLAMPS).take(if self.compatibility { 3 } else { 1 }) {
                *value = api.uint(name);
            }
            if self.compatibility {
                api.ClampColor(CLAMP_FRAGMENT_COLOR, 0); // stays off: otherwise the blend colour is returned clamped
            }
        }
        self.blend_color = api.floats(BLEND_COLOR);
        if self.clip_control {
            self.clip = [api.uint(CLIP_ORIGIN), api.uint(CLIP_DEPTH_MODE)];
        }
    }

    fn save_views(&mut self, api: &Api) {
        if !self.many_views {
            let rect = api.ints::<4>(VIEWPORT).map(|v| v as f32);
            let scissor_test = api.IsEnabled(SCISSOR_TEST) != 0;
            self.views[0] = GlViewport {
                rect,
                scissor: api.ints(SCISSOR_BOX),
                scissor_test,
                depth: api.doubles(DEPTH_RANGE, self.desktop),
            };
            return;
        }
        for (i, view) in self.views.iter_mut().enumerate() {
            let i = i as u32;
            // SAFETY: these three states have 4, 4 and 2 values.
            unsafe {
                api.GetFloati_v(VIEWPORT, i, view.rect.as_mut_ptr());
                api.GetIntegeri_v(SCISSOR_BOX, i, view.scissor.as_mut_ptr());
                api.GetDoublei_v(DEPTH_RANGE, i, view.depth.as_mut_ptr());
            }
            view.scissor_test = api.IsEnabledi(SCISSOR_TEST, i) != 0;
        }
    }

    fn save_targets(&mut self, api: &Api) {
        for (i, target) in self.targets.iter_mut().enumerate() {
            let i = i as u32;
            if self.many_masks {
                // SAFETY: the mask has four values.
                unsafe { api.GetBooleani_v(COLOR_WRITEMASK, i, target.mask.as_mut_ptr()) };
                target.blend = api.IsEnabledi(BLEND, i) != 0;
            } else {
                // SAFETY: the mask has four values.
                unsafe { api.GetBooleanv(COLOR_WRITEMASK, target.mask.as_mut_ptr()) };
                target.blend = api.IsEnabled(BLEND) != 0;
            }
            let get = |name| if self.many_blends { api.int_at(name, i) as u32 } else { api.uint(name) };
            target.func = FUNC_NAMES.map(get);
            target.equation = EQUATION_NAMES.map(get);
        }
    }

    pub(super) fn normalise(&self, api: &Api) {
        if self.desktop {
            api.PolygonMode(FRONT_AND_BACK, FILL);
            api.ProvokingVertex(LAST_VERTEX_CONVENTION);
            api.ClampColor(CLAMP_READ_COLOR, FIXED_ONLY);
        }
        if self.clip_control {
            api.ClipControl(LOWER_LEFT, NEGATIVE_ONE_TO_ONE);
        }
    }

    pub(super) fn restore(&self, api: &Api) {
        self.restore_views(api);
        self.restore_targets(api);
        for (side, face) in self.stencil.iter().zip([FRONT, BACK]) {
            api.StencilFuncSeparate(face, side.func, side.reference, side.read_mask);
            api.StencilMaskSeparate(face, side.write_mask);
            api.StencilOpSeparate(face, side.ops[0], side.ops[1], side.ops[2]);
        }
        api.DepthFunc(self.depth_func);
        api.DepthMask(self.depth_write);
        if self.desktop {
            api.ClearDepth(self.depth_clear);
        } else {
            api.ClearDepthf(self.depth_clear as f32);
        }
        api.ClearStencil(self.stencil_clear);
        let [r, g, b, a] = self.blend_color;
        api.BlendColor(r, g, b, a);
        api.CullFace(self.cull_face);
        api.FrontFace(self.front_face);
        let [factor, units, clamp] = self.polygon_offset;
        if self.offset_clamp {
            api.PolygonOffsetClamp(factor, units, clamp);
        } else {
            api.PolygonOffset(factor, units);
        }
        if self.desktop {
            if self.compatibility {
                api.PolygonMode(FRONT, self.polygon_mode[0]);
                api.PolygonMode(BACK, self.polygon_mode[1]);
            } else {
                api.PolygonMode(FRONT_AND_BACK, self.polygon_mode[0]);
            }
            api.ProvokingVertex(self.provoking_vertex);
            for (value, name) in self.clamp.iter().zip(CLAMPS).take(if self.compatibility { 3 } else { 1 }) {
                api.ClampColor(name, *value);
            }
        }
        if self.clip_control {
            api.ClipControl(self.clip[0], self.clip[1]);
        }
    }

    fn restore_views(&self, api: &Api) {
        for (i, view) in self.views.iter().enumerate() {
            let i = i as u32;
            let ([x, y, w, h], [sx, sy, sw, sh]) = (view.rect, view.scissor);
            if self.many_views {
                api.ViewportIndexedf(i, x, y, w, h);
                api.ScissorIndexed(i, sx, sy, sw, sh);
                api.DepthRangeIndexed(i, view.depth[0], view.depth[1]);
                switch_at(api, SCISSOR_TEST, i, view.scissor_test);
            } else {
                api.Viewport(x as i32, y as i32, w as i32, h as i32);
                api.Scissor(sx, sy, sw, sh);
                if self.desktop {
                    api.DepthRange(view.depth[0], view.depth[1]);
                } else {
                    api.DepthRangef(view.depth[0] as f32, view.depth[1] as f32);
                }
                api.set_enabled(SCISSOR_TEST, view.scissor_test);
            }
        }
    }

    fn restore_targets(&self, api: &Api) {
        for (i, target) in self.targets.iter().enumerate() {
            let i = i as u32;
            let [r, g, b, a] = target.mask;
            if self.many_masks {
                api.ColorMaski(i, r, g, b, a);
                switch_at(api, BLEND, i, target.blend);
            } else {
                api.ColorMask(r, g, b, a);
                api.set_enabled(BLEND, target.blend);
            }
            let ([sc, dc, sa, da], [ec, ea]) = (target.func, target.equation);
            if self.many_blends {
                api.BlendFuncSeparatei(i, sc, dc, sa, da);
                api.BlendEquationSeparatei(i, ec, ea);
            } else {
                api.BlendFuncSeparate(sc, dc, sa, da);
                api.BlendEquationSeparate(ec, ea);
            }
        }
    }
}

/// Sets one switch of one viewport or one colour buffer.
fn switch_at(api: &Api, cap: u32, index: u32, is_on: bool) {
    if is_on { api.Enablei(cap, index) } else { api.Disablei(cap, index) }
}
