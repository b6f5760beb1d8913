//! Contact sheet of mistakes with height maps: hillshades of real terrain with each mistake, overlaid by the contour
//! and the water level that the terrain should have.

use std::path::Path;

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use welkin::heights::{HeightMap, HeightSettings};
use welkin::{Error, Result, Status};

use crate::canvas::register_font;

/// Terrain at Jacksboro, Tennessee; `examples/data/README.md` says whose.
const DEM: &[u8] = include_bytes!("../../data/jacksboro_dem.png");
/// South-western sample and size of the part that is shown.
const PART: [u32; 4] = [12, 180, 84, 56];
/// Pixels along a sample's side. Heights between samples are [`HeightMap::resampled`]'s.
const FINER: u32 = 3;
/// Distance of pixels to the east and to the north, m.
const PIXEL_M: [f64; 2] = [74.4 / FINER as f64, 92.5 / FINER as f64];
/// Height of the contour, m.
const CONTOUR_M: f32 = 480.0;
/// Surface of the water, m.
const WATER_M: f32 = 350.0;
/// Height of sea level above the ellipsoid there (EGM96), m: heights above the ellipsoid are those above sea level plus
/// this.
const GEOID_M: f32 = -31.0;
/// Part of a panel below its picture, pixels, and the space between panels.
const CAPTION: u32 = 30;
const GAP: u32 = 6;
const PANELS_IN_A_ROW: u32 = 3;

/// Sheet of panels, in RGB.
struct Sheet {
    size: [u32; 2],
    rgb: Vec<u8>,
}

impl Sheet {
    fn put(&mut self, x: u32, y: u32, color: [u8; 3]) {
        let at = 3 * (y * self.size[0] + x) as usize;
        self.rgb[at..at + 3].copy_from_slice(&color);
    }
}

/// Heights of a panel's pixels, rows from the south; NaN for a hole.
struct Relief {
    size: [u32; 2],
    heights_m: Vec<f32>,
}

impl Relief {
    fn of(map: &HeightMap) -> Self {
        Self { size: [map.columns(), map.rows()], heights_m: map.heights_m().to_vec() }
    }

    /// Relief with heights found from each place and its height.
    fn changed(&self, height: impl Fn(u32, u32, f32) -> f32) -> Self {
        let place = |i: u32| (i % self.size[0], i / self.size[0]);
        let heights_m = (0..).zip(&self.heights_m).map(|(i, h)| height(place(i).0, place(i).1, *h)).collect();
        Self { size: self.size, heights_m }
    }

    fn at(&self, x: u32, y: u32) -> f32 {
        self.heights_m[(y.min(self.size[1] - 1) * self.size[0] + x.min(self.size[0] - 1)) as usize]
    }

    /// Color of a pixel: tinted by height and lit from the north-west, 45 degrees high.
    fn color(&self, x: u32, y: u32) -> [u8; 3] {
        let height = self.at(x, y);
        let slope = |a: f32, b: f32, metres: f64| f64::from(b - a) / (2.0 * metres);
        let east = slope(self.at(x.saturating_sub(1), y), self.at(x + 1, y), PIXEL_M[0]);
        let north = slope(self.at(x, y.saturating_sub(1)), self.at(x, y + 1), PIXEL_M[1]);
        if height.is_nan() {
            return if (x + y) % 8 < 4 { [190, 190, 190] } else { [245, 245, 245] };
        }
        let light =
            (0.5 * (east - north) + std::f64::consts::FRAC_1_SQRT_2) / (1.0 + east * east + north * north).sqrt();
        // A hole beside a slope leaves it unlit.
        let light = if light.is_nan() { 0.7 } else { light.max(0.0) };
        if height < WATER_M {
            return [70, 120, 190].map(|c| (f64::from(c) * (0.6 + 0.5 * light)) as u8);
        }
        let share = f64::from((height - WATER_M) / 500.0).clamp(0.0, 1.0);
        let (low, high) = ([128.0, 156.0, 96.0], [214.0, 196.0, 164.0]);
        std::array::from_fn(|i| ((low[i] + share * (high[i] - low[i])) * (0.25 + 1.05 * light)).min(255.0) as u8)
    }

    /// Whether the contour passes between a pixel and those east or north of it.
    fn has_contour(&self, x: u32, y: u32) -> bool {
        let is_high = |x, y| self.at(x, y) > CONTOUR_M;
        is_high(x, y) != is_high(x + 1, y) || is_high(x, y) != is_high(x, y + 1)
    }
}

/// Panels: caption and relief.
fn panels(truth: &Relief) -> Vec<(&'static str, Relief)> {
    let [columns, rows] = truth.size;
    // A disc without data, as in a radar's shadow behind a hill.
    let is_gap = |x: u32, y: u32| {
        let away = [f64::from(x) - 0.62 * f64::from(columns), f64::from(y) - 0.55 * f64::from(rows)];
        away[0].hypot(1.3 * away[1]) < 0.16 * f64::from(columns)
    };
    // Rows that are read as three samples longer than they are.
    let sheared = |x: u32, y: u32| truth.heights_m[((y * (columns + 3) + x) % (columns * rows)) as usize];
    vec![
        ("as it is", truth.changed(|_, _, h| h)),
        ("mirrored rows", truth.changed(|x, y, _| truth.at(x, rows - 1 - y))),
        (
            "wrong corner",
            truth.changed(|x, y, _| match (x.checked_sub(columns / 2), y.checked_sub(rows / 2)) {
                (Some(x), Some(y)) => truth.at(x, y),
                _ => f32::NAN,
            }),
        ),
        ("8-bit steps of 20 m", truth.changed(|_, _, h| 20.0 * (h / 20.0).round())),
        ("feet read as metres", truth.changed(|_, _, h| h / 0.3048)),
        ("ellipsoid instead of sea", truth.changed(|_, _, h| h + GEOID_M)),
        ("no data read as ground", truth.changed(|x, y, h| if is_gap(x, y) { -9999.0 } else { h })),
        ("no data named: a hole", truth.changed(|x, y, h| if is_gap(x, y) { f32::NAN } else { h })),
        ("rows of the wrong length", truth.changed(|x, y, _| sheared(x, y))),
    ]
}

/// Terrain that is shown.
fn terrain() -> Result<Relief> {
    let map = HeightMap::from_bytes(DEM, &HeightSettings::default())?;
    let [first, south, columns, rows] = PART;
    let rows_of = |row: u32| &map.heights_m()[((south + row) * map.columns() + first) as usize..][..columns as usize];
    let part = HeightMap::new(columns, rows, (0..rows).flat_map(rows_of).copied().collect())?;
    Ok(Relief::of(&part.resampled(FINER * columns, FINER * rows)?))
}

/// Draws the sheet to `heights.png` in a folder.
///
/// # Errors
/// Files.
pub fn draw(dir: &Path) -> Result<()> {
    let truth = terrain()?;
    let panels = panels(&truth);
    let [width, height] = truth.size;
    let rows = (panels.len() as u32).div_ceil(PANELS_IN_A_ROW);
    let size = [PANELS_IN_A_ROW * (width + GAP) + GAP, rows * (height + CAPTION) + GAP];
    let mut sheet = Sheet { size, rgb: vec![255; 3 * (size[0] * size[1]) as usize] };
    let corner = |i: u32| [GAP + i % PANELS_IN_A_ROW * (width + GAP), GAP + i / PANELS_IN_A_ROW * (height + CAPTION)];
    for (i, (_, relief)) in (0..).zip(&panels) {
        let [left, top] = corner(i);
        for (x, y) in (0..width).flat_map(|x| (0..height).map(move |y| (x, y))) {
            let color = if truth.has_contour(x, y) { [200, 30, 40] } else { relief.color(x, y) };
            sheet.put(left + x, top + height - 1 - y, color);
        }
    }
    register_font();
    let fault = |e: &dyn std::fmt::Display| Error::new(Status::Io, format!("{}: {e}", dir.display()));
    {
        let area = BitMapBackend::with_buffer(&mut sheet.rgb, (size[0], size[1])).into_drawing_area();
        for (i, (caption, _)) in (0..).zip(&panels) {
            let [left, top] = corner(i);
            let place = ((left + width / 2) as i32, (top + height + CAPTION / 2 - GAP / 2) as i32);
            let style = ("sans-serif", 17.0).into_font().color(&RGBColor(40, 44, 52));
            let style = style.pos(Pos::new(HPos::Center, VPos::Center));
            area.draw(&Text::new(*caption, place, style)).map_err(|e| fault(&e))?;
        }
        area.present().map_err(|e| fault(&e))?;
    }
    std::fs::create_dir_all(dir).map_err(|e| fault(&e))?;
    let path = dir.join("heights.png");
    welkin_command_line::write_png(&path, &sheet.rgb, size)?;
    println!("{}", path.display());
    Ok(())
}
