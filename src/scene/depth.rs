//! Depth conventions: from a host's depth sample and projection to a ray of the world and metres along it.
//!
//! A depth buffer holds the ratio of two linear forms of the eye-space point p = (x, y, z, 1), d = (r_z . p) / (r_w .
//! p), with r_z and r_w rows of the host's projection (r_z halved with r_w where clip space runs from -1 to 1). A
//! pixel's ray solves (r_x - x r_w) . p = (r_y - y r_w) . p = 0, which leaves one unknown, the distance. [`ViewRays`]
//! does this algebra in f64 once a frame, so a pixel costs three multiply-adds and one division, in f32, without a
//! cancellation:
//!
//! * the depth is first turned so that 0 is far (e = d or 1 - d; the latter is exact in f32 for d >= 1/2), and the
//!   constants 1/far and 1/near - 1/far are formed in f64, never as a difference on the GPU;
//! * the ray's direction is an affine function of the pixel (its three coefficients come rotated to world axes), not
//!   the difference of two unprojected points;
//! * everything is relative to the camera, so where the world's origin lies does not matter.
//!
//! What remains is the host's own depth resolution ([`ViewRays::resolution_m`]): with a near plane of 0.1 m, a
//! standard f32 buffer cannot tell 10 km from 10.06 km, a reversed one resolves 0.9 mm there.
//!
//! The same functions run on the GPU: `shaders/common/depth.wgsl`, same names and order of parameters.

use glam::{DMat3, DVec2, DVec3, DVec4};

use super::Camera;
use crate::error::{Error, Result, check_range};

/// Distance that stands for "nothing was drawn here": the pixel shows the sky. Every real distance is below it.
pub const RANGE_SKY_M: f64 = 1e12;

/// Range of clip-space z before the viewport maps it to the depth buffer's 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum ClipSpace {
    /// -1 to 1: OpenGL without `glClipControl`.
    MinusOneToOne,
    /// 0 to 1: Vulkan, Direct3D, Metal, WebGPU, OpenGL with `GL_ZERO_TO_ONE`.
    #[default]
    ZeroToOne,
}

/// How depth grows with distance.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub enum DepthKind {
    /// Perspective with finite or infinite far plane: the matrix says which.
    #[default]
    Perspective,
    /// Parallel rays; depth is linear.
    Orthographic,
    /// d = ln(c w + 1) / ln(c far + 1) with w = clip w, written by the host's shader (Kemen, Outerra, 2009).
    Logarithmic {
        /// Resolution near the camera, 1/m, (0, 1e6]; 1 or 0.001 are usual.
        c: f64,
        /// Distance at depth 1, m, (0, 1e12].
        far_m: f64,
    },
}

/// Meaning of the numbers in the host's depth buffer, beside the projection matrix.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct DepthMapping {
    /// Perspective, orthographic or logarithmic.
    pub kind: DepthKind,
    /// Whether 1 is near and 0 far. False (default): 0 is near.
    pub reversed: bool,
    /// Range of clip-space z; of no meaning to logarithmic depth.
    pub clip: ClipSpace,
}

impl DepthMapping {
    /// Refuses logarithmic constants out of range, by name.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`].
    pub fn validate(&self) -> Result<()> {
        if let DepthKind::Logarithmic { c, far_m } = self.kind {
            check_range("depth_mapping.logarithmic_c", c, 1e-9, 1e6, "1/m")?;
            check_range("depth_mapping.logarithmic_far_m", far_m, 1e-3, RANGE_SKY_M, "m")?;
        }
        Ok(())
    }

    /// The depth value of the far end: what a host clears to.
    pub fn far_depth(&self) -> f64 {
        if self.reversed { 0.0 } else { 1.0 }
    }
}

/// Number format of a depth buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DepthFormat {
    /// 16-bit normalised.
    Unorm16,
    /// 24-bit normalised.
    Unorm24,
    /// 32-bit float.
    Float32,
}

impl DepthFormat {
    /// Distance between neighbouring representable depths at `depth`.
    pub fn step(self, depth: f64) -> f64 {
        match self {
            Self::Unorm16 => 1.0 / 65_535.0,
            Self::Unorm24 => 1.0 / 16_777_215.0,
            // A depth of 0.75 lies in the binade [0.5, 1), where floats are 2^-24 apart.
            Self::Float32 => 2f64.powf(depth.max(f64::from(f32::MIN_POSITIVE)).log2().ceil() - 24.0),
        }
    }
}

/// One pixel's ray, in the host's axes relative to [`Camera::position`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewRay {
    /// Where the ray begins: the centre of projection, or the plane through it if rays are parallel; m.
    pub origin: DVec3,
    /// Unit direction.
    pub direction: DVec3,
    /// Metres along the ray per unit of clip w (perspective), 1 for parallel rays.
    pub slant: f64,
}

const KIND_PERSPECTIVE: u32 = 0;
const KIND_PARALLEL: u32 = 1;
const KIND_LOGARITHMIC: u32 = 2;

/// A camera's rays and the way back from its depth buffer; made once a view and frame, in f64.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewRays {
    kind: u32,
    /// e = turn.x + turn.y * depth is 0 at the far end (logarithmic: at the near one).
    turn: DVec2,
    /// Ray origin and (unnormalised) direction at the picture's centre and their change per unit of ndc x and y.
    origin: [DVec3; 3],
    direction: [DVec3; 3],
    /// Perspective: w = scale / (e - pole . (1, x, y)); parallel: t = (e - pole . (1, x, y)) * scale.
    pole: DVec3,
    scale: f64,
    /// Plane distance per unit of w.
    plane_scale: f64,
    /// ln(c far + 1) and 1/c of logarithmic depth.
    log_far: f64,
    inverse_c: f64,
}

impl ViewRays {
    /// Prepares the rays of `camera` whose depth buffer follows `mapping`.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] if the matrix cannot be inverted or contradicts the mapping, by name.
    pub fn new(camera: &Camera, mapping: &DepthMapping) -> Result<Self> {
        camera.validate()?;
        mapping.validate()?;
        let p = camera.projection;
        let [x, y, z, w] = [p.row(0), p.row(1), p.row(2), p.row(3)];
        // The viewport maps clip z of OpenGL from [-1, 1] to [0, 1]: window depth is (z/w + 1)/2.
        let depth = if mapping.clip == ClipSpace::MinusOneToOne { 0.5 * (z + w) } else { z };
        let rays = if camera.is_orthographic() {
            if mapping.kind != DepthKind::Orthographic {
                return Err(contradiction(
                    "depth_mapping.kind",
                    "perspective or logarithmic, but the projection's rays are parallel",
                ));
            }
            Self::parallel(x / w.w, y / w.w, depth / w.w, mapping.reversed)?
        } else {
            if mapping.kind == DepthKind::Orthographic {
                return Err(contradiction(
                    "depth_mapping.kind",
                    "orthographic, but the projection's rays meet in a point",
                ));
            }
            Self::central(x, y, depth, w, mapping)?
        };
        Ok(rays.turned(camera.rotation().transpose()))
    }

    fn central(x: DVec4, y: DVec4, depth: DVec4, w: DVec4, mapping: &DepthMapping) -> Result<Self> {
        let [x3, y3, w3] = [x.truncate(), y.truncate(), w.truncate()];
        let det = x3.cross(y3).dot(w3);
        if det == 0.0 || !det.is_finite() {
            return Err(Error::range(
                "camera.projection",
                "one that sees a solid angle (rows x, y, w independent)",
                det,
            ));
        }
        // Directions d with (r_x - x r_w) . d = (r_y - y r_w) . d = 0 and r_w . d = 1, so that clip w counts along
        // them.
        let direction = [x3.cross(y3) / det, y3.cross(w3) / det, w3.cross(x3) / det];
        // The centre of projection: where x, y and w all vanish; not the eye-space origin for some stereo matrices.
        let eye = -DMat3::from_cols(x3, y3, w3).transpose().inverse() * DVec3::new(x.w, y.w, w.w);
        let turn = if mapping.reversed { DVec2::new(0.0, 1.0) } else { DVec2::new(1.0, -1.0) };
        let mut rays = Self {
            kind: KIND_PERSPECTIVE,
            turn,
            origin: [eye, DVec3::ZERO, DVec3::ZERO],
            direction,
            pole: DVec3::ZERO,
            scale: 1.0,
            plane_scale: 1.0 / w3.length(),
            log_far: 0.0,
            inverse_c: 0.0,
        };
        if let DepthKind::Logarithmic { c, far_m } = mapping.kind {
            rays.kind = KIND_LOGARITHMIC;
            // Here 0 is near: what is close has a small depth, of which 1 - depth would lose the digits.
            rays.turn = if mapping.reversed { DVec2::new(1.0, -1.0) } else { DVec2::new(0.0, 1.0) };
            rays.log_far = (c * far_m).ln_1p();
            rays.inverse_c = 1.0 / c;
            return Ok(rays);
        }
        // Along a ray d = r_z . direction + (r_z . eye + r_z,w) / w.
        rays.scale = turn.y * (depth.truncate().dot(eye) + depth.w);
        rays.pole = DVec3::from(direction.map(|v| turn.y * depth.truncate().dot(v)));
        rays.pole.x += turn.x;
        if rays.scale <= 0.0 {
            let has = if mapping.reversed { "reversed" } else { "not reversed" };
            let what = format!("{has}, but the projection maps the near plane to the other end");
            return Err(contradiction("depth_mapping.reversed", &what));
        }
        Ok(rays)
    }

    fn parallel(x: DVec4, y: DVec4, depth: DVec4, reversed: bool) -> Result<Self> {
        let [x3, y3, z3] = [x.truncate(), y.truncate(), depth.truncate()];
        let turn = if reversed { DVec2::new(0.0, 1.0) } else { DVec2::new(1.0, -1.0) };
        let mut forward = x3.cross(y3).normalize_or_zero();
        // e falls with distance, from 1 at the near plane to 0 at the far one.
        if turn.y * z3.dot(forward) > 0.0 {
            forward = -forward;
        }
        let per_metre = turn.y * z3.dot(forward);
        if per_metre >= 0.0 || !per_metre.is_finite() {
            return Err(Error::range("camera.projection", "one whose depth changes along its rays", per_metre));
        }
        let inverse = DMat3::from_cols(x3, y3, forward).transpose().inverse();
        let origin = [inverse * DVec3::new(-x.w, -y.w, 0.0), inverse.x_axis, inverse.y_axis];
        let mut pole = DVec3::from(origin.map(|v| turn.y * z3.dot(v)));
        pole.x += turn.x + turn.y * depth.w;
        Ok(Self {
            kind: KIND_PARALLEL,
            turn,
            origin,
            direction: [forward, DVec3::ZERO, DVec3::ZERO],
            pole,
            scale: 1.0 / per_metre,
            plane_scale: 1.0,
            log_far: 0.0,
            inverse_c: 0.0,
        })
    }

    /// Returns the rays in axes turned by `to_world`.
    fn turned(mut self, to_world: DMat3) -> Self {
        self.origin = self.origin.map(|v| to_world * v);
        self.direction = self.direction.map(|v| to_world * v);
        self
    }

    /// The ray through `ndc` (x right, y up, each -1 to 1 over the picture).
    pub fn view_ray(&self, ndc: DVec2) -> ViewRay {
        let origin = self.origin[0] + ndc.x * self.origin[1] + ndc.y * self.origin[2];
        let d = self.direction[0] + ndc.x * self.direction[1] + ndc.y * self.direction[2];
        let slant = d.length();
        ViewRay { origin, direction: d / slant, slant }
    }

    /// Clip w (perspective, logarithmic) or metres along the ray (parallel) of a depth sample; [`RANGE_SKY_M`] for
    /// the far end, what lies beyond it, and NaN: a pixel of which nothing is known shows the sky.
    pub fn view_depth(&self, depth: f64, ndc: DVec2) -> f64 {
        let e = self.turn.x + self.turn.y * depth;
        let far = if self.kind == KIND_LOGARITHMIC { e >= 1.0 } else { e <= 0.0 };
        if depth.is_nan() || far {
            return RANGE_SKY_M;
        }
        let e = e.clamp(0.0, 1.0);
        let pole = self.pole.x + ndc.x * self.pole.y + ndc.y * self.pole.z;
        let w = match self.kind {
            KIND_PERSPECTIVE if e <= pole => RANGE_SKY_M,
            KIND_PERSPECTIVE => self.scale / (e - pole),
            KIND_PARALLEL => (e - pole) * self.scale,
            _ => (e * self.log_far).exp_m1() * self.inverse_c,
        };
        w.clamp(0.0, RANGE_SKY_M)
    }

    /// Metres along the pixel's ray to what the host drew there, [`RANGE_SKY_M`] if nothing.
    pub fn view_range(&self, depth: f64, ndc: DVec2) -> f64 {
        (self.view_depth(depth, ndc) * self.view_ray(ndc).slant).min(RANGE_SKY_M)
    }

    /// Distance from the camera's plane, m (N-51 of the compatibility laws), [`RANGE_SKY_M`] if nothing was drawn.
    pub fn view_plane(&self, depth: f64, ndc: DVec2) -> f64 {
        (self.view_depth(depth, ndc) * self.plane_scale).min(RANGE_SKY_M)
    }

    /// The depth that a host's buffer would hold at `range_m` along the ray through `ndc`, before rounding: the
    /// inverse of [`view_range`](Self::view_range).
    pub fn depth_at(&self, range_m: f64, ndc: DVec2) -> f64 {
        let w = range_m / self.view_ray(ndc).slant;
        let pole = self.pole.x + ndc.x * self.pole.y + ndc.y * self.pole.z;
        let e = match self.kind {
            KIND_PERSPECTIVE => pole + self.scale / w,
            KIND_PARALLEL => pole + w / self.scale,
            _ => (w / self.inverse_c).ln_1p() / self.log_far,
        };
        (e - self.turn.x) / self.turn.y
    }

    /// How far two surfaces must lie apart at `range_m` to have different depths in a buffer of `format`, m.
    pub fn resolution_m(&self, range_m: f64, ndc: DVec2, format: DepthFormat) -> f64 {
        let depth = self.depth_at(range_m, ndc);
        let h = range_m * 1e-4;
        let slope = (self.depth_at(range_m + h, ndc) - self.depth_at(range_m - h, ndc)) / (2.0 * h);
        format.step(depth) / slope.abs()
    }

    /// Angle between the rays of two neighbouring pixels in the picture's middle, `height` pixels high; 0 for parallel
    /// rays.
    pub fn pixel_angle(&self, height: u32) -> f64 {
        2.0 * self.direction[2].length() / (self.direction[0].length() * f64::from(height.max(1)))
    }

    /// Value of the shaders' `override` constant `DEPTH_KINDS` with which a pipeline reads this camera's depth and no
    /// other kind.
    pub fn depth_kinds(&self) -> u32 {
        1 << self.kind
    }

    /// The form the shaders read (`DepthUniform` of `common/depth.wgsl`).
    pub fn uniform(&self) -> DepthUniform {
        let [o, ox, oy] = self.origin.map(|v| v.as_vec3().to_array());
        let [d, dx, dy] = self.direction.map(|v| v.as_vec3().to_array());
        DepthUniform {
            origin: o,
            turn_offset: self.turn.x as f32,
            origin_dx: ox,
            turn_scale: self.turn.y as f32,
            origin_dy: oy,
            kind: self.kind,
            direction: d,
            plane_scale: self.plane_scale as f32,
            direction_dx: dx,
            log_far: self.log_far as f32,
            direction_dy: dy,
            inverse_c: self.inverse_c as f32,
            pole: self.pole.as_vec3().to_array(),
            scale: self.scale as f32,
        }
    }
}

fn contradiction(field: &str, what: &str) -> Error {
    Error::invalid(field, format_args!("says {what}"))
}

/// [`ViewRays`] as shaders read it; offsets are tested against naga's.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[allow(missing_docs)] // The members are those of the WGSL struct, where each is explained.
pub struct DepthUniform {
    pub origin: [f32; 3],
    pub turn_offset: f32,
    pub origin_dx: [f32; 3],
    pub turn_scale: f32,
    pub origin_dy: [f32; 3],
    pub kind: u32,
    pub direction: [f32; 3],
    pub plane_scale: f32,
    pub direction_dx: [f32; 3],
    pub log_far: f32,
    pub direction_dy: [f32; 3],
    pub inverse_c: f32,
    pub pole: [f32; 3],
    pub scale: f32,
}
