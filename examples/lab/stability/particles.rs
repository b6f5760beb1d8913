//! Maps of steps in time and sweeps in space: drag, pressure, and weather that changes.

use welkin::Result;
use welkin::weather::{Timeline, Weather, derive};

use super::{Axis, Cell, Map, Panel};

const GRAVITY: f64 = 9.81;

/// Speed over terminal speed after `steps` of explicit Euler from rest, drag linear in speed.
pub fn drag_euler(terminal: f64, dt: f64, steps: usize) -> f64 {
    let mut v = 0.0f64;
    for _ in 0..steps {
        v += dt * GRAVITY * (1.0 - v / terminal);
    }
    v / terminal
}

/// The same by the exact exponential.
pub fn drag_exact(terminal: f64, dt: f64, steps: usize) -> f64 {
    let mut v = 0.0f64;
    for _ in 0..steps {
        v = terminal + (v - terminal) * (-dt * GRAVITY / terminal).exp();
    }
    v / terminal
}

/// What explicit Euler does at a step: settles, swings, or diverges. The truth after the same time is known.
pub fn euler_cell(terminal: f64, dt: f64) -> Cell {
    let ratio = dt * GRAVITY / terminal;
    let steps = 60;
    let end = drag_euler(terminal, dt, steps);
    if !end.is_finite() || end.abs() > 10.0 {
        return Cell::Diverged;
    }
    if ratio > 1.0 {
        return Cell::Jumps;
    }
    let true_end = 1.0 - (-ratio * steps as f64).exp();
    Cell::of(end / true_end - 1.0)
}

/// Drag over step and terminal speed.
pub fn drag() -> Map {
    let x = Axis::ratios("time step, s", 1e-4, 10.0, 41);
    let y = Axis::ratios("terminal speed, m/s", 0.05, 10.0, 26);
    let exact = |dt: f64, terminal: f64| {
        let true_end = -(-60.0 * dt * GRAVITY / terminal).exp_m1();
        Cell::of(drag_exact(terminal, dt, 60) / true_end - 1.0)
    };
    let panels = vec![
        Panel::of("usual: explicit Euler", false, &x, &y, |dt, terminal| euler_cell(terminal, dt)),
        Panel::of("exact exponential", true, &x, &y, exact),
    ];
    Map { title: "A falling drop after 60 steps: speed over the true one", x, y, panels, tolerance: 1e-9 }
}

/// Residual over the first one after sweeps of successive over-relaxation on the unit square with a point source.
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

/// Over-relaxation over factor and size.
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

/// Visibility after a change of weather, over the step with which it is followed and the change's duration.
pub fn time_steps() -> Result<Map> {
    let x = Axis::ratios("time step, s", 1e-2, 1e4, 25);
    let y = Axis::ratios("duration of the change, s", 1.0, 1e4, 17);
    let from = derive(&Weather::default())?;
    let to = derive(&Weather { visibility_m: 800.0, ..Weather::default() })?;
    let visibility = |c: &welkin::weather::Conditions| c.visibility_m();
    // Half of the change has passed.
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
