//! Inputs of a picture of the stars, and their conversion to the shader's uniforms.

use glam::{DMat3, DMat4};

use super::{
    catalogue::Star,
    light::star_lux,
    places::Heavens,
    planets::{Body, PlanetPlace},
};
use crate::{
    error::{Result, check_range},
    scene::{DepthUniform, ViewRays},
};

/// Largest optical depth straight up that a view accepts; exp(-1000) is practically 0.
pub(super) const MOST_ZENITH_DEPTH: f64 = 1e3;

/// Inputs of a picture of the stars.
#[derive(Clone, Copy, Debug)]
pub struct StarView<'a> {
    /// Directions of the stars.
    pub heavens: &'a Heavens,
    /// Matrix from camera-relative (east, north, up) to clip space. With parallel rays no stars are drawn.
    pub clip: DMat4,
    /// Rays of the camera in the same axes, to interpret the host's depth.
    pub rays: &'a ViewRays,
    /// Width and height of the target, pixels, each in [1, 65 536].
    pub size: [u32; 2],
    /// 1 where row 0 of the target is the picture's top, -1 where it is the bottom.
    pub y_sign: f32,
    /// Optical depths of the air above the camera, straight up, at the three wavelengths, [0, 1e3].
    pub zenith_depth: [f64; 3],
    /// Share of a star's light that clouds and fog let through, [0, 1].
    pub transmittance: f64,
    /// Density of the air at the camera relative to that at 1010 hPa and 10 C, for refraction, [0, 10]; 0 in space.
    pub air_density: f64,
    /// Lowest elevation that the planet does not hide, degrees, [-90, 90]; the dip of the horizon makes it negative.
    pub horizon_deg: f64,
    /// Units of the target per cd/m^2, [0, 1e12].
    pub scale: f64,
    /// Illuminance at the eye of the faintest star to draw, lux, [0, 1e6]: the greater of
    /// [`super::limits::threshold_lux`] and [`super::limits::display_threshold_lux`], or 0 for all stars.
    pub faintest_lux: f64,
}

impl StarView<'_> {
    /// Checks that every field is within its range.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the field.
    pub fn validate(&self) -> Result<()> {
        for (name, value) in ["width", "height"].into_iter().zip(self.size) {
            check_range(name, f64::from(value), 1.0, 65_536.0, "pixels")?;
        }
        self.zenith_depth
            .iter()
            .try_for_each(|depth| check_range("zenith_depth", *depth, 0.0, MOST_ZENITH_DEPTH, ""))?;
        check_range("transmittance", self.transmittance, 0.0, 1.0, "")?;
        check_range("air_density", self.air_density, 0.0, 10.0, "")?;
        check_range("horizon_deg", self.horizon_deg, -90.0, 90.0, "deg")?;
        check_range("scale", self.scale, 0.0, 1e12, "")?;
        check_range("faintest_lux", self.faintest_lux, 0.0, 1e6, "lux")
    }

    /// Solid angle of a pixel divided by the cube of clip w, sr.
    ///
    /// Rows x, y, w of the clip matrix M map a unit direction d to w (X, Y, 1), where X and Y are coordinates in the
    /// picture; so d = w M^-1 (X, Y, 1). The cone over dX dY has the solid angle |det M^-1| dX dY / |M^-1 (X, Y, 1)|^3,
    /// and |M^-1 (X, Y, 1)| = 1/w. A pixel is 2/width by 2/height.
    pub fn pixel_sr(&self) -> f64 {
        let rows = [0, 1, 3].map(|i| self.clip.row(i).truncate());
        let determinant = DMat3::from_cols(rows[0], rows[1], rows[2]).determinant().abs();
        4.0 / (f64::from(self.size[0]) * f64::from(self.size[1]) * determinant.max(1e-30))
    }

    pub(super) fn uniform(&self) -> StarUniform {
        let column = |i: usize| self.heavens.to_world.col(i).as_vec3().extend(0.0).to_array();
        StarUniform {
            depth: self.rays.uniform(),
            clip: self.clip.as_mat4().to_cols_array_2d(),
            to_world: [column(0), column(1), column(2)],
            velocity: self.heavens.velocity.as_vec3().to_array(),
            scale: self.scale as f32,
            zenith_depth: self.zenith_depth.map(|d| d as f32),
            transmittance: self.transmittance as f32,
            size: self.size.map(|s| s as f32),
            pixel_sr: self.pixel_sr() as f32,
            y_sign: self.y_sign,
            faintest: self.faintest_lux as f32,
            air_density: self.air_density as f32,
            horizon: self.horizon_deg.to_radians().sin() as f32,
            pad: 0.0,
        }
    }
}

/// Mirrors `StarUniform` of `shaders/stars/points.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub(super) struct StarUniform {
    pub depth: DepthUniform,
    pub clip: [[f32; 4]; 4],
    pub to_world: [[f32; 4]; 3],
    pub velocity: [f32; 3],
    pub scale: f32,
    pub zenith_depth: [f32; 3],
    pub transmittance: f32,
    pub size: [f32; 2],
    pub pixel_sr: f32,
    pub y_sign: f32,
    pub faintest: f32,
    pub air_density: f32,
    pub horizon: f32,
    pub pad: f32,
}

/// One star as the vertex shader reads it, 24 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub(super) struct StarInstance {
    /// Unit vector in J2000.0, with proper motion applied.
    pub direction: [f32; 3],
    /// Illuminance above the air, lux a channel.
    pub lux: [f32; 3],
}

impl StarInstance {
    pub fn of_star(star: &Star, years: f64) -> Self {
        Self {
            direction: star.direction_at(years).as_vec3().to_array(),
            lux: star_lux(star.magnitude, star.temperature_k).map(|v| v as f32),
        }
    }

    pub fn of_planet(place: &PlanetPlace) -> Self {
        Self {
            direction: place.direction.as_vec3().to_array(),
            lux: star_lux(place.magnitude, planet_temperature_k(place.body)).map(|v| v as f32),
        }
    }
}

/// Temperature of the black body with a planet's colour, K, from its B-V (Mallama, Krobusek and Pavlov 2017, Icarus
/// 282, 19).
pub fn planet_temperature_k(body: Body) -> f64 {
    let b_v = match body {
        Body::Mercury => 0.97,
        Body::Venus => 0.81,
        Body::Mars => 1.43,
        Body::Jupiter => 0.87,
        Body::Saturn => 1.09,
        Body::Uranus => 0.50,
    };
    super::light::temperature_of_color_index(b_v)
}
