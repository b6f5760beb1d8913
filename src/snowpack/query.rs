//! Answers to a host's queries about lying snow.

use glam::DVec3;

use super::{
    column::{Column, UNITS},
    held::HeldSnow,
    published::seen,
    site::ground_m,
};
use crate::{error::Result, surroundings::SnowHere, weather::snow_cover, world::World};

/// Class of a wheel's grip on snow. Conditions are tested in the order bare, slush, ice, packed; snow that meets none
/// of them is loose.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[repr(u32)]
pub enum SnowFriction {
    /// Snow covers less than 0.3 of the ground.
    #[default]
    Bare = 0,
    /// Loose snow, dry or with at most half of the liquid water that it can hold.
    Loose = 1,
    /// Snow denser than 350 kg/m^3: pressed, or packed by wind.
    Packed = 2,
    /// Slush: snow with more than half of the liquid water that it can hold.
    Slush = 3,
    /// Snow denser than 650 kg/m^3: frozen hard.
    Ice = 4,
}

/// Lying snow at a place.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct SnowAt {
    /// Depth, m.
    pub depth_m: f64,
    /// Mass of ice and liquid water, kg/m^2.
    pub mass_kg_m2: f64,
    /// Density, kg/m^3; 0 without snow.
    pub density_kg_m3: f64,
    /// Ratio of the liquid water in the snow to the most that it can hold, 0 to 1.
    pub wetness: f64,
    /// Albedo for visible light; 0 without snow.
    pub albedo: f64,
    /// Share of the ground that snow covers, 0 to 1.
    pub cover: f64,
    /// Point of the snow's surface above or below the queried position, in the host's world. It is the queried position
    /// itself if this lies off the host's terrain or more than 3 m above the ground, and without simulated snow.
    pub surface: DVec3,
    /// Grip of a wheel.
    pub friction: SnowFriction,
}

/// Mass balance of the snow on the host's terrain since the snow began, kg:
/// began + fallen + blown in = lying + blown out + ran off + sublimated + taken.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct SnowBalance {
    /// Snow that lay on a part of the terrain when the host set that part.
    pub began_kg: f64,
    /// Snow and ice that fell, and rain that fell on snow.
    pub fallen_kg: f64,
    /// Snow that the wind blew in over the terrain's border.
    pub blown_in_kg: f64,
    /// Snow that the wind blew out over the terrain's border.
    pub blown_out_kg: f64,
    /// Melt water and rain that ran off to the ground.
    pub ran_off_kg: f64,
    /// Snow that sublimated into the air.
    pub sublimated_kg: f64,
    /// Snow that the host took away. It includes the snow on removed terrain and where standing boxes were set.
    pub taken_kg: f64,
    /// Snow that lies on the terrain now.
    pub lying_kg: f64,
}

impl SnowAt {
    /// Creates the answer for a place: chooses the friction by cover, wetness and density.
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
    /// Returns the snow at a place, for [`Context::snow_at`](crate::context::Context::snow_at): between cells, the
    /// bilinear mean of their depth and mass, and the mean by mass of wetness and albedo.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] if `position` is not finite, farther than 1e12 m from the world's origin, or
    /// not at an altitude in \[-1e4, 1e9\] m.
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

    /// Returns the mass balance of the snow on the host's terrain; `None` without a terrain or without simulated snow.
    pub fn books(&self) -> Option<SnowBalance> {
        let (_, field) = self.field()?;
        let kg = |units: i64| units as f64 / UNITS * field.cell_m * field.cell_m;
        let b = field.books;
        Some(SnowBalance {
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
