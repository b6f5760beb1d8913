//! Properties of a planet that the sky needs: its air, its ground and its sun, with units and accepted ranges.
//!
//! A [`Planet`] is plain data. Everything that goes through all its fields (range checks, the planet file, the hash
//! that names cached tables) reads one list, `FIELDS`, so that none of them can miss a new field.

mod file;
mod model;
mod rayleigh;
mod spectra;
pub mod spectral;

pub(crate) use model::FIELDS;
pub use model::{Absorption, Mie, Planet, Rayleigh};
pub use rayleigh::{
    AIR_DENSITY_15C_PER_M3, DOBSON_UNIT_PER_M2, EARTH_RAYLEIGH_SCALE_HEIGHT_M, rayleigh_optical_depth,
    rayleigh_scattering_per_m,
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_field_is_in_the_list_and_changes_the_hash() {
        // The struct has 7 triples and 8 single numbers; the list must reach each of them.
        let numbers: usize = FIELDS.iter().map(|f| (f.get)(&Planet::earth()).len()).sum();
        assert_eq!(numbers * 8, std::mem::size_of::<Planet>());
        let earth = Planet::earth();
        let mut seen = std::collections::BTreeSet::from([earth.hash()]);
        for field in &FIELDS {
            for i in 0..(field.get)(&earth).len() {
                let mut other = earth;
                (field.set)(&mut other)[i] += 1e-9;
                assert!(seen.insert(other.hash()), "{} [{i}] does not change the hash", field.name());
            }
        }
    }

    #[test]
    fn hash_is_the_same_on_every_machine() {
        // The hash names cached tables: a change of this number means that old caches are no longer read.
        assert_eq!(golden().hash(), 0x03d2_538b_fb47_2cc1);
    }

    #[test]
    fn rayleigh_follows_bodhaine() {
        // Bodhaine et al. 1999, equation 30, and the coefficient at 15 C, computed independently.
        let table = [
            (400.0, 0.36021, 42.64),
            (440.0, 0.24261, 28.72),
            (500.0, 0.14335, 16.97),
            (550.0, 0.09707, 11.49),
            (600.0, 0.06809, 8.06),
            (650.0, 0.04918, 5.82),
            (680.0, 0.04096, 4.85),
            (700.0, 0.03642, 4.31),
        ];
        for (nm, tau, beta) in table {
            assert!((rayleigh_optical_depth(nm) - tau).abs() < 6e-6, "{nm}");
            // The table's coefficients are rounded to 0.01 and come from a density that is 0.025 % higher.
            assert!((rayleigh_scattering_per_m(nm) * 1e6 - beta).abs() < 5e-3 + 2.5e-4 * beta, "{nm}");
            let column = rayleigh_scattering_per_m(nm) * EARTH_RAYLEIGH_SCALE_HEIGHT_M;
            assert!((column / rayleigh_optical_depth(nm) - 1.0).abs() < 1e-12);
        }
        assert!((EARTH_RAYLEIGH_SCALE_HEIGHT_M - 8450.0).abs() < 1.0);
    }

    #[test]
    fn fields_are_checked_against_range_and_each_other() {
        assert!(Planet::earth().check().is_ok());
        for field in &FIELDS {
            for bad in [f64::NAN, f64::INFINITY, field.range.0 - 1.0, field.range.1 + 1.0 + field.range.1.abs()] {
                let mut planet = Planet::earth();
                (field.set)(&mut planet)[0] = bad;
                let e = planet.check().unwrap_err();
                assert!(e.to_string().contains(&field.name()) && e.to_string().contains(&field.accepted()), "{}", e);
            }
        }
        let inside_out = Planet { top_radius_m: 6.3e6, ..Planet::earth() };
        assert!(inside_out.check().unwrap_err().to_string().contains("top_radius_m must be above bottom_radius_m"));
        let mut glowing = Planet::earth();
        glowing.mie.scattering_per_m[1] *= 2.0;
        assert!(glowing.check().unwrap_err().to_string().contains("mie.scattering_per_m must be at most"));
        let mut flat = Planet::earth();
        (flat.rayleigh.scale_height_m, flat.mie.scale_height_m) = (0.0, 1e6);
        assert!(flat.check().is_ok());
    }

    fn golden() -> Planet {
        Planet::from_toml(include_str!("../../examples/data/planet_golden.toml")).unwrap()
    }

    #[test]
    fn values_at_the_planets_own_wavelengths_are_kept_and_others_follow_the_laws() {
        let earth = Planet::earth();
        let same = earth.at_wavelengths(earth.wavelengths_nm);
        let apart = earth.at_wavelengths([600.0, 500.0, 400.0]);
        let laws = Planet::earth_at([600.0, 500.0, 400.0]);
        for field in &FIELDS {
            for i in 0..(field.get)(&earth).len() {
                let (a, b) = ((field.get)(&earth)[i], (field.get)(&same)[i]);
                assert!((a - b).abs() <= 1e-12 * a.abs(), "{} {a} {b}", field.name());
                // Between the planet's own wavelengths and outside them the laws hold.
                let (a, b) = ((field.get)(&apart)[i], (field.get)(&laws)[i]);
                assert!((a - b).abs() <= 1e-9 * b.abs(), "{} {a} {b}", field.name());
            }
        }
    }

    #[test]
    fn file_is_read_and_written_bit_for_bit() {
        let planet = golden();
        assert_eq!(planet.wavelengths_nm, [440.0, 520.0, 600.0]);
        assert_eq!(planet.mie.asymmetry_g, 0.8);
        assert_eq!(planet.absorption.half_width_m, 15000.0);
        for p in [planet, Planet::earth(), Planet::earth().with_air_scaled(1e4 / 3.0)] {
            assert_eq!(Planet::from_toml(&p.to_toml()).unwrap(), p, "{}", p.to_toml());
        }
    }
}
