//! Tests of the drops that the pass finds in a lattice, against the same selection in f64.

use std::sync::Arc;

use glam::{DMat4, DVec3, DVec4};

use super::*;
use crate::{
    gpu::{
        DeviceOptions,
        blocks::{Blocks, UniformBlock},
    },
    particles::{MovingAir, StreakCamera, listing},
    rain::{
        DropLight,
        classes::Classes,
        lattice::{self, Drop, SPEED_UNIT},
    },
    scene::{Camera, DepthMapping, ViewRays},
    surroundings,
    weather::{Precipitation, PrecipitationKind, Weather, derive},
};

const SEED: u64 = 3;
/// Position of the camera, (east, north, up), m.
const EYE: DVec3 = DVec3::new(20.0, -7.0, 30.0);
/// Velocity of the air, (east, north, up), m/s.
const WIND: DVec3 = DVec3::new(9.0, 4.0, 0.0);
/// Time for which the drops have fallen, s.
const TIME_S: f64 = 77.0;
/// Exposure time of the camera, s.
const EXPOSURE_S: f64 = 1.0 / 60.0;

/// Pass that finds drops, with the buffers that it reads.
struct Bench {
    device: Arc<Device>,
    blocks: Blocks,
    block: UniformBlock,
    pass: CullPass,
    surroundings: surroundings::SurroundingsBlock,
    classes: Classes,
    /// Matrix from positions relative to the camera, (east, north, up), to clip space, as in the last search.
    clip: DMat4,
    /// Velocity of the camera, m/s.
    velocity_m_s: DVec3,
}

impl Bench {
    /// Creates a bench for rain of this rate, on a headless device.
    fn new(rate_mm_h: f64) -> Self {
        let device = Device::headless(&DeviceOptions::default()).expect("a software driver is installed");
        let precipitation = Precipitation::of(PrecipitationKind::Rain, rate_mm_h);
        let falling = derive(&Weather { precipitation, ..Weather::default() }).unwrap().precipitation;
        let blocks = Blocks::new();
        let block = blocks.block(&device, size_of::<RainUniform>());
        let local = bind::block(&device.device, "no areas", LOCAL.end);
        let pass = CullPass::new(&device.device, (&block, &local), false);
        let surroundings = surroundings::SurroundingsBlock::new(&device.device);
        let classes = Classes::new(&falling, 1.0, u32::MAX);
        Self { device, blocks, block, pass, surroundings, classes, clip: DMat4::IDENTITY, velocity_m_s: DVec3::ZERO }
    }

    /// Finds the drops that a camera at [`EYE`] sees. Returns the arguments of the draw (vertices, drops, ...), and the
    /// middles and widths of the streaks.
    fn find(&mut self, fov_rad: f64) -> ([u32; 4], Vec<([f32; 3], f32)>) {
        let camera = Camera::look_to(EYE, DVec3::Y, DVec3::Z, fov_rad, 1.5, 0.1);
        let rays = ViewRays::new(&camera, &DepthMapping { reversed: true, ..DepthMapping::default() }).unwrap();
        self.clip = camera.projection * DMat4::from_mat3(camera.rotation());
        let shot = StreakCamera {
            clip: self.clip,
            rays: &rays,
            height: 360,
            y_sign: 1.0,
            position_m: EYE,
            velocity_m_s: self.velocity_m_s,
            exposure_s: EXPOSURE_S,
            gain: 1.0,
        };
        let air =
            MovingAir { displacement_m: WIND * TIME_S, velocity_m_s: WIND, time_s: TIME_S, extinction_per_m: 0.0 };
        let dark = DropLight { above: DVec3::ZERO, below: DVec3::ZERO, sun: DVec3::ZERO, to_sun: DVec3::Z };
        let block = RainUniform::new(SEED, &self.classes, &dark, &shot, &air);
        self.block.write(bytemuck::bytes_of(&block));
        self.blocks.upload(&self.device);
        let mut encoder = self.device.device.create_command_encoder(&Default::default());
        let layout = surroundings::layout(&self.device.device);
        let lattice =
            DropLattice { shells: 4, per_shell: self.classes.per_shell, states: None, areas: false, maps: false };
        let mut pass = encoder.begin_compute_pass(&Default::default());
        self.pass.find(&self.device, &mut pass, (&layout, self.surroundings.bind_group()), lattice).unwrap();
        drop(pass);
        self.device.submit_and_wait(encoder).unwrap();
        let [found, streaks] = self.pass.listing.buffers();
        let (found, streaks): (Vec<u32>, Vec<[f32; 12]>) = (self.read(found), self.read(streaks));
        assert_eq!(&found[4..7], &[found[1].div_ceil(64), 1, 1]);
        let shown = streaks[..found[1] as usize].iter().map(|s| ([s[0], s[1], s[2]], s[3])).collect();
        ([found[0], found[1], found[2], found[3]], shown)
    }

    /// Copies a buffer from the GPU.
    fn read<T: bytemuck::Pod>(&self, buffer: &wgpu::Buffer) -> Vec<T> {
        let copy = self.device.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: buffer.size(),
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let mut encoder = self.device.device.create_command_encoder(&Default::default());
        encoder.copy_buffer_to_buffer(buffer, 0, &copy, 0, buffer.size());
        self.device.submit(encoder);
        copy.slice(..).map_async(wgpu::MapMode::Read, |r| r.unwrap());
        self.device.wait().unwrap();
        bytemuck::pod_collect_to_vec(&copy.slice(..).get_mapped_range().unwrap())
    }

    /// Returns whether a drop is in the picture by the selection in f64, or `None` where rounding decides.
    fn surely(&self, drop: &Drop) -> Option<bool> {
        let speed = f64::from(self.classes.table[drop.id.1 as usize][1]) * SPEED_UNIT;
        let whole = (WIND - DVec3::Z * speed - self.velocity_m_s) * (0.5 * EXPOSURE_S);
        let half = whole * (0.8 * drop.position_m.length() / whole.length()).min(1.0);
        let at = |slack: f64| {
            let ends = [drop.position_m - half, drop.position_m + half].map(|p| self.clip * p.extend(1.0));
            let inside = |v: fn(&DVec4) -> f64| ends.iter().any(|e| v(e) < 0.05 + slack + 1.02 * e.w);
            let picture = inside(|e| e.x) && inside(|e| -e.x) && inside(|e| e.y) && inside(|e| -e.y);
            picture && lattice::shell_share(drop.id.0 as usize, drop.position_m.length() * (1.0 + slack)) > 0.0
        };
        let all = [-1e-4, 0.0, 1e-4].map(at);
        (all[0] == all[1] && all[1] == all[2]).then_some(all[1])
    }
}

#[test]
fn the_list_has_the_visible_drops_in_the_order_of_the_lattice() {
    // Rates that need lists of different sizes.
    for rate_mm_h in [0.5, 60.0, 8.0] {
        let mut bench = Bench::new(rate_mm_h);
        let (draw, shown) = bench.find(0.9);
        assert_eq!((draw[0], draw[2], draw[3]), (4, 0, 0));
        let drops = lattice::drops(&bench.classes, SEED, EYE, WIND * TIME_S, TIME_S);
        let all = 4 * bench.classes.per_shell as usize;
        let mut found = shown.iter().peekable();
        let (mut sure, mut doubtful) = (0, 0);
        for drop in drops {
            let near = |p: &[f32; 3]| (DVec3::from(p.map(f64::from)) - drop.position_m).length() < 1e-5;
            let here = found.next_if(|(p, _)| near(p)).is_some();
            match bench.surely(&drop) {
                Some(expected) => assert_eq!(here, expected, "{rate_mm_h} mm/h: {drop:?}"),
                None => doubtful += 1,
            }
            sure += usize::from(here);
        }
        assert!(found.next().is_none() && sure == shown.len(), "{rate_mm_h} mm/h: others or another order");
        assert!(shown.iter().all(|(_, width)| *width > 0.0));
        println!("{rate_mm_h} mm/h: {sure} of {all} drops, {doubtful} on an edge");
        assert!((0.01..0.1).contains(&(sure as f64 / all as f64)) && doubtful * 1000 <= all);
    }
}

#[test]
fn a_full_list_leaves_out_the_outermost_drops() {
    let mut bench = Bench::new(60.0);
    let (_, all) = bench.find(0.9);
    bench.pass.listing.forget();
    bench.pass.listing.room = Some(1000);
    let (draw, some) = bench.find(0.9);
    assert_eq!((draw[1], &some[..]), (1000, &all[..1000]));
}

#[test]
fn neither_wide_pictures_nor_fast_cameras_fill_the_list() {
    let mut bench = Bench::new(60.0);
    let drops = u64::from(bench.classes.per_shell) * SHELLS as u64;
    let room = listing::room(&bench.device.device, drops / u64::from(listing::BLOCK_THINGS), STREAK_BYTES);
    bench.pass.listing.room = Some(drops);
    for (across_deg, velocity_m_s) in [
        (150.0f64, DVec3::ZERO),
        (90.0, DVec3::Y * 300.0),
        (90.0, DVec3::X * 300.0),
        (60.0, DVec3::new(-100.0, 200.0, 200.0)),
    ] {
        bench.velocity_m_s = velocity_m_s;
        let (_, shown) = bench.find(2.0 * ((0.5 * across_deg).to_radians().tan() / 1.5).atan());
        println!("{across_deg} degrees at {velocity_m_s} m/s: {} of {drops}, room for {room}", shown.len());
        assert!((shown.len() as u64) < room);
    }
}
