//! `probe rain-speed`, `probe rain`, `probe ice`: precipitation by particle size.

use welkin::{
    Result,
    rain::{
        drops::{altitude_factor, terminal_speed_m_s},
        ice::StoneSizes,
        sizes::DropSizes,
    },
};

use crate::csv::{Column, Table};

/// Range of precipitation rates, mm/h.
const RATES: [f64; 2] = [0.0, 500.0];

/// Needs a column `diameter_mm` (\[0, 20\]); `altitude_m` (\[-1000, 11 000\]) is optional, 0 by default. Answers with
/// the terminal speed of a drop, `speed_m_s`.
///
/// # Errors
/// [`welkin::Status::Parse`] with line and column for wrong input.
pub fn speeds(text: &str) -> Result<String> {
    let table = Table::read(text, "diameter_mm")?;
    let columns =
        [Column::new("diameter_mm", [0.0, 20.0], "mm"), Column::new("altitude_m", [-1000.0, 11_000.0], "m").or(0.0)];
    let speed = |[diameter, altitude]: [f64; 2]| terminal_speed_m_s(diameter) * altitude_factor(altitude);
    let answers = table.numbers(&columns)?.into_iter().map(|n| format!("{:?}", speed(n)));
    Ok(table.answered("speed_m_s", answers))
}

/// Needs a column `rate_mm_h` (\[0, 500\]). Answers with the properties of steady rain of that rate at sea level:
/// `number_per_m3,liquid_g_m3,rate_closed_mm_h,extinction_per_km,median_volume_diameter_mm`.
///
/// # Errors
/// [`welkin::Status::Parse`] with line and column for wrong input.
pub fn rates(text: &str) -> Result<String> {
    let table = Table::read(text, "rate_mm_h")?;
    let answer = |[rate]: [f64; 1]| {
        let s = DropSizes::of_rain(rate, 1.0);
        let rate = s.on_level_ground().rate_mm_h;
        let (number, water, extinction) = (s.number_per_m3(), s.liquid_g_m3(), 1e3 * s.extinction_per_m());
        format!("{number:?},{water:?},{rate:?},{extinction:?},{:?}", s.median_volume_diameter_mm())
    };
    let answers = table.numbers(&[Column::new("rate_mm_h", RATES, "mm/h")])?.into_iter().map(answer);
    let added = "number_per_m3,liquid_g_m3,rate_closed_mm_h,extinction_per_km,median_volume_diameter_mm";
    Ok(table.answered(added, answers))
}

/// Needs a column `hail_mm_h`; `pellets_mm_h` is optional (\[0, 500\] each). Answers with the properties of such ice at
/// sea level: `number_per_m3,ice_g_m3,rate_closed_mm_h,extinction_per_km,mean_diameter_mm`.
///
/// # Errors
/// [`welkin::Status::Parse`] with line and column for wrong input.
pub fn ice(text: &str) -> Result<String> {
    let table = Table::read(text, "hail_mm_h")?;
    let answer = |[hail, pellets]: [f64; 2]| {
        let s = StoneSizes::of_rates(pellets, hail, 1.0);
        let rate = s.on_surface(glam::DVec3::Z, glam::DVec3::ZERO).rate_mm_h;
        let (number, ice, extinction) = (s.number_per_m3(), s.ice_g_m3(), 1e3 * s.extinction_per_m());
        format!("{number:?},{ice:?},{rate:?},{extinction:?},{:?}", s.mean_diameter_mm())
    };
    let columns = [Column::new("hail_mm_h", RATES, "mm/h"), Column::new("pellets_mm_h", RATES, "mm/h").or(0.0)];
    let answers = table.numbers(&columns)?.into_iter().map(answer);
    Ok(table.answered("number_per_m3,ice_g_m3,rate_closed_mm_h,extinction_per_km,mean_diameter_mm", answers))
}
