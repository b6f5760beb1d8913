//! Maps of clouds: march steps, thin and deep layers, a camera that climbs through a cloud base, and cover.

use std::sync::Arc;

use glam::DVec3;
use welkin::Result;
use welkin::chance::normal_quantile;
use welkin::clouds::{
    CloudSettings,
    cover::{field, is_ice, seen, threshold, typical},
    field::{Field, Map as CloudMap, Solid},
};
use welkin::gpu::Device;
use welkin::weather::{CloudKind, CloudLayer};

use super::{Axis, Cell, Map, Panel};
use crate::chart::Lab;
use crate::cloudscapes::{FOV, Host};
use crate::command::Options;
use crate::picture::Picture;

/// Size of the pictures, and of those with a narrow field of view.
const SIZE: (u32, u32) = (160, 90);
const NARROW: (u32, u32) = (256, 8);
/// Vertical field of view of the narrow pictures, rad; and the distance between their viewpoints, m.
const NARROW_FOV: f64 = 0.03;
const PLACES_M: [f64; 4] = [0.0, 3100.0, 7300.0, 12_700.0];
/// The finest march a view can be set to, in every pixel.
const FINEST: CloudSettings = CloudSettings { fineness: 32.0, square_side: 1, shafts: false };
/// The default, with every pixel marched in one frame.
const DEFAULT: CloudSettings = CloudSettings { fineness: 2.0, square_side: 1, shafts: false };
/// Most steps through a layer at a fineness of 1.
const STEPS: f64 = 96.0;
/// Base of the layers, m.
const BASE_M: f64 = 1000.0;
const SUN_DEG: f64 = 40.0;

/// The 95th percentile of the difference between two pictures, or the fault of the first.
fn apart(drawn: &Picture, truth: &Picture) -> Result<Cell> {
    let is_sound = |p: &Picture| p.texels.iter().flatten().all(|v| v.is_finite() && *v >= 0.0);
    if !is_sound(drawn) {
        return Ok(Cell::NotFinite);
    }
    Ok(Cell::of(drawn.figures(truth)?.luminance.p95))
}

/// The mean difference over pixels.
fn mean_apart(drawn: &Picture, truth: &Picture) -> f64 {
    let white = truth.white();
    let pairs = drawn.luminances().into_iter().zip(truth.luminances());
    pairs.map(|(a, b)| (a - b).abs() / (b + 0.01 * white)).sum::<f64>() / truth.texels.len() as f64
}

/// Number of rays per elevation; they begin at the base of the layer.
const RAYS: usize = 512;
/// Maximum length of a ray, m.
const FARTHEST_M: f64 = 60e3;

/// Mean error over rays of the transmitted light with this many equal steps.
fn even_steps(field: &Field<'_>, elevation_deg: f64, steps: usize) -> f64 {
    let (sine, cosine) = elevation_deg.to_radians().sin_cos();
    let s = &field.shape;
    let length = (s.thickness_m / sine).min(FARTHEST_M);
    let through = |ray: usize, steps: usize| {
        // Start points whose distances are no multiple of the map's side.
        let from = DVec3::new(713.0, 421.0, 0.0) * ray as f64 + DVec3::Z * s.base_m;
        let at = |k: usize| from + DVec3::new(cosine, 0.0, sine) * (length * (k as f64 + 0.5) / steps as f64);
        let sum: f64 = (0..steps).map(|k| field.extinction_per_m(at(k))).sum();
        (-sum * length / steps as f64).exp()
    };
    (0..RAYS).map(|ray| (through(ray, steps) - through(ray, 4096)).abs()).sum::<f64>() / RAYS as f64
}

/// March steps against viewing height.
///
/// # Errors
/// GPU faults.
pub fn steps(lab: &Lab, _options: &Options) -> Result<Map> {
    let x = Axis::list("most steps through a layer", &[12.0, 24.0, 48.0, 96.0, 192.0, 384.0, 768.0]);
    let y = Axis::list("elevation, degrees", &[0.5, 1.0, 2.0, 4.0, 8.0, 15.0, 30.0, 60.0, 89.0]);
    let (slab, grown) = (typical(CloudKind::Cumulus, 0.4)?, (CloudMap::new(0), Solid::new(0)?));
    let even = field(&slab, &grown, threshold(&slab));
    let layer = CloudLayer::of(CloudKind::Cumulus, 0.4, BASE_M);
    let mut host = Host::under(&lab.device, Some(layer), SUN_DEG, NARROW)?;
    let mut cells = vec![0.0; x.values.len() * y.values.len()];
    for (row, elevation) in cells.chunks_mut(x.values.len()).zip(&y.values) {
        for east_m in PLACES_M {
            host.look_from(DVec3::new(east_m, 0.0, 2.0), *elevation, NARROW_FOV);
            let truth = host.whole(FINEST)?;
            for (cell, steps) in row.iter_mut().zip(&x.values) {
                let drawn = host.whole(CloudSettings { fineness: steps / STEPS, square_side: 1, shafts: false })?;
                *cell += mean_apart(&drawn, &truth) / PLACES_M.len() as f64;
            }
        }
    }
    let cells = cells.into_iter().map(Cell::of).collect();
    let panels = vec![
        Panel::of("usual: even steps, transmittance", false, &x, &y, |n, e| Cell::of(even_steps(&even, e, n as usize))),
        Panel { title: "Welkin, as drawn: luminance".into(), cells, ours: true },
    ];
    Ok(Map { title: "Marching through broken cumulus, mean error", x, y, panels, tolerance: 0.1 })
}

/// Thin and deep layers, viewed horizontally.
///
/// # Errors
/// GPU faults.
pub fn layers(lab: &Lab, _options: &Options) -> Result<Map> {
    let x = Axis::list("thickness, m", &[1.0, 3.0, 10.0, 30.0, 100.0, 300.0, 1000.0, 3000.0, 10_000.0, 20_000.0]);
    let y = Axis::list(
        "height of the eye, 0 at the base, 1 at the top",
        &[-0.5, -0.05, 0.0, 0.05, 0.3, 0.7, 0.95, 1.0, 1.05, 1.5],
    );
    let one = |kind: CloudKind, title: &str| -> Result<Panel> {
        let layer = |thickness_m| CloudLayer { thickness_m: Some(thickness_m), ..CloudLayer::of(kind, 0.5, BASE_M) };
        let mut host = Host::under(&lab.device, Some(layer(x.values[0])), SUN_DEG, SIZE)?;
        let mut cells = vec![Cell::Nothing; x.values.len() * y.values.len()];
        for (i, thickness_m) in x.values.iter().enumerate() {
            host.lay(layer(*thickness_m))?;
            for (j, at) in y.values.iter().enumerate() {
                let height_m = BASE_M + at * thickness_m;
                if height_m > 0.0 {
                    host.look(height_m, 0.0, FOV);
                    let truth = host.whole(FINEST)?;
                    cells[j * x.values.len() + i] = apart(&host.whole(DEFAULT)?, &truth)?;
                }
            }
        }
        Ok(Panel { title: title.into(), cells, ours: true })
    };
    let panels = vec![one(CloudKind::Cumulus, "Welkin: cumulus")?, one(CloudKind::Stratus, "Welkin: stratus")?];
    Ok(Map { title: "Layers seen level, error in luminance at 95 %", x, y, panels, tolerance: 0.3 })
}

/// Frames per second of a climb, and number of frames before the base at which it begins.
const HZ: f64 = 60.0;
const BEFORE: i32 = 24;

/// A camera that climbs through a base.
///
/// # Errors
/// GPU faults.
pub fn bases(lab: &Lab, _options: &Options) -> Result<Map> {
    let x = Axis::list("climb, m/s", &[3.0, 10.0, 30.0, 100.0, 300.0, 1000.0]);
    let y = Axis::list("frame", &[-16.0, -8.0, -4.0, -2.0, -1.0, 0.0, 1.0, 2.0, 4.0, 8.0, 16.0]);
    let one = |cover: f64, title: &str| -> Result<Panel> {
        let layer = CloudLayer::of(CloudKind::Stratocumulus, cover, BASE_M);
        let host = |device: &Arc<Device>| Host::under(device, Some(layer), SUN_DEG, SIZE);
        let (mut moving, mut by_itself) = (host(&lab.device)?, host(&lab.device)?);
        let mut cells = vec![Cell::Nothing; x.values.len() * y.values.len()];
        for (i, speed) in x.values.iter().enumerate() {
            // Half a frame's movement off the base, so that no frame lies in its plane.
            let height = |frame: i32| (BASE_M + (f64::from(frame) + 0.5) * speed / HZ).max(2.0);
            moving.look(height(-BEFORE), 0.0, FOV);
            moving.settle(CloudSettings::default())?;
            for frame in -BEFORE..=16 {
                moving.look(height(frame), 0.0, FOV);
                let drawn = moving.next_frame()?;
                if let Some(j) = y.values.iter().position(|at| *at == f64::from(frame)) {
                    by_itself.look(height(frame), 0.0, FOV);
                    cells[j * x.values.len() + i] = apart(&drawn, &by_itself.whole(DEFAULT)?)?;
                }
            }
        }
        Ok(Panel { title: title.into(), cells, ours: true })
    };
    let panels = vec![one(0.6, "Welkin: stratocumulus, 5 oktas")?, one(0.99, "Welkin: closed but for gaps")?];
    Ok(Map { title: "A climb through a base at 60 Hz, error in luminance at 95 %", x, y, panels, tolerance: 0.5 })
}

/// Seed of the sky whose cover is measured, and number of viewpoints.
const SEED: u64 = 7;
const PLACES: usize = 40;
/// Highest cover for which the normal distribution has a quantile.
const CLOSED: f64 = 1.0 - 1e-9;

/// Cover that is set against cover that is visible.
///
/// # Errors
/// GPU faults.
pub fn cover(_lab: &Lab, _options: &Options) -> Result<Map> {
    let x = Axis::steps("oktas asked for", 0.0, 8.0, 9);
    let kinds: Vec<CloudKind> = CloudKind::ALL.iter().copied().filter(|k| *k != CloudKind::Unknown).collect();
    let y = Axis::steps("kind, as they are listed", 1.0, kinds.len() as f64, kinds.len());
    let grown = (CloudMap::new(SEED), Solid::new(SEED)?);
    let off = |oktas: f64, kind: f64, by_area: bool| -> Result<Cell> {
        let asked = oktas / 8.0;
        let slab = typical(kinds[kind as usize - 1], asked)?;
        if slab.cover <= 0.0 {
            return Ok(Cell::Error(asked));
        }
        let threshold = if by_area { -normal_quantile(asked.min(CLOSED)) } else { threshold(&slab) };
        Ok(Cell::of(seen(&field(&slab, &grown, threshold), is_ice(&slab), PLACES) - asked))
    };
    let panel = |title: &str, ours, by_area| -> Result<Panel> {
        let mut cells = Vec::new();
        for kind in &y.values {
            for oktas in &x.values {
                cells.push(off(*oktas, *kind, by_area)?);
            }
        }
        Ok(Panel { title: title.into(), cells, ours })
    };
    let panels =
        vec![panel("usual: share of noise above a cutoff", false, true)?, panel("Welkin: by looking", true, false)?];
    Ok(Map { title: "Cover of the sky that is seen less what was asked for", x, y, panels, tolerance: 0.06 })
}
