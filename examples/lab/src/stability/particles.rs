//! Maps of time steps and solver sweeps: drops in the wind, pressure, and changing weather.

use glam::{DVec2, DVec3};
use welkin::Result;
use welkin::flow::{Scheme, probe::taylor_green};
use welkin::rain::drops::{GRAVITY_M_S2, relax, terminal_speed_m_s};
use welkin::rain::integrated::step;
use welkin::rain::lattice::{Moment, side_m};
use welkin::weather::{Timeline, Weather, Wind, derive};
use welkin::wind::Drift;

use super::{Axis, Cell, Map, Panel};

/// Wind that suddenly meets a drop falling through still air, m/s.
const GUST: DVec3 = DVec3::new(20.0, 0.0, 0.0);
/// Number of steps after which the paths are compared.
const STEPS: usize = 60;

/// One step of a drop: returns velocity and path from velocity, air velocity, terminal speed and step length.
pub type Step = fn(DVec3, DVec3, f64, f64) -> (DVec3, DVec3);

/// Quadratic drag as an acceleration; a drop at `terminal` speed is in equilibrium.
fn by_square(v: DVec3, air: DVec3, terminal: f64) -> DVec3 {
    let against = v - air;
    -DVec3::Z * GRAVITY_M_S2 - against * (against.length() * GRAVITY_M_S2 / (terminal * terminal))
}

/// Linear drag as an acceleration; a drop at `terminal` speed is in equilibrium.
fn linear(v: DVec3, air: DVec3, terminal: f64) -> DVec3 {
    -DVec3::Z * GRAVITY_M_S2 - (v - air) * (GRAVITY_M_S2 / terminal)
}

/// The usual step (explicit Euler): all terms from the values at its start.
pub fn euler(v: DVec3, air: DVec3, terminal: f64, dt: f64) -> (DVec3, DVec3) {
    (v + by_square(v, air, terminal) * dt, v * dt)
}

/// Path of a drop in the gust after `time`, by a fourth-order method with steps of a hundredth of the drag time.
fn true_way(pull: fn(DVec3, DVec3, f64) -> DVec3, terminal: f64, time: f64) -> DVec3 {
    let settled = GUST - DVec3::Z * terminal;
    let (mut v, mut way, mut left) = (-DVec3::Z * terminal, DVec3::ZERO, time);
    while left > 0.0 && (v - settled).length() > 1e-11 {
        let quickest = GRAVITY_M_S2 / terminal * ((v - GUST).length() / terminal).max(1.0);
        let h = left.min(0.01 / quickest);
        let k1 = pull(v, GUST, terminal);
        let k2 = pull(v + k1 * (0.5 * h), GUST, terminal);
        let k3 = pull(v + k2 * (0.5 * h), GUST, terminal);
        let k4 = pull(v + k3 * h, GUST, terminal);
        way += (v + (k1 + k2 + k3) * (h / 6.0)) * h;
        v += (k1 + (k2 + k3) * 2.0 + k4) * (h / 6.0);
        left -= h;
    }
    way + settled * left
}

/// Result of a stepping method for a drop of `diameter_mm` in the gust. The drop oscillates if it ever moves faster
/// than the wind that drives it.
pub fn gust_cell(step: Step, square: bool, diameter_mm: f64, dt: f64) -> Cell {
    let terminal = terminal_speed_m_s(diameter_mm);
    let (mut v, mut way, mut swings) = (-DVec3::Z * terminal, DVec3::ZERO, false);
    for _ in 0..STEPS {
        let (next, moved) = step(v, GUST, terminal, dt);
        (v, way) = (next, way + moved);
        if !v.is_finite() || v.length() > 1000.0 {
            return Cell::Diverged;
        }
        swings |= v.x > GUST.x * (1.0 + 1e-9);
    }
    let truth = true_way(if square { by_square } else { linear }, terminal, dt * STEPS as f64);
    if swings { Cell::Jumps } else { Cell::of((way - truth).length() / truth.length()) }
}

/// Drag by step and drop size.
pub fn drag() -> Map {
    let x = Axis::ratios("time step, s", 1e-3, 10.0, 41);
    let y = Axis::ratios("diameter, mm", 0.1, 6.0, 26);
    let panel = |title, ours, step: Step, square| {
        Panel::of(title, ours, &x, &y, |dt, diameter| gust_cell(step, square, diameter, dt))
    };
    let panels = vec![
        panel("usual: explicit Euler, drag by the square", false, euler, true),
        panel("Welkin: linear drag, solved", true, relax, false),
        panel("Welkin: drag by the square, as stepped", true, step, true),
    ];
    Map {
        title: "A drop met by a gust of 20 m/s, after 60 steps: its place over its way",
        x,
        y,
        panels,
        tolerance: 0.1,
    }
}

/// Relative error in the movement of drops that a gust carries, in one frame of 1/60 s. The gust raises the wind from 3
/// m/s by `by` within half a second, and the frame lies in the middle of it. `place` returns a position from the
/// velocity and the displacement at a time (m/s, m, s).
pub fn thrown_cell(late: f64, by: f64, place: fn(DVec2, DVec2, f64) -> DVec2) -> Result<Cell> {
    let of = |speed: f64| derive(&Weather { wind: Wind::of(speed, 270.0), ..Weather::default() });
    let mut timeline = Timeline::new(of(3.0)?);
    timeline.change(of(3.0 + by)?, late, 0.5)?;
    let blows = welkin::wind::Wind::new(5);
    let at = |t: f64| blows.blowing(&timeline, Drift::ZERO, t);
    let (from, dt) = (late + 0.25, 1.0 / 60.0);
    // Simpson's rule over the frame.
    let n = 16;
    let velocity = |i: i32| at(from + dt * f64::from(i) / f64::from(n)).velocity_m_s();
    let weight = |i: i32| if i == 0 || i == n { 1.0 } else { f64::from(2 + 2 * (i % 2)) };
    let way = (0..=n).map(|i| velocity(i) * (weight(i) * dt / f64::from(3 * n))).sum::<DVec2>();
    let [a, b] = [from, from + dt].map(|t| place(at(t).velocity_m_s(), at(t).drift.displacement_m, t));
    let off = (b - a - way).length() / way.length();
    // More than the wind blows in that time.
    Ok(if off > 1.0 { Cell::Jumps } else { Cell::of(off) })
}

/// Position as velocity times time.
pub fn by_time(velocity: DVec2, _: DVec2, t: f64) -> DVec2 {
    velocity * t
}

/// Position from the displacement, rounded to the 2^-32 of a cell's side with which drops are drawn.
pub fn by_displacement(_: DVec2, displacement: DVec2, t: f64) -> DVec2 {
    let moment = Moment::new(0, displacement.extend(0.0), t);
    let cells = displacement / side_m(0);
    let drawn = DVec2::new(f64::from(moment.air[0]), f64::from(moment.air[1])) / 4_294_967_296.0;
    (cells.floor() + drawn) * side_m(0)
}

/// A gust by its start time and its strength.
pub fn gust() -> Result<Map> {
    let x = Axis::ratios("when it comes, s", 1.0, 1e9, 37);
    let y = Axis::ratios("rise of the wind, m/s", 0.1, 80.0, 26);
    let panel = |title, ours, place| {
        Panel::of(title, ours, &x, &y, |late, by| thrown_cell(late, by, place).unwrap_or(Cell::Refused))
    };
    let panels = vec![
        panel("usual: velocity x time", false, by_time as fn(DVec2, DVec2, f64) -> DVec2),
        panel("Welkin: the displacement's integral", true, by_displacement),
    ];
    Ok(Map { title: "A gust: what it moves drops in one frame, off the wind's own way", x, y, panels, tolerance: 1e-3 })
}

/// Residual relative to the first one after sweeps of successive over-relaxation on the unit square with a point
/// source.
pub fn sor_residual(n: usize, factor: f64, sweeps: usize) -> f64 {
    let side = n + 2;
    let mut p = vec![0.0f64; side * side];
    let source = |i: usize, j: usize| if i == n / 2 && j == n / 2 { 1.0 } else { 0.0 };
    let around = |p: &[f64], k: usize| p[k - 1] + p[k + 1] + p[k - side] + p[k + side];
    for _ in 0..sweeps {
        for j in 1..=n {
            for i in 1..=n {
                let k = j * side + i;
                let relaxed = 0.25 * (around(&p, k) + source(i, j));
                p[k] += factor * (relaxed - p[k]);
            }
        }
    }
    let mut residual = 0.0f64;
    for j in 1..=n {
        for i in 1..=n {
            let k = j * side + i;
            residual = residual.max((source(i, j) + around(&p, k) - 4.0 * p[k]).abs());
        }
    }
    residual
}

/// Over-relaxation by factor and size.
pub fn over_relaxation() -> Map {
    let x = Axis::steps("relaxation factor", 0.9, 2.1, 49);
    let y = Axis::list("cells along a side", &[8.0, 12.0, 16.0, 24.0, 32.0, 48.0, 64.0]);
    let cell = |factor: f64, n: f64| {
        let residual = sor_residual(n as usize, factor, 400);
        if residual > 1.0 || !residual.is_finite() { Cell::Diverged } else { Cell::of(residual) }
    };
    let guarded = |factor: f64, n: f64| if factor >= 2.0 - 1e-9 { Cell::Refused } else { cell(factor, n) };
    let panels =
        vec![Panel::of("any factor", false, &x, &y, cell), Panel::of("factors below 2 only", true, &x, &y, guarded)];
    Map { title: "Residual after 400 sweeps of successive over-relaxation", x, y, panels, tolerance: 1.0 }
}

/// Kinetic energy that steady vortices lose in one turn, by step length and grid size.
pub fn whirls() -> Map {
    let x = Axis::list("cells that the air passes in a step", &[0.25, 0.5, 1.0, 2.0, 4.0, 8.0]);
    let y = Axis::list("cells along a side", &[16.0, 24.0, 32.0, 48.0, 64.0]);
    let lost = |scheme: Scheme| {
        move |cfl: f64, n: f64| match taylor_green(n as u32, cfl, scheme) {
            Ok(kept) => Cell::of((1.0 - kept).abs()),
            Err(_) => Cell::Refused,
        }
    };
    let panel = |title, ours, scheme| Panel::of(title, ours, &x, &y, lost(scheme));
    let panels = vec![
        panel("usual: semi-Lagrangian", false, Scheme::SemiLagrangian),
        panel("usual: MacCormack", false, Scheme::MacCormack),
        panel("Welkin: reflection", true, Scheme::Reflection),
    ];
    Map { title: "Kinetic energy that whirls without friction lose in 2 pi seconds", x, y, panels, tolerance: 0.25 }
}

/// Visibility after a change of weather, by time step and duration of the change.
pub fn time_steps() -> Result<Map> {
    let x = Axis::ratios("time step, s", 1e-2, 1e4, 25);
    let y = Axis::ratios("duration of the change, s", 1.0, 1e4, 17);
    let from = derive(&Weather::default())?;
    let to = derive(&Weather { visibility_m: 800.0, ..Weather::default() })?;
    let visibility = |c: &welkin::weather::Conditions| c.visibility_m();
    // Evaluated when half of the change has passed.
    let usual = |dt: f64, duration: f64| {
        let (a, b) = (visibility(&from).recip(), visibility(&to).recip());
        let end = 0.5 * duration;
        let steps = ((end / dt).round() as usize).clamp(1, 20_000);
        let step = dt.max(end / 20_000.0);
        let rate = 4.0 / duration;
        let mut v = a;
        (0..steps).for_each(|_| v += step * rate * (b - v));
        let exact = b + (a - b) * (-rate * end).exp();
        let share = (v - exact) / (b - a);
        if step * rate > 2.0 {
            Cell::Diverged
        } else if step * rate > 1.0 {
            Cell::Jumps
        } else {
            Cell::of(share)
        }
    };
    let ours = |dt: f64, duration: f64| {
        let once = |dt: f64| -> Result<f64> {
            let mut timeline = Timeline::new(from);
            timeline.change(to, 0.0, duration)?;
            let end = 0.5 * duration;
            let steps = (end / dt).floor().min(200.0) as usize;
            for i in 0..steps {
                timeline.advance(end * i as f64 / steps as f64);
            }
            timeline.advance(end);
            Ok(visibility(&timeline.at(end)))
        };
        match (once(dt), once(0.5 * duration)) {
            (Ok(a), Ok(b)) => Cell::of(a / b - 1.0),
            _ => Cell::Refused,
        }
    };
    let panels = vec![
        Panel::of("usual: relaxing towards the new weather", false, &x, &y, usual),
        Panel::of("Welkin's timeline", true, &x, &y, ours),
    ];
    Ok(Map { title: "Half-way through a change of weather: dependence on the step", x, y, panels, tolerance: 1e-9 })
}
