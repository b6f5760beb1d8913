//! Tests of stepped drops: against their reference in f64, against the lattice, and in conditions in which explicit
//! integration diverges.

use std::sync::Arc;

use glam::{DMat4, DVec2};

use super::*;
use crate::{
    gpu::{
        DeviceOptions,
        blocks::{Blocks, UniformBlock},
    },
    rain::{
        DropLight,
        drops::GRAVITY_M_S2,
        lattice::{self, SHELLS, random3, side_m},
    },
    scene::{Camera, DepthMapping, ViewRays},
    surroundings::WindTexture,
    weather::{Precipitation, PrecipitationKind, Weather, derive},
    wind::{WindGrid, WindGridKind, WindVolume},
};
use glam::DVec3;

const SEED: u64 = 5;

/// Pass that steps drops, with the buffers that it reads.
struct Bench {
    device: Arc<Device>,
    blocks: Blocks,
    block: UniformBlock,
    pass: StepPass,
    wind: WindTexture,
    classes: Classes,
    /// Largest number of drops in all shells together.
    most: u32,
}

/// State of a drop, read back from the GPU.
#[derive(Clone, Copy)]
struct Read {
    /// Position relative to the camera, m.
    position_m: DVec3,
    /// Velocity, (east, north, up), m/s.
    velocity_m_s: DVec3,
    /// Index of the shell, from the innermost.
    shell: usize,
    /// Index of the drop's class in [`Classes`].
    class: usize,
    /// Number of times that the drop has re-entered its shell's cell.
    times: u32,
}

/// Creates the classes of rain of this rate at sea level, with at most `most` drops in all shells together.
fn classes(rate_mm_h: f64, most: u32) -> Classes {
    let precipitation = Precipitation::of(PrecipitationKind::Rain, rate_mm_h);
    let falling = derive(&Weather { precipitation, ..Weather::default() }).unwrap().precipitation;
    Classes::new(&falling, 1.0, most)
}

impl Bench {
    /// Creates a bench for rain of this rate, on a headless device, with at most `most` drops.
    fn new(rate_mm_h: f64, most: u32) -> Self {
        let device = Device::headless(&DeviceOptions::default()).expect("a software driver is installed");
        let blocks = Blocks::new();
        let block = blocks.block(&device, size_of::<RainUniform>());
        let pass = pass(&device, &blocks);
        Self { device, blocks, block, pass, wind: WindTexture::default(), classes: classes(rate_mm_h, most), most }
    }

    /// Advances the drops to `time_s` in a wind that is uniform except inside `grid`.
    fn step(&mut self, time_s: f64, position_m: DVec3, wind: DVec3, grid: Option<&WindVolume>) {
        let camera = Camera::look_to(DVec3::ZERO, DVec3::Y, DVec3::Z, 0.9, 1.6, 0.1);
        let rays = ViewRays::new(&camera, &DepthMapping { reversed: true, ..DepthMapping::default() }).unwrap();
        let shot = StreakCamera {
            clip: DMat4::IDENTITY,
            rays: &rays,
            height: 100,
            y_sign: 1.0,
            position_m,
            velocity_m_s: DVec3::ZERO,
            exposure_s: 1.0 / 60.0,
            gain: 1.0,
        };
        let air = MovingAir { displacement_m: wind * time_s, velocity_m_s: wind, time_s, extinction_per_m: 0.0 };
        let dark = DropLight { above: DVec3::ZERO, below: DVec3::ZERO, sun: DVec3::ZERO, to_sun: DVec3::Z };
        let block = RainUniform::new(SEED, &self.classes, &dark, &shot, &air);
        self.block.write(bytemuck::bytes_of(&block));
        let carried = |from| wind * (time_s - from);
        let blown = (self.wind.view(&self.device, grid), grid.map(|g| WindMap::new(g, position_m)));
        let drops = SteppedDrops { seed: SEED, classes: &self.classes, shells: SHELLS, most: self.most };
        let stepped = stepped(&drops, (&shot, &air), &carried, blown);
        let mut encoder = self.device.device.create_command_encoder(&Default::default());
        let own = self.block.range(0, self.block.bytes());
        self.pass.step(&self.device, &mut encoder, own, &stepped).unwrap();
        self.blocks.upload(&self.device);
        self.device.submit_and_wait(encoder).unwrap();
    }

    /// Reads all drops back, shell by shell; `position_m` is the camera's position.
    fn read(&self, position_m: DVec3) -> Vec<Read> {
        let mut list = Vec::new();
        for (s, shell) in self.pass.read(&self.device).into_iter().enumerate() {
            assert_eq!(shell.len(), self.classes.per_shell as usize);
            for (i, w) in shell.iter().enumerate() {
                assert_eq!(w[3] & 0xffff, s as u32);
                let eye = position_m.to_array().map(|x| lattice::fraction(x, side_m(s)));
                list.push(Read {
                    position_m: lattice::nearest([w[0], w[1], w[2]], eye, side_m(s)),
                    velocity_m_s: DVec3::from([w[4], w[5], w[6]].map(|b| f64::from(f32::from_bits(b)))),
                    shell: s,
                    class: self.classes.table.partition_point(|row| row[2] <= i as f32),
                    times: w[3] >> 16,
                });
            }
        }
        list
    }

    /// Returns the fall speed of a class in still air, m/s.
    fn terminal(&self, class: usize) -> f64 {
        f64::from(self.classes.table[class][1]) * lattice::SPEED_UNIT
    }
}

/// Radius of the cylinder in [`round_cylinder`], m.
const RADIUS_M: f64 = 1.5;
/// Speed of the wind far from the cylinder, m/s; it blows to the east.
const SPEED_M_S: f64 = 6.0;

/// Returns the potential flow across a cylinder that lies along north through the origin (Lamb 1932, section 68), m/s;
/// 0 inside the cylinder.
fn round_cylinder(p: DVec3) -> DVec3 {
    let r2 = p.x * p.x + p.z * p.z;
    if r2 < RADIUS_M * RADIUS_M {
        return DVec3::ZERO;
    }
    let k = RADIUS_M * RADIUS_M / (r2 * r2);
    DVec3::new(1.0 - k * (p.x * p.x - p.z * p.z), 0.0, -2.0 * k * p.x * p.z) * SPEED_M_S
}

/// Samples [`round_cylinder`] on a wind grid, which is 0.25 m fine to the east and 0.375 m upward.
fn cylinder() -> WindVolume {
    let (nodes, cell_m) = ([64, 2, 32], DVec3::new(0.25, 60.0, 0.375));
    let origin = DVec3::new(-8.0, -30.0, -5.8125);
    let mut velocities_m_s = Vec::new();
    for z in 0..nodes[2] {
        for y in 0..nodes[1] {
            for x in 0..nodes[0] {
                let p = origin + DVec3::new(f64::from(x), f64::from(y), f64::from(z)) * cell_m;
                velocities_m_s.push(round_cylinder(p).as_vec3().to_array());
            }
        }
    }
    let grid = WindGrid { origin, cell_m, nodes, kind: WindGridKind::Whole, velocities_m_s };
    grid.validate().unwrap();
    WindVolume::of_grid(&grid, glam::DMat3::IDENTITY)
}

/// Integrates the motion of a drop with quadratic drag by the fourth-order Runge-Kutta method. Returns its last
/// position and its smallest distance from the cylinder's axis, m.
fn fall(mut x: DVec3, mut v: DVec3, terminal: f64, time_s: f64) -> (DVec3, f64) {
    let pull = |x: DVec3, v: DVec3| {
        let w = v - round_cylinder(x);
        -DVec3::Z * GRAVITY_M_S2 - w * (w.length() * GRAVITY_M_S2 / (terminal * terminal))
    };
    let n = (time_s / 5e-4).ceil();
    let h = time_s / n;
    let mut nearest = f64::INFINITY;
    for _ in 0..n as usize {
        let (a1, v1) = (pull(x, v), v);
        let (a2, v2) = (pull(x + v1 * (h / 2.0), v + a1 * (h / 2.0)), v + a1 * (h / 2.0));
        let (a3, v3) = (pull(x + v2 * (h / 2.0), v + a2 * (h / 2.0)), v + a2 * (h / 2.0));
        let (a4, v4) = (pull(x + v3 * h, v + a3 * h), v + a3 * h);
        x += (v1 + (v2 + v3) * 2.0 + v4) * (h / 6.0);
        v += (a1 + (a2 + a3) * 2.0 + a4) * (h / 6.0);
        nearest = nearest.min(DVec2::new(x.x, x.z).length());
    }
    (x, nearest)
}

#[test]
fn drops_go_round_a_cylinder_as_true_drag_takes_them() {
    let grid = cylinder();
    for (frames, dt, bound) in [(36, 1.0 / 60.0, 0.03), (5, 0.12, 0.03)] {
        let mut bench = Bench::new(20.0, 16_000);
        let eye = DVec3::new(-1.0, 0.0, 1.0);
        let wind = DVec3::X * SPEED_M_S;
        bench.step(0.0, eye, wind, Some(&grid));
        let start = bench.read(eye);
        for k in 1..=frames {
            bench.step(f64::from(k) * dt, eye, wind, Some(&grid));
        }
        let end = bench.read(eye);
        let time = f64::from(frames) * dt;
        let (mut errors, mut bent) = (Vec::new(), 0.0f64);
        for (a, b) in start.iter().zip(&end).filter(|(_, b)| b.times == 0) {
            let from = a.position_m + eye;
            let inside = |p: DVec3| p.x.abs() < 7.9 && p.z.abs() < 5.7;
            let terminal = bench.terminal(b.class);
            let (want, nearest) = fall(from, a.velocity_m_s, terminal, time);
            if !inside(from) || !inside(want) || nearest < RADIUS_M + 0.25 {
                continue;
            }
            errors.push((b.position_m + eye - want).length());
            bent = bent.max((from + (wind - DVec3::Z * terminal) * time - want).length());
        }
        errors.sort_by(f64::total_cmp);
        let (n, most) = (errors.len(), errors.last().copied().unwrap_or(0.0));
        let rms = (errors.iter().map(|e| e * e).sum::<f64>() / n as f64).sqrt();
        println!("steps of {dt:.4} s: {n} drops bent by up to {bent:.2} m: {rms:.4} m RMS, {most:.3} m at most");
        assert!(n > 300 && bent > 1.0 && rms < bound && most < 4.0 * bound, "{n} {bent} {rms} {most}");
    }
}

#[test]
fn in_an_even_wind_drops_are_those_of_the_lattice_until_they_leave_and_stay_even() {
    let mut bench = Bench::new(20.0, 20_000);
    let (eye, wind) = (DVec3::new(3.0, -2.0, 1.5), DVec3::new(6.0, 2.0, 0.0));
    let lattice_at =
        |bench: &Bench, t: f64| -> Vec<_> { lattice::drops(&bench.classes, SEED, eye, wind * t, t).collect() };
    bench.step(100.0, eye, wind, None);
    let first: Vec<_> = bench.read(eye).iter().zip(lattice_at(&bench, 100.0)).map(|(a, b)| (*a, b)).collect();
    assert!(first.iter().all(|(a, b)| (a.position_m - b.position_m).length() < 1e-4 && a.times == 0));
    for k in 1..=30 {
        bench.step(100.0 + f64::from(k) / 60.0, eye, wind, None);
    }
    let now = bench.read(eye);
    let (mut same, mut stayed) = (0, 0);
    for (a, b) in now.iter().zip(lattice_at(&bench, 100.5)).filter(|(a, _)| a.times == 0) {
        stayed += 1;
        same += usize::from((a.position_m - b.position_m).length() < 0.01);
    }
    assert!(same == stayed && stayed > now.len() / 5 && stayed < now.len(), "{same} of {stayed} of {}", now.len());
    for k in 1..=200 {
        bench.step(100.5 + f64::from(k) / 20.0, eye, wind, None);
    }
    let later = bench.read(eye);
    evenly_spread(&later, "after ten seconds");
    for d in &later {
        let rest = wind - DVec3::Z * bench.terminal(d.class);
        assert!(d.times > 0 && (d.velocity_m_s - rest).length() < 0.02, "{} against {rest}", d.velocity_m_s);
    }
}

/// Checks that each octant of a shell's cell, and the sphere in it around the camera, have their share of the drops
/// within chance.
fn evenly_spread(drops: &[Read], what: &str) {
    for s in 0..SHELLS {
        let mut octants = [0u32; 8];
        let (mut near, mut all) = (0.0, 0.0);
        for d in drops.iter().filter(|d| d.shell == s) {
            assert!(d.position_m.is_finite() && d.velocity_m_s.length() < 150.0, "{what}: {}", d.velocity_m_s);
            let p = d.position_m;
            octants[usize::from(p.x > 0.0) + 2 * usize::from(p.y > 0.0) + 4 * usize::from(p.z > 0.0)] += 1;
            near += f64::from(u8::from(p.length() < 0.5 * side_m(s)));
            all += 1.0;
        }
        for n in octants {
            let want = all / 8.0;
            assert!((f64::from(n) - want).abs() < 5.0 * want.sqrt() + 1.0, "{what}, shell {s}: {octants:?}");
        }
        let want = all * std::f64::consts::PI / 6.0;
        assert!((near - want).abs() < 5.0 * want.sqrt() + 1.0, "{what}, shell {s}: {near} near, {want} expected");
    }
}

#[test]
fn no_step_wind_rate_or_camera_makes_a_burst_or_a_gap() {
    for (i, (rate, wind, speed)) in
        [(0.01, 0.0, 0.0), (20.0, 80.0, 0.0), (500.0, 25.0, 300.0), (500.0, 80.0, -300.0)].into_iter().enumerate()
    {
        let mut bench = Bench::new(rate, 16_000);
        let wind = DVec3::new(wind, 0.3 * wind, 0.0);
        let (mut t, mut eye) = (1e3 * i as f64, DVec3::new(1e7, -1e7, 2.0));
        for (k, dt) in
            [0.0, 1.0 / 60.0, 1.0 / 60.0, 0.0, 0.25, 1.0, 10.0, 1.0 / 60.0, 1e6, 1.0 / 60.0, 1.0].iter().enumerate()
        {
            t += dt;
            eye += DVec3::new(0.2, 1.0, 0.0) * (speed * dt.min(20.0));
            bench.step(t, eye, wind, None);
            evenly_spread(&bench.read(eye), &format!("rate {rate}, wind {wind}, camera {speed}, step {k} of {dt} s"));
        }
        // The camera jumps without notice.
        eye += DVec3::new(12_345.6, -777.7, 33.3);
        bench.step(t + 1.0 / 60.0, eye, wind, None);
        evenly_spread(&bench.read(eye), "after a teleport");
    }
}

#[test]
fn nothing_moves_while_time_stands_and_rain_that_grows_adds_drops() {
    let (eye, wind) = (DVec3::ZERO, DVec3::X * 5.0);
    let mut bench = Bench::new(2.0, 16_000);
    bench.step(7.0, eye, wind, None);
    bench.step(7.25, eye, wind, None);
    let before = bench.read(eye);
    bench.step(7.25, eye, wind, None);
    // While time stands still, a moved camera sees the same drops from another place.
    bench.step(7.25, DVec3::new(0.0, 0.25, 0.0), wind, None);
    let after = bench.read(DVec3::new(0.0, 0.25, 0.0));
    let mut kept = 0;
    for (a, b) in before.iter().zip(&after) {
        let still = (a.position_m - b.position_m - DVec3::Y * 0.25).length() < 1e-5 && a.velocity_m_s == b.velocity_m_s;
        assert!(still || b.times > a.times, "{} {}", a.position_m, b.position_m);
        kept += usize::from(still);
    }
    assert!(kept > before.len() * 4 / 5, "{kept} of {}", before.len());
    let few = bench.classes.per_shell;
    bench.classes = classes(2.5, 16_000);
    bench.step(7.25, eye, wind, None);
    assert!(bench.classes.per_shell >= few);
    evenly_spread(&bench.read(eye), "after the rate grew");
}

/// Checks `step`, the reference of the shader's step.
#[test]
fn a_step_ends_at_rest_and_short_steps_follow_drag_by_the_square() {
    let mut ends = Vec::new();
    for i in 0..200u32 {
        let r = random3([i, 3, 9]).map(|x| f64::from(x) / 4_294_967_296.0);
        let (terminal, air) = (0.2 + 9.0 * r[0], DVec3::new(60.0 * r[1], -20.0, 3.0));
        for dt in [0.0, 1e-3, 1.0 / 60.0, 0.25, 1.0, 10.0] {
            let (mut v, mut most) = (DVec3::new(-30.0 * r[2], 5.0, 20.0), 0.0f64);
            let first = (v - (air - DVec3::Z * terminal)).length();
            for _ in 0..4000 {
                v = step(v, air, terminal, dt).0;
                most = most.max((v - (air - DVec3::Z * terminal)).length());
            }
            assert!(most < 1.2 * first + 10.0, "{terminal} {dt}: {most} from {first}");
            if dt > 1e-3 {
                ends.push((v - (air - DVec3::Z * terminal)).length());
            }
        }
    }
    assert!(ends.iter().all(|e| *e < 1e-6));
}
