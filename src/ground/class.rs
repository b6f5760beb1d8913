//! Surface classes of the ground, and how water changes the look of each.
//!
//! | class | darkens | film | depth that covers the relief | puddles |
//! | --- | --- | --- | --- | --- |
//! | soil | as wet ground does | little: water soaks in, and clods are rough | 10 mm | on the host's terrain only |
//! | rock | as wet ground does | in parts, on rough faces | 10 mm | on the host's terrain only |
//! | paved | as wet ground does | everywhere | 1 mm | everywhere |
//! | vegetation | hardly: leaves shed water | none | 50 mm | where water covers the plants |
//! | water | no | none: the host draws it | 0 mm | none |
//! | building | as wet ground does | most of it | 1 mm | on the host's terrain only |
//!
//! Porous and rough ground under water darkens by one law (Angstrom 1925; Lekner & Dorf 1988), the same for soil and
//! asphalt. Albedos of soil range from 0.05 (dark and wet) to 0.4 (light and dry; Oke 1987, table 1.1). The shares of
//! film and the slopes are estimates: no measurements of reflection from wet soil, rock and roofs were found.

pub(crate) use crate::terrain::CLASSES;
pub use crate::terrain::SurfaceClass;

impl SurfaceClass {
    /// Returns whether the class has puddles in the pattern of hollows that is used where the ground's heights are
    /// unknown.
    pub fn has_hollows(self) -> bool {
        self.surface_look().hollows > 0.0
    }

    /// Returns the look of water on the class. [`Self::Unspecified`] counts as soil.
    pub(crate) fn surface_look(self) -> SurfaceLook {
        let look = |soaks, film, slope, relief_mm, most_albedo| SurfaceLook {
            soaks,
            film,
            slope,
            relief_mm,
            most_albedo,
            hollows: 0.0,
            level: 0.0,
            snow: 1.0,
        };
        match self {
            Self::Unspecified | Self::Soil => look(1.0, 0.1, 0.5, 10.0, 0.45),
            Self::Rock => look(1.0, 0.3, 0.4, 10.0, 0.6),
            Self::Paved => SurfaceLook { hollows: 1.0, level: 1.0, ..look(1.0, 1.0, 0.0, 1.0, 0.9) },
            Self::Vegetation => look(0.15, 0.0, 0.6, 50.0, 0.4),
            Self::Water => SurfaceLook { snow: 0.0, ..look(0.0, 0.0, 0.0, 0.0, 0.9) },
            Self::Building => look(1.0, 0.7, 0.1, 1.0, 0.9),
        }
    }
}

/// Look of water on a class: `SurfaceLook` of `shaders/ground/uniform.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct SurfaceLook {
    /// Share of the darkening of wet ground that the class shows.
    pub soaks: f32,
    /// Share of the ground that a closed film covers.
    pub film: f32,
    /// Root mean square slope, along one axis, of the ground under the film, beyond the film's own slope.
    pub slope: f32,
    /// Scale of the ground's relief, mm: standing water begins to cover the relief at 0.2 of this depth and covers all
    /// of it at twice this depth. With 0 no standing water is drawn.
    pub relief_mm: f32,
    /// Upper limit of the albedo estimated from the host's colour.
    pub most_albedo: f32,
    /// Share of the pattern's puddles that the class has.
    pub hollows: f32,
    /// Confidence that the ground is level, 0 to 1, used if neither terrain, normals nor depth give its slope.
    pub level: f32,
    /// Factor on the share of the ground that lying snow covers: 0 on water, 1 on other classes.
    pub snow: f32,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn class_numbers_are_those_of_the_header_and_others_are_refused() {
        for (i, class) in SurfaceClass::ALL.into_iter().enumerate() {
            assert_eq!((class as usize, SurfaceClass::from_number("x", i as u8).unwrap()), (i, class));
        }
        let e = SurfaceClass::from_number("ground_grid.surface_classes[5]", 7).unwrap_err();
        assert_eq!(e.to_string(), "ground_grid.surface_classes[5] must be a WK_SURFACE_CLASS_ value, 0 to 6, got 7");
    }

    #[test]
    fn only_paved_ground_has_hollows_and_plants_and_water_have_no_film() {
        let with = |f: fn(&SurfaceClass) -> bool| SurfaceClass::ALL.into_iter().filter(f).collect::<Vec<_>>();
        assert_eq!(with(|c| c.has_hollows()), [SurfaceClass::Paved]);
        assert_eq!(with(|c| c.surface_look().film == 0.0), [SurfaceClass::Vegetation, SurfaceClass::Water]);
        assert_eq!(SurfaceClass::Unspecified.surface_look(), SurfaceClass::Soil.surface_look());
    }
}
