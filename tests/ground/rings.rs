//! Rings of drops on standing water: their number follows from the flux of drops, each is drawn at its place, and no
//! others are drawn.

use glam::{DVec2, DVec3};
use welkin::{
    frame::Stages,
    ground::{
        GroundGrid,
        reference::{RING_DIAMETER_MM, ring_drops_per_m2_s},
    },
    rain::{drops::factor_in, lattice::random3, sizes::DropSizes},
    weather::{Precipitation, PrecipitationKind, Surface, SurfaceState, Weather, Wind},
};

use crate::host::{Host, SIZE, ground, look, ray};

/// Constants of `shaders/ground/hollows.wgsl`: side of a cell, m; length of a time slot and life of a ring, s; number
/// of layers; speed of a ring, m/s.
const CELL_M: f64 = 0.2;
const SLOT_S: f64 = 0.6;
const LIFE_S: f64 = 0.36;
const LAYERS: u32 = 4;
const SPEED_M_S: f64 = 0.22;

/// A visible ring: its centre in the world, and its age.
struct Ring {
    at: DVec2,
    age_s: f64,
}

/// Three numbers of \[0, 1) (PCG, Jarzynski & Olano 2020).
fn chances([x, y]: [u32; 2], slot: u32) -> [f64; 3] {
    random3([x, y, slot]).map(|v| f64::from(v >> 8) / 16_777_216.0)
}

/// Returns the visible rings at a time in cells between two corners of the world. Each slot of a cell has a ring with
/// this probability.
fn standing(time_s: f64, chance: f64, low: DVec2, high: DVec2) -> Vec<Ring> {
    let slots = time_s / SLOT_S;
    let mut rings = Vec::new();
    for layer in 0..LAYERS {
        let t = slots.fract() + f64::from(layer) / f64::from(LAYERS);
        let slot = (slots.floor() as u32 + t as u32) * LAYERS + layer;
        let [sx, sy, _] = chances([0x9e37, 0x79b9], slot);
        let shift = DVec2::new(sx, sy);
        let (from, to) = ((low / CELL_M + shift).floor(), (high / CELL_M + shift).floor());
        for (x, y) in (from.y as i64..=to.y as i64).flat_map(|y| (from.x as i64..=to.x as i64).map(move |x| (x, y))) {
            let cell = [x, y].map(|v| v.rem_euclid(50_000) as u32);
            let (of, other) = (chances(cell, slot), chances([cell[1], cell[0]], slot + 0x85eb));
            let age_s = (t.fract() - (1.0 - LIFE_S / SLOT_S) * other[1]) * SLOT_S;
            if other[0] < chance && age_s > 0.0 && age_s < LIFE_S {
                let room = 0.5 * CELL_M - SPEED_M_S * LIFE_S;
                let middle = (DVec2::new(x as f64, y as f64) + 0.5 - shift) * CELL_M;
                rings.push(Ring { at: middle + (DVec2::new(of[0], of[1]) * 2.0 - 1.0) * room, age_s });
            }
        }
    }
    rings
}

/// Returns a host with rain and with standing water within 6 m of the origin.
fn pond(rate_mm_h: f64, showers: bool) -> (Host, f64) {
    let mut host = Host::new();
    let away = |i: u32| i.abs_diff(20) as f32;
    let height = |i: u32| (0.05 * (away(i % 40).max(away(i / 40)) - 6.0)).max(0.0);
    let heights_m = (0..1600).map(height).collect();
    let grid = GroundGrid {
        origin: DVec3::new(-20.0, -20.0, 0.0),
        cell_m: 1.0,
        nodes: [40; 2],
        heights_m,
        classes: Vec::new(),
    };
    let weather = Weather {
        precipitation: Precipitation { showers, ..Precipitation::of(PrecipitationKind::Rain, rate_mm_h) },
        surface: Surface { state: Some(SurfaceState::StandingWater), ..Surface::default() },
        wind: Wind::of(0.0, 0.0),
        ..Weather::default()
    };
    host.context.set_weather(&weather, 0.0, 0.0).unwrap();
    host.context.set_ground_grid(Some(grid)).unwrap();
    assert!(host.context.ground_at(DVec3::ZERO).unwrap().water_mm > 3.0, "it is a pond");
    let c = host.context.conditions_at(DVec3::ZERO, 0.0).unwrap();
    let sizes = DropSizes::new(&c.precipitation, factor_in(&c.air, 0.0));
    let slowest = sizes.speed_m_s(RING_DIAMETER_MM);
    // The flux of drops that make rings, summed over small steps of drop size.
    let step = 1e-3;
    let flux = (0..4200)
        .map(|i| RING_DIAMETER_MM + (f64::from(i) + 0.5) * step)
        .map(|d| sizes.number_between(d - 0.5 * step, d + 0.5 * step) * sizes.speed_m_s(d));
    let flux: f64 = flux.sum();
    assert!((ring_drops_per_m2_s(&sizes) / flux - 1.0).abs() < 2e-3 && slowest > 5.0, "{flux}");
    (host, flux)
}

#[test]
fn rings_are_as_many_as_the_flux_brings_and_drawn_where_the_twin_has_them() {
    for (rate, showers) in [(1.5, false), (6.0, false), (1.5, true)] {
        let (mut host, flux) = pond(rate, showers);
        let chance = flux * CELL_M * CELL_M * SLOT_S / f64::from(LAYERS);
        // Number of rings on 32 x 32 m at times far apart, against flux x area x life.
        let corner = DVec2::splat(16.0);
        let inside = |r: &&Ring| r.at.abs().max_element() < 16.0;
        let moments = 12;
        let stand = |k: i32| standing(0.3 + 1.7 * f64::from(k), chance, -corner, corner).iter().filter(inside).count();
        let counted: usize = (0..moments).map(stand).sum();
        let want = flux * LIFE_S * 1024.0 * f64::from(moments);
        assert!((counted as f64 - want).abs() < 4.0 * want.sqrt(), "{rate} mm/h: {counted} stand, flux x area {want}");
        // The camera looks straight down on 0.9 x 0.5 m of still water. The reflection without rings is the median over
        // all times.
        let eye = DVec3::new(1.0, -2.0, 1.0);
        let camera = look(eye, 0.0, -90.0, 0.5);
        let half = DVec2::new(0.255 * 16.0 / 9.0, 0.255);
        let places: Vec<DVec2> = (0..SIZE.0 * SIZE.1)
            .map(|i| ray(&camera, i % SIZE.0, i / SIZE.0))
            .map(|d| eye.truncate() + d.truncate() / -d.z * eye.z)
            .collect();
        let times: Vec<f64> = (0..80).map(|k| 0.3 + 0.73 * f64::from(k)).collect();
        let shoot = |t: &f64| -> Vec<f64> {
            host.context.update(*t).unwrap();
            let pixels = host.shoot(camera, Stages::SURFACE, |d| ground(eye, d, [0.0; 3]));
            pixels.iter().map(|p| f64::from(p[1])).collect()
        };
        let pictures: Vec<Vec<f64>> = times.iter().map(shoot).collect();
        let median = |i: usize| {
            let mut all: Vec<f64> = pictures.iter().map(|p| p[i]).collect();
            all.sort_by(f64::total_cmp);
            all[all.len() / 2]
        };
        let calm: Vec<f64> = (0..places.len()).map(median).collect();
        let (mut found, mut looked_for, mut clear) = (0, 0, 0);
        for (t, picture) in times.iter().zip(&pictures) {
            let rings = standing(*t, chance, eye.truncate() - half - 0.3, eye.truncate() + half + 0.3);
            let off = |i: usize| (picture[i] / calm[i] - 1.0).abs();
            for ring in rings.iter().filter(|r| (0.03..0.15).contains(&r.age_s)) {
                let radius = SPEED_M_S * ring.age_s;
                let within = (ring.at - eye.truncate()).abs() + radius;
                if within.cmpgt(half - 0.01).any() {
                    continue;
                }
                let on = |p: &DVec2| ((*p - ring.at).length() - radius).abs() < 0.01;
                let most = places.iter().enumerate().filter(|(_, p)| on(p)).map(|(i, _)| off(i)).fold(0.0, f64::max);
                looked_for += 1;
                found += u32::from(most > 0.01);
            }
            let far = |p: &DVec2| {
                let beside = |r: &Ring| ((*p - r.at).length() - SPEED_M_S * r.age_s).abs();
                rings.iter().all(|r| beside(r) > 0.05)
            };
            for (i, _) in places.iter().enumerate().filter(|(_, p)| far(p)) {
                assert!(off(i) < 0.01, "{rate} mm/h at {t}: {} without a ring at {}", off(i), places[i]);
                clear += 1;
            }
        }
        println!("{rate} mm/h: {counted} rings stand, flux x area says {want:.0}; {found} of {looked_for} are seen");
        assert!(looked_for > 10 && clear > 1000, "{looked_for} {clear}");
        assert!(f64::from(found) > 0.97 * f64::from(looked_for), "{rate} mm/h: {found} of {looked_for}");
    }
}
