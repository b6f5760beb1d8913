//! Queries of the host about lying snow.

use glam::DVec3;

use super::{
    column::{Column, UNITS},
    held::HeldSnow,
    published::seen,
    site::ground_m,
};
use crate::{error::Result, surroundings::SnowHere, weather::snow_cover, world::World};

/// How a wheel holds on the ground, as far as snow decides it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[repr(u32)]
pub enum SnowFriction {
    /// No snow, or too little to matter.
    #[default]
    Bare = 0,
    /// Loose, dry snow.
    Loose = 1,
    /// Snow above 350 kg/m^3: pressed or packed by wind.
    Packed = 2,
    /// Slush: more than half of the water that it can hold.
    Slush = 3,
    /// Above 650 kg/m^3: frozen hard.
    Ice = 4,
}

/// Snow at a place.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct SnowAt {
    /// Depth, m.
    pub depth_m: f64,
    /// Ice and water, kg/m^2.
    pub mass_kg_m2: f64,
    /// kg/m^3; 0 without snow.
    pub density_kg_m3: f64,
    /// Held water over what the snow can hold, 0 to 1.
    pub wetness: f64,
    /// Albedo of visible light; 0 without snow.
    pub albedo: f64,
    /// Share of the ground that it covers.
    pub cover: f64,
    /// The place above or below the one asked for on the snow's surface, in the host's world; off the host's terrain
    /// the place itself.
    pub surface: DVec3,
    /// How a wheel holds.
    pub friction: SnowFriction,
}

/// Where the mass of the snow on the host's terrain came from and went since it began, kg: what began, fell and blew in
/// is what lies, blew out, ran off, sublimated and was taken.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct SnowBooks {
    /// Mass that lay when the terrain was set.
    pub began_kg: f64,
    /// Snow and ice that fell, and rain that fell on snow.
    pub fallen_kg: f64,
    /// Came in over the terrain's border.
    pub blown_in_kg: f64,
    /// Left over the terrain's border.
    pub blown_out_kg: f64,
    /// Melted and ran to the ground.
    pub ran_off_kg: f64,
    /// Went to the air.
    pub sublimated_kg: f64,
    /// The host took away.
    pub taken_kg: f64,
    /// Lies.
    pub lying_kg: f64,
}

impl SnowAt {
    fn of(here: SnowHere, mass_kg_m2: f64, surface: DVec3) -> Self {
        let cover = snow_cover(here.depth_m);
        let friction = match here {
            _ if cover < 0.3 => SnowFriction::Bare,
            SnowHere { wetness, .. } if wetness > 0.5 => SnowFriction::Slush,
            SnowHere { density_kg_m3, .. } if density_kg_m3 > 650.0 => SnowFriction::Ice,
            SnowHere { density_kg_m3, .. } if density_kg_m3 > 350.0 => SnowFriction::Packed,
            _ => SnowFriction::Loose,
        };
        Self {
            depth_m: here.depth_m,
            mass_kg_m2,
            density_kg_m3: here.density_kg_m3,
            wetness: here.wetness,
            albedo: here.albedo,
            cover,
            surface,
            friction,
        }
    }
}

impl HeldSnow {
    /// Snow at a place; see [`Context::snow_at`](crate::context::Context::snow_at).
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] if the position is no place.
    pub fn at(&self, world: &World, position: DVec3) -> Result<SnowAt> {
        world.frame.place_at("position", position)?;
        let country = self.country(world);
        let Some((site, field)) = self.field() else {
            return Ok(SnowAt::of(seen(&country), country.mass_kg_m2(), position));
        };
        let Some(about) = site.about(field, position) else {
            return Ok(SnowAt::of(seen(&country), country.mass_kg_m2(), position));
        };
        let between = |of: &dyn Fn(&Column) -> f64| {
            let each = about.iter().flatten().map(|((patch, cell), s)| of(&field.patches[*patch].column(*cell)) * s);
            each.sum::<f64>()
        };
        let (depth_m, mass) = (between(&Column::depth_m), between(&Column::mass_kg_m2));
        let by_mass = |of: &dyn Fn(&Column) -> f64| {
            if mass > 0.0 { between(&|c| of(c) * c.mass_kg_m2()) / mass } else { 0.0 }
        };
        let here = SnowHere {
            depth_m,
            density_kg_m3: if depth_m > 0.0 { mass / depth_m } else { 0.0 },
            wetness: by_mass(&Column::wetness),
            albedo: by_mass(&Column::albedo),
        };
        let local = site.local(position).truncate().extend(ground_m(field, &about) + depth_m);
        Ok(SnowAt::of(here, mass, site.position(local)))
    }

    /// Where the mass on the host's terrain came from and went; `None` without a terrain.
    pub fn books(&self) -> Option<SnowBooks> {
        let (_, field) = self.field()?;
        let kg = |units: i64| units as f64 / UNITS * field.cell_m * field.cell_m;
        let b = field.books;
        Some(SnowBooks {
            began_kg: kg(b.began),
            fallen_kg: kg(b.fallen),
            blown_in_kg: kg(b.blown_in),
            blown_out_kg: kg(b.blown_out),
            ran_off_kg: kg(b.ran_off),
            sublimated_kg: kg(b.sublimated),
            taken_kg: kg(b.taken),
            lying_kg: kg(field.lying()),
        })
    }
}
