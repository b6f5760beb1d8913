//! Changes that a host may make between two steps, each a call or two on a context; each takes a number, so that one
//! change differs from the next.

use std::collections::BTreeMap;

use glam::{DMat3, DVec3};
use welkin::{
    context::{Context, GivenDirection},
    flow::{WindFieldDesc, WindFieldMode},
    fog::Law,
    ground::{GroundGrid, SurfaceClass},
    light::Exposure,
    lightning::{FlashKind, FlashTrigger, LightningSettings},
    rain::{AreaMotion, AreaShape, Planes, RainArea, Shelter},
    scene::HostLight,
    snowpack::SnowStrip,
    soil::{SoilKindId, SoilSettings, SoilToolPose, SoilToolShape},
    stars::StarSettings,
    terrain::{Rows, TerrainCells, TerrainDesc, TileKey},
    weather::{CloudMap, Precipitation, PrecipitationKind, Surface, Weather, Wind},
    wind::{WindGrid, WindGridKind},
};

/// Cells along the side of a tile, and their size, m.
const SIDE: u32 = 32;
const CELL_M: f64 = 1.0;

/// Heights and classes of a tile's cells.
type Cells = (Vec<f32>, Vec<Option<SurfaceClass>>);

/// Tiles that the host has set; no saved state holds them, so another context needs them before it can load one.
#[derive(Clone, Default)]
pub struct Tiles {
    desc: Option<TerrainDesc>,
    tiles: BTreeMap<[i32; 2], Cells>,
}

impl Tiles {
    /// Sets them on a context that has none.
    pub fn set_on(&self, context: &mut Context) {
        context.set_terrain(self.desc).unwrap();
        for (key, (heights, classes)) in &self.tiles {
            let key = TileKey { east: key[0], north: key[1] };
            let (heights_m, classes) = (Rows::of(heights), Rows::of(classes));
            context.set_terrain_tile(&TerrainCells { key, heights_m, classes, ..TerrainCells::default() }).unwrap();
        }
    }

    fn set_terrain(&mut self, context: &mut Context, desc: Option<TerrainDesc>) {
        context.set_terrain(desc).unwrap();
        if self.desc != desc {
            *self = Self { desc, tiles: BTreeMap::new() };
        }
    }

    /// Sets the lattice about a place.
    pub fn set_terrain_at(&mut self, context: &mut Context, origin: DVec3) {
        self.set_terrain(context, Some(TerrainDesc { origin, ..terrain(0) }));
    }

    /// Sets a tile with waves; `n` modulo 8 shifts them, and `n` modulo 3 chooses the classes.
    pub fn set_tile(&mut self, context: &mut Context, [east, north]: [i32; 2], n: u32) {
        let first = [east, north].map(|k| f64::from(k) * f64::from(SIDE));
        let height = |i: u32| {
            let (x, y) = (first[0] + f64::from(i % SIDE), first[1] + f64::from(i / SIDE));
            (0.1 * (0.4 * x + f64::from(n % 8)).sin() * (0.3 * y).cos()) as f32
        };
        let heights: Vec<f32> = (0..SIDE * SIDE).map(height).collect();
        let class = |i: u32| match (n % 3, i % 37) {
            (1, 0) => None,
            (2, _) => Some(SurfaceClass::Rock),
            _ => Some(SurfaceClass::Unspecified),
        };
        let classes: Vec<_> = (0..SIDE * SIDE).map(class).collect();
        let key = TileKey { east, north };
        let (heights_m, said) = (Rows::of(&heights), Rows::of(&classes));
        context.set_terrain_tile(&TerrainCells { key, heights_m, classes: said, ..TerrainCells::default() }).unwrap();
        self.tiles.insert([east, north], (heights, classes));
    }

    /// Digs a rectangle out of the first tile.
    pub fn dig(&mut self, context: &mut Context, n: u32) {
        let Some((key, (heights, _))) = self.tiles.iter_mut().next() else { return };
        let (first, size) = ([n % 10, (n / 3) % 10], [5, 4]);
        let mut dug = Vec::new();
        for row in 0..size[1] {
            for column in 0..size[0] {
                let at = ((first[1] + row) * SIDE + first[0] + column) as usize;
                heights[at] -= 0.05;
                dug.push(heights[at]);
            }
        }
        let key = TileKey { east: key[0], north: key[1] };
        let cells = TerrainCells { key, first, size, heights_m: Rows::of(&dug), ..TerrainCells::default() };
        context.update_terrain(&cells).unwrap();
    }

    pub fn remove_one(&mut self, context: &mut Context) {
        let Some(key) = self.tiles.keys().next_back().copied() else { return };
        context.remove_terrain_tile(TileKey { east: key[0], north: key[1] }).unwrap();
        self.tiles.remove(&key);
    }
}

/// A change by the host.
pub type Input = (&'static str, fn(&mut Context, &mut Tiles, u32));

pub fn grid(n: u32) -> GroundGrid {
    let nodes = if n.is_multiple_of(2) { [10, 7] } else { [8, 4] };
    let height = |i: u32| {
        let (x, y) = (f64::from(i % nodes[0]), f64::from(i / nodes[0]));
        (0.2 * (0.9 * x + f64::from(n)).sin() * (0.7 * y).cos()) as f32
    };
    GroundGrid {
        origin: DVec3::new(-9.0, -6.0, 0.0),
        cell_m: 2.0,
        nodes,
        heights_m: (0..nodes[0] * nodes[1]).map(height).collect(),
        classes: Vec::new(),
    }
}

fn terrain(n: u32) -> TerrainDesc {
    TerrainDesc { origin: DVec3::new(f64::from(n % 2), 0.0, 0.0), cell_m: CELL_M, tile_cells: SIDE }
}

pub fn roof(n: u32) -> Shelter {
    Shelter {
        center_m: DVec3::new(f64::from(n % 5), 1.0, f64::from(n % 3)),
        axes: DMat3::from_rotation_z(0.2 * f64::from(n % 4)),
        half_size_m: DVec3::new(3.0, 2.0, 1.0),
        velocity_m_s: DVec3::ZERO,
        planes: Planes::default(),
    }
}

fn van(n: u32) -> Shelter {
    Shelter { velocity_m_s: DVec3::new(3.0, 0.5, 0.0), center_m: DVec3::new(-6.0, 2.0, 1.0), ..roof(n) }
}

fn strip() -> SnowStrip {
    SnowStrip { points: vec![DVec3::new(-8.0, 1.0, 0.0), DVec3::new(8.0, 3.0, 0.0)], width_m: 3.0 }
}

fn field(n: u32) -> WindFieldDesc {
    let running = n % 4 == 3;
    WindFieldDesc {
        floor_center: DVec3::new(2.0 * f64::from(n % 3), 0.0, -1.0),
        cell_m: DVec3::splat(2.0),
        cells: [12, 8, 8],
        mode: if running { WindFieldMode::Running } else { WindFieldMode::Steady },
        ..WindFieldDesc::default()
    }
}

fn area(n: u32) -> RainArea {
    RainArea {
        center_m: [f64::from(n % 7), 4.0, 0.0],
        shape: AreaShape::Ellipse([20.0, 14.0]),
        rim_m: 5.0,
        rate_mm_h: 4.0 + f64::from(n % 9),
        motion: if n.is_multiple_of(2) { AreaMotion::Own([0.05, -0.02]) } else { AreaMotion::WithWind },
        ..RainArea::default()
    }
}

pub fn snowfall(n: u32) -> Weather {
    let speed_m_s = 9.0 + 0.05 * f64::from(n % 40);
    Weather {
        temperature_c: -4.0 + 0.1 * f64::from(n % 3),
        precipitation: Precipitation::of(PrecipitationKind::Snow, 2.0),
        wind: Wind { gust_m_s: Some(speed_m_s + 3.0), ..Wind::of(speed_m_s, 240.0) },
        ..Weather::default()
    }
}

pub fn rainfall(n: u32) -> Weather {
    Weather {
        temperature_c: 4.0,
        precipitation: Precipitation::of(PrecipitationKind::Rain, 6.0 + f64::from(n % 5)),
        surface: Surface { snow_depth_m: 0.1, ..Surface::default() },
        wind: Wind::of(6.0, 190.0),
        ..Weather::default()
    }
}

/// Every setter of a context whose effect is in a saved state, and every act on what it simulates.
pub const INPUTS: &[Input] = &[
    ("grid", |c, t, n| {
        c.set_ground_grid(Some(grid(n))).unwrap();
        *t = Tiles::default();
    }),
    ("the other grid", |c, t, n| {
        c.set_ground_grid(Some(grid(n + 1))).unwrap();
        *t = Tiles::default();
    }),
    ("classes of the grid", |c, _, n| {
        let Some(grid) = c.ground_grid() else { return };
        let class = if n.is_multiple_of(2) { SurfaceClass::Rock } else { SurfaceClass::Soil };
        c.set_ground_grid(Some(GroundGrid { classes: vec![class; grid.heights_m.len()], ..grid.clone() })).unwrap();
    }),
    ("no grid", |c, _, _| c.set_ground_grid(None).unwrap()),
    ("terrain", |c, t, n| t.set_terrain(c, Some(terrain(n)))),
    ("terrain with tiles", |c, t, n| {
        t.set_terrain(c, Some(terrain(n)));
        t.set_tile(c, [0, 0], n);
        t.set_tile(c, [-1, 0], n + 1);
    }),
    ("no terrain", |c, t, _| t.set_terrain(c, None)),
    ("a tile", |c, t, n| {
        if t.desc.is_some() {
            t.set_tile(c, [-((n % 2) as i32), -((n / 2 % 2) as i32)], n);
        }
    }),
    ("digging", |c, t, n| t.dig(c, n)),
    ("a tile removed", |c, t, _| t.remove_one(c)),
    ("surface class", |c, _, n| {
        let class = if n.is_multiple_of(2) { SurfaceClass::Rock } else { SurfaceClass::Unspecified };
        c.set_default_surface_class(class);
    }),
    ("shelters", |c, _, n| c.set_shelters(&[roof(n), roof(n + 3)]).unwrap()),
    ("shelters that move", |c, _, n| c.set_shelters(&[roof(n), van(n)]).unwrap()),
    ("no shelters", |c, _, _| c.set_shelters(&[]).unwrap()),
    ("ploughing", |c, _, _| {
        // Refused without a terrain.
        let _ = c.take_snow(&strip(), 0.01);
    }),
    ("pressing", |c, _, _| {
        let _ = c.press_snow(&strip());
    }),
    ("soil", |c, _, n| {
        // Refused without tiles, as all of soil is without soil, and while steps remain.
        let saturation = 0.1 + 0.2 * f64::from(n % 2);
        let _ = c.set_soil(Some(SoilSettings { saturation, ..SoilSettings::default() }));
    }),
    ("a bucket", |c, _, n| {
        let shape = SoilToolShape::Bucket { struck_m3: 0.4, heap_rise: 1.0 };
        let pose = |i: u32| {
            let (x, z) = (3.0 + 0.5 * f64::from(i) + 0.1 * f64::from(n % 7), 0.2 - 0.2 * f64::from(i));
            let side = |x: f64, z: f64| [4.0, 2.0].map(|y| DVec3::new(x, y, z));
            let (edge, upper) = (side(x, z), side(x - 0.2, z + 1.0));
            let time_s = c.time_s() + 0.1 + 3.0 * f64::from(i);
            SoilToolPose { time_s, edge, upper, facing: DVec3::new(1.0, 0.0, 0.2), load_n: 0.0 }
        };
        let poses: Vec<_> = (0..4).map(pose).collect();
        let Ok(tool) = c.add_soil_tool(shape, &poses[0]) else { return };
        poses[1..].iter().for_each(|pose| _ = c.move_soil_tool(tool, pose));
        c.end_soil_tool(tool).unwrap();
    }),
    ("sand by the truck", |c, _, n| {
        let _ = c.bring_soil(DVec3::new(f64::from(n % 5), 6.0, 0.0), SoilKindId::SAND, 900.0);
    }),
    ("no soil", |c, _, _| {
        let _ = c.set_soil(None);
    }),
    ("a wind field", |c, _, n| {
        // Refused where the host has already set a later change.
        let _ = c.set_wind_field(Some(&field(n)), c.time_s());
    }),
    ("a wind field to come", |c, _, n| {
        let _ = c.set_wind_field(Some(&field(n)), c.time_s() + 3.7);
    }),
    ("no wind field", |c, _, _| {
        let _ = c.set_wind_field(None, c.time_s());
    }),
    ("a wind grid", |c, _, n| {
        let at = |i: u32| [4.0 + (i % 3) as f32, (n % 4) as f32, 0.1];
        let grid = WindGrid {
            origin: DVec3::new(-12.0, -12.0, -1.0),
            cell_m: DVec3::splat(8.0),
            nodes: [4, 4, 3],
            kind: if n.is_multiple_of(2) { WindGridKind::Whole } else { WindGridKind::Added },
            velocities_m_s: (0..48).map(at).collect(),
        };
        c.set_wind_grid(Some(grid)).unwrap();
    }),
    ("no wind grid", |c, _, _| c.set_wind_grid(None).unwrap()),
    ("snowfall", |c, _, n| {
        let _ = c.set_weather(&snowfall(n), c.time_s(), 40.0);
    }),
    ("snowfall to come", |c, _, n| {
        let _ = c.set_weather(&snowfall(n), c.time_s() + 33.0, 20.0);
    }),
    ("rainfall", |c, _, n| {
        let _ = c.set_weather(&rainfall(n), c.time_s(), 25.0);
    }),
    ("rain areas", |c, _, n| c.set_rain_areas(&[area(n), area(n + 5)]).unwrap()),
    ("no rain areas", |c, _, _| c.set_rain_areas(&[]).unwrap()),
    ("sun", |c, _, n| {
        let given = GivenDirection { azimuth_deg: 20.0 * f64::from(n % 9), elevation_deg: 30.0 };
        c.set_sun((n % 5 > 0).then_some(given)).unwrap();
    }),
    ("moon", |c, _, n| {
        c.set_moon(Some(GivenDirection { azimuth_deg: 10.0 * f64::from(n % 9), elevation_deg: 50.0 })).unwrap();
    }),
    ("clock", |c, _, n| {
        let utc = welkin::almanac::Utc::from_calendar(2026, 3, 1 + n % 28, n % 24, 30, 0.0).unwrap();
        c.set_clock(utc, c.time_s()).unwrap();
    }),
    ("a cloud map", |c, _, n| {
        let cover = (0..9).map(|i| ((i + n) % 4) as f32 * 0.25).collect();
        let map = CloudMap { first_m: [0.0; 2], cell_m: 500.0, cells: [3, 3], base_m: [0.0, 9000.0], cover };
        c.set_cloud_map((n % 4 > 0).then_some(map)).unwrap();
    }),
    ("a fog law", |c, _, n| c.set_fog_law((n % 2 == 0).then_some(Law::Clear)).unwrap()),
    ("lightning", |c, _, n| {
        let settings = LightningSettings { flashes_per_minute: Some(f64::from(n % 6)), ..LightningSettings::default() };
        c.set_lightning(settings).unwrap();
    }),
    ("a flash", |c, _, n| {
        let flash = FlashTrigger {
            time_s: c.time_s() + f64::from(n % 5),
            position: DVec3::new(100.0, 50.0, 0.0),
            kind: FlashKind::ToGround,
            peak_ka: None,
            strokes: None,
        };
        c.trigger_flash(&flash).unwrap();
    }),
    ("stars", |c, _, n| {
        c.set_stars(StarSettings { airglow: 0.5 * f64::from(n % 4), ..StarSettings::default() }).unwrap();
    }),
    ("lamps", |c, _, n| {
        let lamp = HostLight {
            position_m: DVec3::new(0.0, f64::from(n % 4), 3.0),
            direction: DVec3::X,
            intensity_cd: [100.0; 3],
            inner_deg: 10.0,
            outer_deg: 30.0,
        };
        c.set_lights(&[lamp]).unwrap();
    }),
    ("exposure", |c, _, n| c.set_exposure(Exposure::Ev100(f64::from(n % 12))).unwrap()),
];
