//! Tests of stepped flakes, against the lattice and in a wind grid.

use std::sync::Arc;

use glam::{DMat3, DMat4};

use super::*;
use crate::{
    falling::lattice::{fraction, nearest},
    gpu::{
        DeviceOptions,
        blocks::{Blocks, UniformBlock},
    },
    moment::LightAround,
    scene::{Camera, DepthMapping, ViewRays},
    snow::{
        flakes::FlakeSizes,
        lattice::{self, SHELLS, SPEED_UNIT},
    },
    surroundings::WindTexture,
    weather::{Precipitation, PrecipitationKind, Weather, derive},
    wind::{WindGrid, WindGridKind, WindVolume},
};

const SEED: u64 = 11;

/// Pass that steps flakes, with the buffers that it reads.
struct Bench {
    device: Arc<Device>,
    blocks: Blocks,
    block: UniformBlock,
    pass: StepPass,
    wind: WindTexture,
    flakes: Flakes,
}

/// State of a flake, read back from the GPU.
struct Read {
    /// Position relative to the camera, without the helix, (east, north, up), m.
    position_m: DVec3,
    /// Velocity, (east, north, up), m/s.
    velocity_m_s: DVec3,
    /// Index of the shell, from the innermost.
    shell: usize,
    /// Number of times that the flake has re-entered its shell's cell.
    times: u32,
}

/// Creates the flakes of snow of this rate, as mm/h of water, at -3 C; at most `most` are drawn.
fn flakes(rate_mm_h: f64, most: u32) -> Flakes {
    let precipitation = Precipitation::of(PrecipitationKind::Snow, rate_mm_h);
    let weather = Weather { precipitation, temperature_c: -3.0, ..Weather::default() };
    let falling = derive(&weather).unwrap().precipitation;
    Flakes::new(&FlakeSizes::new(&falling, -3.0, 1.0), 1.0, most)
}

/// Creates a uniform wind within 60 m of the origin along each axis.
fn even(velocity: [f32; 3], kind: WindGridKind) -> WindVolume {
    let grid = WindGrid {
        origin: DVec3::splat(-60.0),
        cell_m: DVec3::splat(120.0),
        nodes: [2; 3],
        kind,
        velocities_m_s: vec![velocity; 8],
    };
    grid.validate().unwrap();
    WindVolume::of_grid(&grid, DMat3::IDENTITY)
}

impl Bench {
    /// Creates a bench for snow of this rate, on a headless device; at most `most` flakes are drawn.
    fn new(rate_mm_h: f64, most: u32) -> Self {
        let device = Device::headless(&DeviceOptions::default()).expect("a software driver is installed");
        let blocks = Blocks::new();
        let block = blocks.block(&device, size_of::<FlakesUniform>());
        let pass = pass(&device, &blocks);
        Self { device, blocks, block, pass, wind: WindTexture::default(), flakes: flakes(rate_mm_h, most) }
    }

    /// Advances the flakes to `time_s` in a weather with a uniform wind.
    fn step(&mut self, time_s: f64, eye: DVec3, wind: DVec3, volume: Option<&WindVolume>) {
        let camera = Camera::look_to(DVec3::ZERO, DVec3::Y, DVec3::Z, 0.9, 1.6, 0.1);
        let rays = ViewRays::new(&camera, &DepthMapping { reversed: true, ..DepthMapping::default() }).unwrap();
        let shot = StreakCamera {
            clip: DMat4::IDENTITY,
            rays: &rays,
            height: 100,
            y_sign: 1.0,
            position_m: eye,
            velocity_m_s: DVec3::ZERO,
            exposure_s: 1.0 / 60.0,
            gain: 1.0,
        };
        let air = MovingAir { displacement_m: wind * time_s, velocity_m_s: wind, time_s, extinction_per_m: 0.0 };
        let dark = LightAround { above: DVec3::ZERO, below: DVec3::ZERO, sun: DVec3::ZERO, to_sun: DVec3::Z };
        let block = FlakesUniform::new(SEED, &self.flakes, &dark, &shot, &air);
        self.block.write(bytemuck::bytes_of(&block));
        let carried = |from| wind * (time_s - from);
        let blown = (self.wind.view(&self.device, volume), volume.map(|v| WindMap::new(v, eye)));
        let by = stepped((SEED, &self.flakes), (&shot, &air), &carried, blown);
        let mut encoder = self.device.device.create_command_encoder(&Default::default());
        let own = self.block.range(0, self.block.bytes());
        self.pass.step(&self.device, &mut encoder, own, &by).unwrap();
        self.blocks.upload(&self.device);
        self.device.submit_and_wait(encoder).unwrap();
    }

    /// Reads all flakes back, shell by shell; `eye` is the camera's position, m.
    fn read(&self, eye: DVec3) -> Vec<Read> {
        let of_shell = |(s, words): (usize, Vec<[u32; 8]>)| {
            let eye = eye.to_array().map(|x| fraction(x, side_m(s)));
            let of = move |w: [u32; 8]| Read {
                position_m: nearest([w[0], w[1], w[2]], eye, side_m(s)),
                velocity_m_s: DVec3::from([w[4], w[5], w[6]].map(|b| f64::from(f32::from_bits(b)))),
                shell: s,
                times: w[3] >> 16,
            };
            words.into_iter().map(of)
        };
        self.pass.read(&self.device).into_iter().enumerate().flat_map(of_shell).collect()
    }

    /// Returns the places of the lattice's flakes relative to the camera, without their helix, in the order of the
    /// states, m.
    fn of_lattice(&self, eye: DVec3, wind: DVec3, time_s: f64) -> Vec<DVec3> {
        let all = lattice::flakes(&self.flakes, SEED, eye, wind * time_s, time_s);
        let place = |f: lattice::Flake| {
            let shell = f.id.0 as usize;
            nearest(f.place, eye.to_array().map(|x| fraction(x, side_m(shell))), side_m(shell))
        };
        all.map(place).collect()
    }
}

#[test]
fn in_an_even_wind_flakes_are_those_of_the_lattice_until_they_leave() {
    let mut bench = Bench::new(1.5, 12_000);
    let (eye, wind) = (DVec3::new(3.0, -2.0, 1.5), DVec3::new(1.5, 0.5, 0.0));
    // A wind volume that adds 0 m/s.
    let nothing = even([0.0; 3], WindGridKind::Added);
    bench.step(100.0, eye, wind, Some(&nothing));
    let first = bench.read(eye);
    let lattice = bench.of_lattice(eye, wind, 100.0);
    assert!(first.len() == lattice.len() && first.len() == bench.flakes.drawn as usize, "{}", first.len());
    let off = |read: &[Read], lattice: &[DVec3]| {
        let still = read.iter().zip(lattice).filter(|(a, _)| a.times == 0);
        still.map(|(a, b)| (a.position_m - *b).length()).fold((0usize, 0.0f64), |(n, most), e| (n + 1, most.max(e)))
    };
    let (n, most) = off(&first, &lattice);
    assert!(n == first.len() && most < 1e-4, "{n}: {most}");
    for k in 1..=40 {
        bench.step(100.0 + f64::from(k) / 50.0, eye, wind, Some(&nothing));
    }
    let now = bench.read(eye);
    let (n, most) = off(&now, &bench.of_lattice(eye, wind, 100.8));
    println!("{n} of {} have stayed, {most:.5} m off at most", now.len());
    assert!(n > now.len() / 3 && n < now.len() && most < 0.01, "{n}: {most}");
}

#[test]
fn flakes_move_with_the_wind_at_their_place_and_fall_at_their_own_speed() {
    let mut bench = Bench::new(1.5, 12_000);
    let eye = DVec3::new(0.0, 0.0, 2.0);
    let up = even([4.0, 0.0, 0.5], WindGridKind::Whole);
    for k in 0..=150 {
        bench.step(f64::from(k) / 25.0, eye, DVec3::ZERO, Some(&up));
    }
    let now = bench.read(eye);
    let (slowest, n) = (bench.flakes.slowest_m_s(), now.len() as f64);
    for f in &now {
        let v = f.velocity_m_s - DVec3::new(4.0, 0.0, 0.5);
        assert!(v.truncate().length() < 0.02 && v.z < -0.9 * slowest && v.z > -4.0, "{}", f.velocity_m_s);
    }
    // The mean fall speed is that of the classes, weighted by their numbers of flakes.
    let per_class = (0..lattice::CLASSES).map(|k| {
        let upto = |k: usize| (0..SHELLS).map(|s| f64::from(bench.flakes.upto[k][s])).sum::<f64>();
        (upto(k) - if k > 0 { upto(k - 1) } else { 0.0 }) * f64::from(bench.flakes.table[k][1]) * SPEED_UNIT
    });
    let (want, got) = (per_class.sum::<f64>() / n, 0.5 - now.iter().map(|f| f.velocity_m_s.z).sum::<f64>() / n);
    assert!((got / want - 1.0).abs() < 0.01, "{got} of {want}");
    // The flakes stay evenly spread after each has re-entered the cell.
    assert!(now.iter().all(|f| f.times > 0));
    for s in 0..bench.flakes.shells {
        let mut octants = [0.0; 8];
        now.iter().filter(|f| f.shell == s).for_each(|f| {
            let p = f.position_m;
            octants[usize::from(p.x > 0.0) + 2 * usize::from(p.y > 0.0) + 4 * usize::from(p.z > 0.0)] += 1.0;
        });
        let want: f64 = octants.iter().sum::<f64>() / 8.0;
        assert!(octants.iter().all(|n| (n - want).abs() < 5.0 * want.sqrt() + 1.0), "shell {s}: {octants:?}");
    }
}

#[test]
fn snow_that_grows_adds_flakes_and_moves_none() {
    let eye = DVec3::ZERO;
    let mut bench = Bench::new(1.5, 3_000);
    bench.step(7.0, eye, DVec3::X, None);
    bench.step(7.5, eye, DVec3::X, None);
    let few = bench.read(eye);
    bench.flakes = flakes(1.5, 12_000);
    bench.step(7.5, eye, DVec3::X, None);
    let many = bench.read(eye);
    assert!(many.len() > few.len(), "{} and {}", few.len(), many.len());
    for s in 0..bench.flakes.shells {
        let of = |list: &[Read]| -> Vec<DVec3> { list.iter().filter(|f| f.shell == s).map(|f| f.position_m).collect() };
        let (before, after) = (of(&few), of(&many));
        let kept = before.len().min(after.len());
        assert!(before[..kept] == after[..kept], "shell {s}");
    }
}
