//! Uniform buffers of the sky's shaders, field for field as `shaders/sky` declares them.

use bytemuck::{Pod, Zeroable};

use super::Planet;
use super::reference::medium::Medium;
use super::settings::SkySettings;
use crate::planet::spectral::SpectralTriple;
/// Factor by which the texels of the light table are larger than the light that they store. `LIGHT_SCALE` of
/// `sky/build.wgsl` and `SKY_LIGHT_SCALE` of `sky/lookup.wgsl` have the same value.
pub(crate) const LIGHT_SCALE: f32 = 4096.0;

/// Mirrors `SkyAir` of `sky/air.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(crate) struct AirUniform {
    pub bottom_m: f32,
    pub thickness_m: f32,
    pub sun_angular_radius: f32,
    pub asymmetry_g: f32,
    pub rayleigh_scattering: [f32; 3],
    pub rayleigh_scale_height_m: f32,
    pub mie_scattering: [f32; 3],
    pub mie_scale_height_m: f32,
    pub mie_extinction: [f32; 3],
    pub ozone_center_m: f32,
    pub ozone_extinction: [f32; 3],
    pub ozone_half_width_m: f32,
    pub ground_albedo: [f32; 3],
    pub top_dip: f32,
    pub part_a: [f32; 3],
    pub layer: f32,
    pub part_b: [f32; 3],
    pub layers: f32,
    pub part_c: [f32; 3],
    pub unused: f32,
}

/// Contents of a uniform buffer of `SkyAir` (`sky/air.wgsl`), for shaders that include Welkin's functions of the air.
pub fn air_uniform(planet: &Planet) -> Vec<u8> {
    bytemuck::bytes_of(&AirUniform::of(planet)).to_vec()
}

impl AirUniform {
    /// Values of the planet in f32. A medium without thickness gets a small thickness and no effect, so that no shader
    /// divides by 0.
    pub fn of(planet: &Planet) -> Self {
        let f = |v: [f64; 3]| v.map(|x| x as f32);
        let unless_flat = |flat: bool, v: [f64; 3]| if flat { [0.0; 3] } else { f(v) };
        let (gas, haze, ozone) = (&planet.rayleigh, &planet.mie, &planet.absorption);
        let (no_gas, no_haze) = (gas.scale_height_m <= 0.0, haze.scale_height_m <= 0.0);
        let no_ozone = ozone.half_width_m <= 0.0;
        let ratio = planet.bottom_radius_m / planet.top_radius_m;
        Self {
            bottom_m: planet.bottom_radius_m as f32,
            thickness_m: planet.thickness_m() as f32,
            sun_angular_radius: planet.sun_angular_radius_deg.to_radians() as f32,
            asymmetry_g: planet.mie.asymmetry_g as f32,
            rayleigh_scattering: unless_flat(no_gas, gas.scattering_per_m),
            rayleigh_scale_height_m: (gas.scale_height_m as f32).max(1e-2),
            mie_scattering: unless_flat(no_haze, haze.scattering_per_m),
            mie_scale_height_m: (haze.scale_height_m as f32).max(1e-2),
            mie_extinction: unless_flat(no_haze, haze.extinction_per_m),
            ozone_center_m: ozone.center_altitude_m as f32,
            ozone_extinction: unless_flat(no_ozone, ozone.extinction_per_m),
            ozone_half_width_m: (ozone.half_width_m as f32).max(1.0),
            ground_albedo: f(planet.ground_albedo),
            top_dip: (1.0 - ratio * ratio).sqrt() as f32,
            part_a: [1.0, 0.0, 0.0],
            layer: 0.0,
            part_b: [0.0, 1.0, 0.0],
            layers: 1.0,
            part_c: [0.0, 0.0, 1.0],
            unused: 0.0,
        }
    }

    /// Converts the air to a [`Medium`], the form that the functions of the f64 reference take.
    pub fn medium(&self) -> Medium {
        let f = |v: [f32; 3]| v.map(f64::from);
        Medium {
            bottom_m: self.bottom_m.into(),
            top_m: self.thickness_m.into(),
            extinction: [self.rayleigh_scattering, self.mie_extinction, self.ozone_extinction].map(f),
            scattering: [self.rayleigh_scattering, self.mie_scattering].map(f),
            scale_height_m: [self.rayleigh_scale_height_m, self.mie_scale_height_m].map(f64::from),
            ozone_m: (self.ozone_center_m.into(), self.ozone_half_width_m.into()),
            asymmetry_g: self.asymmetry_g.into(),
        }
    }

    /// Returns an air for each of `parts`, the triples of a set of wavelengths. Its `part_a`, `part_b` and `part_c` are
    /// the columns of the triple's matrix, `layer` is the triple's index, and `layers` the number of triples.
    pub fn of_parts(parts: &[SpectralTriple]) -> Vec<Self> {
        let one = |(layer, part): (usize, &SpectralTriple)| {
            let [part_a, part_b, part_c] = part.columns.map(|c| c.map(|v| v as f32));
            let (layer, layers) = (layer as f32, parts.len() as f32);
            Self { part_a, part_b, part_c, layer, layers, ..Self::of(&part.planet) }
        };
        parts.iter().enumerate().map(one).collect()
    }

    /// Interpolates between this air and `other`, whose weight is `t`. Look-ups use the result while the tables of one
    /// planet fade to those of another.
    pub fn mix(&self, other: &Self, t: f32) -> Self {
        let a: [f32; 36] = bytemuck::cast(*self);
        let b: [f32; 36] = bytemuck::cast(*other);
        bytemuck::cast::<[f32; 36], Self>(std::array::from_fn(|i| {
            if a[i] == b[i] { a[i] } else { a[i] + (b[i] - a[i]) * t }
        }))
    }
}

/// Mirrors `SkyDims` of `sky/maps.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
pub(crate) struct DimsUniform {
    pub suns: u32,
    pub altitudes: u32,
    pub zeniths: u32,
    pub azimuths: u32,
    pub rule_zeniths: u32,
    pub rule_azimuths: u32,
    pub build_panels: u32,
    pub sky_panels: u32,
    pub sky_azimuths: u32,
    pub sky_above: u32,
    pub sky_below: u32,
    pub air_panels: u32,
    pub air_azimuths: u32,
    pub air_above: u32,
    pub air_below: u32,
    pub air_slices: u32,
    pub sky_x: u32,
    pub sky_y: u32,
    pub tables_width: u32,
    pub tables_height: u32,
}

impl DimsUniform {
    pub fn of(s: &SkySettings) -> Self {
        let (sky_x, sky_y) = s.sky_corner();
        let (tables_width, tables_height) = s.observer_size();
        Self {
            suns: s.suns,
            altitudes: s.altitudes,
            zeniths: s.zeniths,
            azimuths: s.azimuths,
            rule_zeniths: s.rule_zeniths,
            rule_azimuths: s.rule_azimuths,
            build_panels: s.build_panels,
            sky_panels: s.sky_panels,
            sky_azimuths: s.sky_azimuths,
            sky_above: s.sky_above,
            sky_below: s.sky_below,
            air_panels: s.air_panels,
            air_azimuths: s.air_azimuths,
            air_above: s.air_above,
            air_below: s.air_below,
            air_slices: s.air_slices,
            sky_x,
            sky_y,
            tables_width,
            tables_height,
        }
    }

    /// Texture coordinates of the sky above the horizon: the centre of its first texel, and the offset from there to
    /// the centre of its last texel.
    pub fn sky_above(&self) -> [f32; 4] {
        let [x, y, above, azimuths] =
            [self.sky_x, self.sky_y, self.sky_above - 1, self.sky_azimuths - 1].map(f64::from);
        let [width, height] = [self.tables_width, self.tables_height].map(f64::from);
        [(x + 0.5) / width, (y + 0.5) / height, above / width, azimuths / height].map(|v| v as f32)
    }
}

/// Mirrors `SkyJob` of `sky/build.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct JobUniform {
    pub order: u32,
    pub last: u32,
    pub unused: [u32; 2],
}

/// Mirrors `SkyObserver` of `sky/observer.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(crate) struct ObserverUniform {
    pub altitude: f32,
    pub mu_s: f32,
    pub is_air: u32,
    pub unused: u32,
    pub edges: EdgesUniform,
}

/// Mirrors `SkyEdges` of `sky/view.wgsl`; computed in f64.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(crate) struct EdgesUniform {
    pub horizon: f32,
    pub top: f32,
    pub above_scale: f32,
    pub below_scale: f32,
}

impl EdgesUniform {
    pub fn of(air: &AirUniform, altitude: f64) -> Self {
        let (bottom, thickness, h) = (f64::from(air.bottom_m), f64::from(air.thickness_m), altitude.max(0.0));
        let half_sine = |mu: f64| (0.5 - 0.5 * mu).max(0.0).sqrt();
        let horizon = half_sine(-(h * (2.0 * bottom + h)).sqrt() / (bottom + h));
        let over = h - thickness;
        let top = if over > 0.0 {
            half_sine(-(over * (2.0 * (bottom + thickness) + over)).sqrt() / (bottom + h))
        } else {
            0.0
        };
        Self {
            horizon: horizon as f32,
            top: top as f32,
            above_scale: (1.0 / (horizon - top).max(1e-7)) as f32,
            below_scale: (1.0 / (1.0 - horizon).max(1e-7)) as f32,
        }
    }
}

/// Mirrors `SkyLamp` of `sky/lookup.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(crate) struct LampUniform {
    pub toward: [f32; 3],
    pub angular_radius: f32,
    pub irradiance: [f32; 3],
    pub kind: u32,
    pub limb: [f32; 3],
    pub inverse_radius: f32,
    pub lit_from: [f32; 3],
    pub depth_from: f32,
    pub level: [f32; 2],
    pub layer: u32,
    pub unused_b: u32,
    pub disc: [f32; 3],
    pub depth_scale: f32,
    pub depth: [[f32; 4]; 4],
}

/// Mirrors `SkyView` of `sky/lookup.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(crate) struct ViewUniform {
    pub air: AirUniform,
    pub dims: DimsUniform,
    pub edges: EdgesUniform,
    pub sky_above: [f32; 4],
    pub altitude: f32,
    pub lamp_count: u32,
    pub refraction: f32,
    pub march_panels: u32,
    pub lamps: [LampUniform; 2],
}

#[cfg(test)]
mod tests {
    use std::mem::{offset_of, size_of};

    use super::*;
    use crate::gpu::shader::{assemble, struct_layout};

    #[test]
    fn structs_lie_as_the_shaders_read_them() {
        let lookup = assemble("sky/lookup.wgsl").unwrap();
        let build = assemble("sky/build.wgsl").unwrap();
        let observer = assemble("sky/observer.wgsl").unwrap();
        for (text, name, size, count) in [
            (&lookup, "SkyAir", size_of::<AirUniform>(), 20),
            (&lookup, "SkyDims", size_of::<DimsUniform>(), 20),
            (&lookup, "SkyEdges", size_of::<EdgesUniform>(), 4),
            (&lookup, "SkyLamp", size_of::<LampUniform>(), 14),
            (&lookup, "SkyView", size_of::<ViewUniform>(), 9),
            (&build, "SkyJob", size_of::<JobUniform>(), 4),
            (&observer, "SkyObserver", size_of::<ObserverUniform>(), 5),
        ] {
            let (span, members) = struct_layout(text, name).unwrap();
            assert_eq!((span as usize, members.len()), (size, count), "{name}");
        }
        let at = |name: &str, member: &str| {
            let (_, members) = struct_layout(&lookup, name).unwrap();
            members.iter().find(|(n, _)| n == member).unwrap().1 as usize
        };
        assert_eq!(at("SkyAir", "ground_albedo"), offset_of!(AirUniform, ground_albedo));
        assert_eq!(at("SkyAir", "layers"), offset_of!(AirUniform, layers));
        assert_eq!(at("SkyAir", "part_c"), offset_of!(AirUniform, part_c));
        assert_eq!(at("SkyAir", "mie_extinction"), offset_of!(AirUniform, mie_extinction));
        assert_eq!(at("SkyLamp", "lit_from"), offset_of!(LampUniform, lit_from));
        assert_eq!(at("SkyLamp", "level"), offset_of!(LampUniform, level));
        assert_eq!(at("SkyLamp", "disc"), offset_of!(LampUniform, disc));
        assert_eq!(at("SkyLamp", "depth_from"), offset_of!(LampUniform, depth_from));
        assert_eq!(at("SkyLamp", "depth"), offset_of!(LampUniform, depth));
        assert_eq!(at("SkyView", "edges"), offset_of!(ViewUniform, edges));
        assert_eq!(at("SkyView", "sky_above"), offset_of!(ViewUniform, sky_above));
        assert_eq!(at("SkyView", "march_panels"), offset_of!(ViewUniform, march_panels));
        assert_eq!(at("SkyView", "lamps"), offset_of!(ViewUniform, lamps));
    }

    #[test]
    fn media_without_thickness_are_harmless() {
        let mut planet = Planet::earth();
        planet.rayleigh.scale_height_m = 0.0;
        planet.absorption.half_width_m = 0.0;
        let air = AirUniform::of(&planet);
        assert_eq!((air.rayleigh_scattering, air.ozone_extinction), ([0.0; 3], [0.0; 3]));
        assert!(air.rayleigh_scale_height_m > 0.0 && air.ozone_half_width_m > 0.0);
        let earth = AirUniform::of(&Planet::earth());
        assert_eq!(air.mix(&earth, 0.0), air);
        assert_eq!(air.mix(&earth, 0.5).bottom_m, earth.bottom_m);
    }
}
