//! Depth conventions: conversion of a host's projection to rays in the world, and of its depth samples to metres along
//! the rays.
//!
//! A depth buffer holds the ratio of two linear forms of p, the eye-space point in homogeneous coordinates. With the
//! rows r_x, r_y, r_z and r_w of the host's projection:
//!
//! ```text
//! d = (r_z . p) / (r_w . p)                                clip space from 0 to 1
//! d = ((r_z + r_w) / 2 . p) / (r_w . p)                    clip space from -1 to 1
//! (r_x - x r_w) . p = (r_y - y r_w) . p = 0                the ray of the pixel at (x, y) in normalised coordinates
//! ```
//!
//! On the ray of a pixel, d gives the only unknown, the distance. [`ViewRays`] does this algebra in f64 once a frame. A
//! pixel then costs three multiply-adds and one division in f32, without cancellation:
//!
//! * the depth is first turned so that 0 is far: e = d or e = 1 - d. The latter is exact in f32 for d >= 1/2. The
//!   constants 1/far and 1/near - 1/far are formed in f64, never as a difference on the GPU;
//! * the ray's direction is an affine function of the pixel (its three coefficients come rotated to world axes), not
//!   the difference of two unprojected points;
//! * everything is relative to the camera, so the position of the world's origin does not matter.
//!
//! The remaining error is the host's own depth resolution ([`ViewRays::resolution_m`]). With a near plane of 0.1 m, a
//! standard f32 buffer cannot tell 10 km from 10.06 km; a reversed one resolves 0.9 mm there.
//!
//! Functions of the same names and order of parameters run on the GPU: `shaders/common/depth.wgsl`.

use glam::{DMat3, DVec2, DVec3, DVec4};

use super::Camera;
use crate::error::{Error, Result, check_range};

/// Distance of a pixel in which the host drew nothing: it shows the sky. Every real distance is smaller.
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

/// Relation of depth to distance.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub enum DepthKind {
    /// Perspective with a finite or infinite far plane, as the matrix has it.
    #[default]
    Perspective,
    /// Parallel rays; depth is linear.
    Orthographic,
    /// d = ln(c w + 1) / ln(c far + 1) with w = clip w, written by the host's shader (Kemen, Outerra, 2009). If
    /// [`DepthMapping::reversed`] is set, the shader writes 1 - d.
    Logarithmic {
        /// Resolution near the camera, 1/m, \[1e-9, 1e6\]; 1 or 0.001 are usual.
        c: f64,
        /// Distance at depth 1, or at depth 0 if reversed, m, \[1e-3, 1e12\].
        far_m: f64,
    },
}

/// Interpretation of the host's depth buffer, together with the projection matrix.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct DepthMapping {
    /// Perspective, orthographic or logarithmic.
    pub kind: DepthKind,
    /// Whether depth 1 is near and 0 far. False (default): 0 is near.
    pub reversed: bool,
    /// Range of clip-space z; not used for logarithmic depth.
    pub clip: ClipSpace,
}

impl DepthMapping {
    /// Checks the constants of logarithmic depth; the error names the field.
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

    /// Returns the depth value of the far end, to which a host clears its buffer.
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
    /// Returns the distance between neighbouring representable values at `depth`.
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
    /// Start of the ray, m: the centre of projection, or a point of the plane through the camera if rays are parallel.
    pub origin: DVec3,
    /// Unit direction.
    pub direction: DVec3,
    /// Metres along the ray per unit of clip w (perspective and logarithmic), 1 for parallel rays.
    pub slant: f64,
}

const KIND_PERSPECTIVE: u32 = 0;
const KIND_PARALLEL: u32 = 1;
const KIND_LOGARITHMIC: u32 = 2;

/// Rays of a camera and the inverse of its depth buffer's mapping; computed in f64 once per view and frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewRays {
    kind: u32,
    /// Coefficients of `e = turn.x + turn.y depth`. e is 0 at the far end, or at the near end for logarithmic depth.
    turn: DVec2,
    /// Ray origin at the picture's centre, and its change per unit of normalised x and of normalised y.
    origin: [DVec3; 3],
    /// Ray direction, not normalised, at the picture's centre, and its change per unit of normalised x and y.
    direction: [DVec3; 3],
    /// Perspective: `w = scale / (e - pole . (1, x, y))`. Parallel rays: `t = (e - pole . (1, x, y)) scale`, m.
    pole: DVec3,
    /// Scale in the formulas of `pole`.
    scale: f64,
    /// Distance from the camera's plane per unit of clip w, m.
    plane_scale: f64,
    /// Constant `ln(c far + 1)` of logarithmic depth.
    log_far: f64,
    /// Constant 1/c of logarithmic depth, m.
    inverse_c: f64,
}

impl ViewRays {
    /// Computes the rays of `camera`, whose depth buffer follows `mapping`.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field, if [`Camera::validate`] or [`DepthMapping::validate`]
    /// refuses it, or if the projection cannot be inverted or contradicts the mapping.
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

    /// Computes rays that meet in a point, from the rows of the projection.
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
        // Directions d with (r_x - x r_w) . d = (r_y - y r_w) . d = 0 and r_w . d = 1: clip w is then the distance in
        // units of d.
        let direction = [x3.cross(y3) / det, y3.cross(w3) / det, w3.cross(x3) / det];
        // The centre of projection is the point where x, y and w all vanish. In some stereo matrices it is not the
        // eye-space origin.
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
            // Logarithmic depth has its 0 at the near end. Near depths are small, and 1 - depth would lose their
            // digits.
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

    /// Computes parallel rays, from the rows of the projection divided by w.
    fn parallel(x: DVec4, y: DVec4, depth: DVec4, reversed: bool) -> Result<Self> {
        let [x3, y3, z3] = [x.truncate(), y.truncate(), depth.truncate()];
        let turn = if reversed { DVec2::new(0.0, 1.0) } else { DVec2::new(1.0, -1.0) };
        let mut forward = x3.cross(y3).normalize_or_zero();
        // e decreases with distance, from 1 at the near plane to 0 at the far one.
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

    /// Returns the rays rotated by `to_world`.
    fn turned(mut self, to_world: DMat3) -> Self {
        self.origin = self.origin.map(|v| to_world * v);
        self.direction = self.direction.map(|v| to_world * v);
        self
    }

    /// Returns the ray through `ndc` (x right, y up, each -1 to 1 over the picture).
    pub fn view_ray(&self, ndc: DVec2) -> ViewRay {
        let origin = self.origin[0] + ndc.x * self.origin[1] + ndc.y * self.origin[2];
        let d = self.direction[0] + ndc.x * self.direction[1] + ndc.y * self.direction[2];
        let slant = d.length();
        ViewRay { origin, direction: d / slant, slant }
    }

    /// Returns clip w (perspective, logarithmic) or metres along the ray (parallel) of a depth sample; [`RANGE_SKY_M`]
    /// at and beyond the far end, and for NaN, because a pixel of unknown depth shows the sky.
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

    /// Returns the distance along the pixel's ray to the surface that the host drew there, m; [`RANGE_SKY_M`] without
    /// one.
    pub fn view_range(&self, depth: f64, ndc: DVec2) -> f64 {
        (self.view_depth(depth, ndc) * self.view_ray(ndc).slant).min(RANGE_SKY_M)
    }

    /// Returns the distance from the camera's plane to the surface that the host drew in the pixel, m; [`RANGE_SKY_M`]
    /// without one. Fog laws of older simulators can use it.
    pub fn view_plane(&self, depth: f64, ndc: DVec2) -> f64 {
        (self.view_depth(depth, ndc) * self.plane_scale).min(RANGE_SKY_M)
    }

    /// Returns the depth, before rounding, that a host's buffer holds for a surface at `range_m` along the ray through
    /// `ndc`: the inverse of [`view_range`](Self::view_range).
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

    /// Returns the least distance, m, between two surfaces at about `range_m` whose depths differ in a buffer of
    /// `format`.
    pub fn resolution_m(&self, range_m: f64, ndc: DVec2, format: DepthFormat) -> f64 {
        let depth = self.depth_at(range_m, ndc);
        let h = range_m * 1e-4;
        let slope = (self.depth_at(range_m + h, ndc) - self.depth_at(range_m - h, ndc)) / (2.0 * h);
        format.step(depth) / slope.abs()
    }

    /// Returns the angle between the rays of two neighbouring pixels in the middle of a picture `height` pixels high,
    /// rad; 0 for parallel rays.
    pub fn pixel_angle(&self, height: u32) -> f64 {
        2.0 * self.direction[2].length() / (self.direction[0].length() * f64::from(height.max(1)))
    }

    /// Returns the value of the shaders' `override` constant `DEPTH_KINDS` with which a pipeline reads only this
    /// camera's kind of depth.
    pub fn depth_kinds(&self) -> u32 {
        1 << self.kind
    }

    /// Returns the rays in the form that shaders read (`DepthUniform` of `common/depth.wgsl`).
    #[doc(hidden)]
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

/// [`ViewRays`] as shaders read them; a test compares the offsets with naga's.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[allow(missing_docs)] // The members are those of the WGSL struct, where each is explained.
#[doc(hidden)]
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
