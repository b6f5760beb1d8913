//! Occluder maps: up to four depth textures of the host with the surfaces that keep rain off. The host may draw each
//! map from any direction.
//!
//! A drop is removed if its slanted path, traced back, crosses a surface in a map:
//! `shaders/surroundings/occluders.wgsl`. A map does not contain surfaces that lie behind others. If it is taken along
//! the drops' direction of fall (`fall_velocity_m_s` of [`crate::context::RainAt`]), which depends on the wind, drops
//! meet none of the hidden surfaces.

use glam::{DMat3, DMat4, DVec3, DVec4};

use crate::{
    error::{Error, Result},
    scene::{Camera, ClipSpace, DepthKind, DepthMapping, ViewRays},
};

/// Maximum number of maps at a time.
pub const MAX_OCCLUDER_MAPS: usize = 4;
/// Least and largest number of texels of a map along either side.
pub const OCCLUDER_MAP_TEXELS: (u32, u32) = (8, 4096);

/// Depth texture of surfaces that keep rain off, and the camera with which the host drew it.
#[derive(Clone, Copy, Debug)]
pub struct OccluderMap<'a> {
    /// Depth texture: Depth16Unorm, Depth24Plus(Stencil8), Depth32Float(Stencil8) or R32Float, one sample, one layer,
    /// with TEXTURE_BINDING, from 8 to 4096 texels along either side. Its content is copied when the map is set; the
    /// host may draw into it again after that.
    pub depth: &'a wgpu::Texture,
    /// Camera with which the texture was drawn, and the time and velocity of its content.
    pub taken: Taken,
}

/// Camera with which the host drew a map, and the time and velocity of the map's content.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Taken {
    /// Matrix from the host's world to clip space: parallel rays or perspective, from any direction.
    pub clip_from_world: DMat4,
    /// Whether depth 1 is near and 0 far.
    pub reversed: bool,
    /// Range of clip z.
    pub clip: ClipSpace,
    /// Whether row 0 of the texture lies at clip y = -1, as OpenGL draws.
    pub first_row_at_minus_y: bool,
    /// Simulation time for which the map's content is right, s, \[-1e10, 1e10\].
    pub time_s: f64,
    /// Velocity of the map's content in the host's world, m/s, of a magnitude of at most 2000; 0 for content that
    /// stands still. With a velocity, the map of a moving truck need not be drawn anew every frame. Content faster than
    /// 0.1 m/s does not keep the ground dry.
    pub velocity_m_s: DVec3,
}

/// Checked camera, time and velocity of a map, from which the shaders' uniform is computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Occluder {
    /// Rows that map a place relative to `origin_m` to clip x, y and w, and to a distance along the camera's axis, m.
    /// The distance begins at `origin_m` for parallel rays, and at the camera's position in perspective.
    rows: [DVec4; 4],
    /// Middle of the map's near plane, in the host's world, m.
    origin_m: DVec3,
    /// Rays and depth of the map, relative to `origin_m`.
    pub rays: ViewRays,
    /// 1 if row 0 of the texture is the map's top, -1 if it is the bottom.
    pub y_sign: f64,
    /// Simulation time for which the content is right, s.
    time_s: f64,
    /// Velocity of the content in the host's world, m/s.
    velocity_m_s: DVec3,
}

/// Struct `Occluder` of the block in `shaders/surroundings/occluders.wgsl`, which describes the fields.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct OccluderUniform {
    pub x: [f32; 4],
    pub y: [f32; 4],
    pub w: [f32; 4],
    pub distance: [f32; 4],
    pub velocity: [f32; 4],
    pub part: [f32; 4],
}

impl Taken {
    /// Creates a camera with parallel rays and reversed depth, for hosts without matrices of their own. It looks from
    /// `eye` along `forward`, over the distance `depth_m`. `half_m` is half the picture's width and half its height, m.
    pub fn parallel(eye: DVec3, forward: DVec3, half_m: [f64; 2], depth_m: f64) -> Self {
        let f = forward.normalize();
        let right = f.cross(f.any_orthonormal_vector()).normalize();
        let up = right.cross(f);
        let row = |v: DVec3, scale: f64, at: f64| (v * scale).extend(at - scale * v.dot(eye));
        let rows =
            [row(right, 1.0 / half_m[0], 0.0), row(up, 1.0 / half_m[1], 0.0), row(f, -1.0 / depth_m, 1.0), DVec4::W];
        Self {
            clip_from_world: DMat4::from_cols(rows[0], rows[1], rows[2], rows[3]).transpose(),
            reversed: true,
            clip: ClipSpace::ZeroToOne,
            first_row_at_minus_y: false,
            time_s: 0.0,
            velocity_m_s: DVec3::ZERO,
        }
    }

    /// Checks the ranges of all fields, that the matrix can be inverted, and that the middle of its near plane is
    /// within 1e12 m of the world's origin.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field.
    pub(crate) fn check(&self) -> Result<Occluder> {
        let m = self.clip_from_world;
        let bad = || Error::range("clip_from_world", "finite and invertible", m);
        if !m.is_finite() {
            return Err(bad());
        }
        let speed = self.velocity_m_s.length();
        if speed.is_nan() || speed > 2000.0 {
            return Err(Error::range("velocity_m_s", "a vector of at most 2000 m/s", self.velocity_m_s));
        }
        if !(self.time_s.is_finite() && self.time_s.abs() <= 1e10) {
            return Err(Error::range("time_s", "in [-1e10, 1e10] s", self.time_s));
        }
        let near = match (self.reversed, self.clip) {
            (true, _) => 1.0,
            (false, ClipSpace::ZeroToOne) => 0.0,
            (false, ClipSpace::MinusOneToOne) => -1.0,
        };
        let h = m.inverse() * DVec4::new(0.0, 0.0, near, 1.0);
        let origin_m = h.truncate() / h.w;
        if !(origin_m.is_finite() && origin_m.length() <= 1e12) {
            let accepted = "one whose near plane lies within 1e12 m, of the depth's direction (reversed or not)";
            return Err(Error::range("clip_from_world", accepted, m));
        }
        let local = m * DMat4::from_translation(origin_m);
        let camera = Camera { position: DVec3::ZERO, view: DMat4::IDENTITY, projection: local };
        let kind = if camera.is_orthographic() { DepthKind::Orthographic } else { DepthKind::Perspective };
        let mapping = DepthMapping { kind, reversed: self.reversed, clip: self.clip };
        let rays = ViewRays::new(&camera, &mapping).map_err(|e| {
            e.renamed("camera.projection", "clip_from_world").renamed("depth_mapping", "clip_from_world")
        })?;
        let w = local.row(3);
        let parallel = kind == DepthKind::Orthographic;
        let distance =
            if parallel { rays.view_ray(glam::DVec2::ZERO).direction.extend(0.0) } else { w / w.truncate().length() };
        Ok(Occluder {
            rows: [local.row(0), local.row(1), w, distance],
            origin_m,
            rays,
            y_sign: if self.first_row_at_minus_y { -1.0 } else { 1.0 },
            time_s: self.time_s,
            velocity_m_s: self.velocity_m_s,
        })
    }
}

impl Occluder {
    /// Returns the map as shaders read it, at a time, for a camera at `eye` in the host's world, m. `to_enu` is the
    /// rotation from the host's axes to the camera's east, north, up. `part` is the origin and the size, texels, of the
    /// map in the table, the texture that holds all maps.
    pub fn uniform(&self, eye: DVec3, to_enu: DMat3, time_s: f64, part: [[u32; 2]; 2]) -> OccluderUniform {
        let [low, size] = part.map(|p| p.map(f64::from));
        let moved = eye - self.origin_m - self.velocity_m_s * (time_s - self.time_s);
        let [x, y, w, distance] = self.rows.map(|r| (to_enu * r.truncate()).extend(r.truncate().dot(moved) + r.w));
        let across = x * (0.5 * size[0]) + w * (0.5 * size[0] + low[0]);
        let down = y * (-0.5 * size[1] * self.y_sign) + w * (0.5 * size[1] + low[1]);
        let row = |v: DVec4| v.as_vec4().to_array();
        let moves = f64::from(u8::from(self.velocity_m_s.length() > 0.1));
        OccluderUniform {
            x: row(across),
            y: row(down),
            w: row(w),
            distance: row(distance),
            velocity: row((to_enu * self.velocity_m_s).extend(moves)),
            part: [low[0], low[1], low[0] + size[0], low[1] + size[1]].map(|v| v as f32),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::shader;

    /// Returns an occluder's view from 60 m up, steeply down and to the east.
    fn taken() -> Taken {
        Taken::parallel(DVec3::new(100.0, 50.0, 60.0), DVec3::new(0.3, 0.0, -1.0), [40.0, 20.0], 120.0)
    }

    #[test]
    fn offsets_are_those_of_the_shader() {
        shader::assert_layout!(
            "surroundings/occluders.wgsl",
            "Occluder",
            OccluderUniform,
            [x, y, w, distance, velocity, part]
        );
    }

    #[test]
    fn a_point_is_found_in_the_map_whatever_the_convention() {
        let t = taken();
        let eye = DVec3::new(1e7, 3.0, 2.0);
        let shift = DMat4::from_translation(-(eye - DVec3::new(90.0, 48.0, 10.0)));
        let f = DVec3::new(0.3, 0.0, -1.0).normalize();
        // Each case is (matrix, clip space, reversed), and all show the same picture.
        let flip = DMat4::from_cols_array(&[1., 0., 0., 0., 0., 1., 0., 0., 0., 0., -1., 0., 0., 0., 1., 1.]);
        let wide = DMat4::from_cols_array(&[1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 2., 0., 0., 0., -1., 1.]);
        for (m, reversed, clip) in [
            (t.clip_from_world, true, ClipSpace::ZeroToOne),
            (flip * t.clip_from_world, false, ClipSpace::ZeroToOne),
            (wide * flip * t.clip_from_world, false, ClipSpace::MinusOneToOne),
        ] {
            let moved = Taken { clip_from_world: m * shift, reversed, clip, ..t };
            let o = moved.check().unwrap();
            let u = o.uniform(eye, DMat3::IDENTITY, 0.0, [[64, 0], [256, 128]]);
            let p = DVec3::new(3.0, 1.0, -4.0);
            let world = p + DVec3::new(90.0, 48.0, 10.0) - DVec3::new(100.0, 50.0, 60.0);
            let at = |row: [f32; 4]| glam::Vec4::from_array(row).as_dvec4().dot(p.extend(1.0));
            assert!((at(u.distance) - world.dot(f)).abs() < 1e-4, "{} {}", at(u.distance), world.dot(f));
            let ndc = t.clip_from_world * (world + DVec3::new(100.0, 50.0, 60.0)).extend(1.0);
            let want = [64.0 + 128.0 * (1.0 + ndc.x), 64.0 * (1.0 - ndc.y)];
            assert!((at(u.x) - want[0]).abs() < 1e-2 && (at(u.y) - want[1]).abs() < 1e-2, "{} {want:?}", at(u.x));
        }
    }

    #[test]
    fn a_moving_map_goes_along() {
        let o = Taken { velocity_m_s: DVec3::X * 10.0, time_s: 2.0, ..taken() }.check().unwrap();
        let at = |x: f64, t: f64| o.uniform(DVec3::new(x, 0.0, 0.0), DMat3::IDENTITY, t, [[0, 0], [64, 64]]);
        for (a, b) in at(30.0, 5.0).x.iter().zip(at(0.0, 2.0).x) {
            assert!((a - b).abs() < 1e-4, "{a} {b}");
        }
    }

    #[test]
    fn bad_views_of_maps_are_refused_by_name() {
        let seen = Camera::look_to(DVec3::ZERO, DVec3::Y, DVec3::Z, 1.0, 1.0, 0.1).projection;
        for (bad, name) in [
            (Taken { clip_from_world: DMat4::ZERO, ..taken() }, "clip_from_world"),
            (Taken { clip_from_world: taken().clip_from_world * f64::NAN, ..taken() }, "clip_from_world"),
            (Taken { clip_from_world: seen, reversed: false, ..taken() }, "reversed or not"),
            (Taken { velocity_m_s: DVec3::X * 3e3, ..taken() }, "velocity_m_s"),
            (Taken { time_s: f64::INFINITY, ..taken() }, "time_s"),
        ] {
            let e = bad.check().unwrap_err();
            assert!(e.to_string().contains(name), "{}", e);
        }
    }
}
