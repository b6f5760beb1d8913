//! Maps of the sky: transmittance by integration rule, radiance near the horizon and through twilight, unusual media,
//! stored radiances.

use half::f16;
use welkin::Result;
use welkin::sky::probe::{Answer, Probe, Question, Ray as ProbeRay};
use welkin::sky::reference::medium::Medium;
use welkin::sky::reference::ray::{Ray, horizon_mu};
use welkin::sky::reference::{Options as Truth, Orders, Reference, View};
use welkin::sky::{Planet, SkyModel, SkySettings};

use super::{Axis, Cell, Map, Panel};
use crate::chart::Lab;
use crate::command::Options;

/// Transmittance to space by the rule of much public code: samples at 0.3 of a step, with step lengths counted from the
/// last sample.
pub fn offset_transmittance(medium: &Medium, altitude_m: f64, mu: f64, n: u32) -> f64 {
    by_rule(
        medium,
        altitude_m,
        mu,
        |i| {
            let t = |i: i64| if i < 0 { 0.0 } else { (i as f64 + 0.3) / f64::from(n) };
            (t(i64::from(i)), t(i64::from(i)) - t(i64::from(i) - 1))
        },
        n,
    )
}

/// Transmittance to space by midpoints of equal steps.
pub fn midpoint_transmittance(medium: &Medium, altitude_m: f64, mu: f64, n: u32) -> f64 {
    by_rule(medium, altitude_m, mu, |i| ((f64::from(i) + 0.5) / f64::from(n), 1.0 / f64::from(n)), n)
}

fn by_rule(medium: &Medium, altitude_m: f64, mu: f64, node: impl Fn(u32) -> (f64, f64), n: u32) -> f64 {
    let ray = Ray::new(medium, altitude_m, mu);
    let Some((start, end, _)) = ray.in_air(medium) else { return 1.0 };
    let mut columns = [0.0; 3];
    for i in 0..n {
        let (x, w) = node(i);
        let density = medium.density(ray.altitude_at(start + x * (end - start)));
        (0..3).for_each(|k| columns[k] += w * (end - start) * density[k]);
    }
    medium.transmittance(&columns)[1]
}

/// Transmittance by altitude and angle above the horizon.
pub fn quadrature(lab: &Lab, _options: &Options) -> Result<Map> {
    let x = Axis::ratios("angle above the horizon, deg", 0.01, 90.0, 40);
    let y = Axis::ratios("altitude, m", 1.0, 6e4, 26);
    let planet = Planet::earth();
    let medium = Medium::of(&planet);
    let mu_of = |angle: f64, h: f64| (horizon_mu(&medium, h).acos() - angle.to_radians()).max(0.0).cos();
    let exact = |angle: f64, h: f64| {
        let ray = Ray::new(&medium, h, mu_of(angle, h));
        medium.transmittance(&ray.columns_to_space(&medium))[1]
    };
    let cell = |t: f64, angle: f64, h: f64| Cell::of((t - exact(angle, h)) / (exact(angle, h) + 0.01));
    let small = SkySettings { orders: 3, suns: 16, altitudes: 8, ..Default::default() };
    let mut probe = Probe::new(&lab.device, &small, &planet)?;
    let mut drawn = Vec::new();
    for h in &y.values {
        let zenith = |angle: &f64| mu_of(*angle, *h).clamp(-1.0, 1.0).acos();
        let rays: Vec<ProbeRay> = x.values.iter().map(|a| ProbeRay::at(zenith(a), 0.5, 0.0)).collect();
        drawn.extend(probe.under_sun(Question::Sky, *h, 0.8, &rays)?);
    }
    let mut next = drawn.into_iter();
    let panels = vec![
        Panel::of("usual: 40 nodes, offset 0.3", false, &x, &y, |a, h| {
            cell(offset_transmittance(&medium, h, mu_of(a, h), 40), a, h)
        }),
        Panel::of("midpoint, 40 nodes", false, &x, &y, |a, h| {
            cell(midpoint_transmittance(&medium, h, mu_of(a, h), 40), a, h)
        }),
        Panel::of("Welkin: closed form, as drawn", true, &x, &y, |a, h| {
            next.next().map_or(Cell::NotFinite, |t: Answer| cell(f64::from(t.transmittance[1]), a, h))
        }),
    ];
    Ok(Map { title: "Transmittance to space, green", x, y, panels, tolerance: 1e-3 })
}

fn solve(planet: &Planet) -> Result<Reference> {
    Reference::solve(planet, &Truth { disc_strips: 3, threads: 2, ..Default::default() })
}

fn settings(model: SkyModel, quick: bool) -> SkySettings {
    let name = if quick { format!("{}-quarter", model.name()) } else { model.name().to_owned() };
    let found = welkin::candidates::candidate(welkin::candidates::Effect::Sky, &name).map(|c| c.method);
    match found {
        Ok(welkin::candidates::Method::Sky(s)) => s,
        _ => SkySettings::with_model(model),
    }
}

/// Whether r^2 (mu^2 - 1) + R^2 in f32 detects that a ray meets the ground.
pub fn naive_ground(radius: f32, altitude: f32, mu: f32) -> bool {
    let r = radius + altitude;
    mu < 0.0 && r * r * (mu * mu - 1.0) + radius * radius >= 0.0
}

/// Radiance near the horizon at all heights.
pub fn horizon(lab: &Lab, options: &Options) -> Result<Map> {
    // Angles are dense near the horizon, which lies between two points.
    let mut angles: Vec<f64> = (0..if options.quick { 6 } else { 14 }).map(|i| 2.0 * 0.5f64.powi(i)).collect();
    angles.sort_by(f64::total_cmp);
    let below: Vec<f64> = angles.iter().rev().map(|a| -a).collect();
    let x = Axis::list("angle above the horizon, deg", &[below, angles].concat());
    let heights = [-100.0, -1.0, 0.0, 1.0, 3.0, 10.0, 100.0, 1e3, 3e3, 1e4, 3e4, 6e4, 9e4, 1e5, 3e5, 1e6, 1e7];
    let y = Axis::list("altitude, m", &heights);
    let planet = Planet::earth();
    let medium = Medium::of(&planet);
    let sun = 60f64.to_radians();
    let reference = solve(&planet)?;
    let zenith = |angle: f64, h: f64| horizon_mu(&medium, h.max(0.0)).acos() - angle.to_radians();
    let mut truth = Vec::new();
    for h in &y.values {
        for angle in &x.values {
            let view = View { altitude_m: *h, sun_zenith: sun, view_zenith: zenith(*angle, *h), azimuth: 0.9 };
            truth.push(reference.radiance(&view)?.radiance[1]);
        }
    }
    let radius = planet.bottom_radius_m;
    let naive = |angle: f64, h: f64| {
        let meets = naive_ground(radius as f32, h as f32, zenith(angle, h).cos() as f32);
        if meets == (angle < 0.0) { Cell::Right } else { Cell::Wrong }
    };
    let mut panels = vec![Panel::of("usual: side by f32 roots", false, &x, &y, naive)];
    for (title, model) in [("table3d", SkyModel::Table3d), ("Welkin: directional", SkyModel::Directional)] {
        let mut probe = Probe::new(&lab.device, &settings(model, options.quick), &planet)?;
        let mut cells = Vec::new();
        for (j, h) in y.values.iter().enumerate() {
            let rays: Vec<ProbeRay> = x.values.iter().map(|a| ProbeRay::at(zenith(*a, *h), 0.9, 0.0)).collect();
            let drawn = probe.under_sun(Question::Sky, *h, sun, &rays)?;
            let row = &truth[j * rays.len()..(j + 1) * rays.len()];
            cells.extend(row_cells(&drawn, row));
        }
        panels.push(Panel { title: title.to_owned(), cells, ours: model == SkyModel::Directional });
    }
    Ok(Map { title: "Radiance about the horizon, sun at 60 degrees", x, y, panels, tolerance: 0.1 })
}

/// Errors of a row of green radiances. The floor is a hundredth of the row's exposure level, at least 1e-9 of the sun.
fn row_cells(drawn: &[Answer], truth: &[f64]) -> Vec<Cell> {
    let mean = truth.iter().sum::<f64>() / truth.len() as f64;
    let white = (mean / 0.18).max(1e-7);
    let cell = |(a, b): (&Answer, &f64)| {
        let v = f64::from(a.radiance[1]);
        if v < 0.0 { Cell::NotFinite } else { Cell::of((v - b) / (b + 0.01 * white)) }
    };
    drawn.iter().zip(truth).map(cell).collect()
}

/// Sun and view angles of the twilight maps.
fn twilight_axes(quick: bool) -> (Axis, Axis) {
    let x = Axis::steps("sun's zenith angle, deg", 80.0, 110.0, if quick { 16 } else { 61 });
    (x, Axis::steps("view's zenith angle, deg", 0.0, 88.0, if quick { 6 } else { 12 }))
}

/// Green radiance per unit irradiance, ordered by sun, then view.
fn twilight_truth(x: &Axis, y: &Axis) -> Result<Vec<f64>> {
    let planet = Planet::earth();
    let reference = solve(&planet)?;
    let mut truth = Vec::new();
    for sun in &x.values {
        for view in &y.values {
            truth.push(reference.radiance(&View::degrees(20.0, *sun, *view, 25.0))?.radiance[1]);
        }
    }
    Ok(truth)
}

/// Radiance during sunset.
pub fn twilight(lab: &Lab, options: &Options) -> Result<Map> {
    let (x, y) = twilight_axes(options.quick);
    let truth = twilight_truth(&x, &y)?;
    let n = y.values.len();
    let mut panels = Vec::new();
    for (title, model) in [
        ("table3d", SkyModel::Table3d),
        ("isotropic", SkyModel::IsotropicTables),
        ("Welkin: directional", SkyModel::Directional),
    ] {
        let mut probe = Probe::new(&lab.device, &settings(model, options.quick), &Planet::earth())?;
        let mut by_sun: Vec<Vec<Cell>> = Vec::new();
        let mut before = f32::INFINITY;
        for (i, sun) in x.values.iter().enumerate() {
            let at = |v: &f64| ProbeRay::at(v.to_radians(), 25f64.to_radians(), 0.0);
            let rays: Vec<ProbeRay> = y.values.iter().map(at).collect();
            let drawn = probe.under_sun(Question::Sky, 20.0, sun.to_radians(), &rays)?;
            let mut column = row_cells(&drawn, &truth[i * n..(i + 1) * n]);
            let zenith = drawn[0].radiance[1];
            if zenith > before * 1.0005 + 1e-12 {
                column[0] = Cell::Jumps;
            }
            before = zenith;
            by_sun.push(column);
        }
        let cells = (0..n).flat_map(|j| by_sun.iter().map(move |c| c[j])).collect();
        panels.push(Panel { title: title.to_owned(), cells, ours: model == SkyModel::Directional });
    }
    Ok(Map {
        title: "Twilight: radiance 20 m above the ground, 25 degrees from the sun's azimuth",
        x,
        y,
        panels,
        tolerance: 0.1,
    })
}

/// Precision lost by storing a radiance.
pub fn half_floats(_lab: &Lab, options: &Options) -> Result<Map> {
    let (x, y) = twilight_axes(options.quick);
    let truth = twilight_truth(&x, &y)?;
    let irradiance = Planet::earth().solar_irradiance[1];
    let n = y.values.len();
    let panel = |title: &str, ours, store: fn(f64) -> f64| {
        let at = |i: usize, j: usize| truth[i * n + j] / irradiance;
        let cell = |v: f64| if v > 0.0 { Cell::of(store(v) / v - 1.0) } else { Cell::Nothing };
        let places = (0..n).flat_map(|j| (0..x.values.len()).map(move |i| (i, j)));
        Panel { title: title.to_owned(), cells: places.map(|(i, j)| cell(at(i, j))).collect(), ours }
    };
    let panels = vec![
        panel("usual: fp16", false, |v| f16::from_f64(v).to_f64()),
        panel("Welkin: square root in fp16", true, |v| f16::from_f64(v.sqrt()).to_f64().powi(2)),
        panel("fp32", false, |v| f64::from(v as f32)),
    ];
    Ok(Map { title: "A stored radiance through twilight, relative error", x, y, panels, tolerance: 0.01 })
}

/// A march in f32 as in much public code: source times (1 - T)/sigma, and all orders as 1/(1 - f).
pub fn usual_march(factor: f32, scale_m: f32) -> f32 {
    let (n, top, beta) = (40, 60_000.0f32, 1.149e-5f32);
    let ds = 2.0 * top / n as f32;
    let (mut light, mut through, mut again) = (0.0f32, 1.0f32, 0.0f32);
    for i in 0..n {
        let h = (i as f32 + 0.3) / n as f32 * top;
        let sigma = factor * beta * (-h / scale_m).exp();
        let sun = (-factor * beta * scale_m * (-h / scale_m).exp()).exp();
        let step = (-sigma * ds).exp();
        light += through * (sigma * sun - sigma * sun * step) / sigma;
        again += through * (sigma - sigma * step) / sigma;
        through *= step;
    }
    light / (1.0 - again)
}

/// The integrals of [`usual_march`] in f64 with steps a hundred times finer, each solved without cancellation: the
/// method's result without rounding errors. `None` where there is no light, and where its series diverges.
fn usual_march_truth(factor: f64, scale_m: f64) -> Option<f64> {
    let (n, top, beta) = (4000, 60_000.0, 1.149e-5);
    let dh = top / f64::from(n);
    let (mut light, mut through, mut again) = (0.0, 1.0, 0.0);
    for i in 0..n {
        let h = (f64::from(i) + 0.5) * dh;
        let sigma = factor * beta * (-h / scale_m).exp();
        let sun = (-factor * beta * scale_m * (-h / scale_m).exp()).exp();
        let taken = -(-2.0 * sigma * dh).exp_m1();
        light += through * sun * taken;
        again += through * taken;
        through *= 1.0 - taken;
    }
    let sum = light / (1.0 - again);
    (light > 0.0 && again < 1.0 && sum.is_finite()).then_some(sum)
}

/// Unusual media, by amount of air and scale height.
pub fn media(lab: &Lab, options: &Options) -> Result<Map> {
    let (factors, scales): (&[f64], &[f64]) = if options.quick {
        (&[0.0, 1.0, 1e4], &[0.0, 0.01, 8e3])
    } else {
        (&[0.0, 0.1, 1.0, 10.0, 100.0, 1e4], &[0.0, 0.01, 1.0, 1e3, 8e3, 1e6])
    };
    let x = Axis::list("air over the Earth's", factors);
    let y = Axis::list("scale height, m", scales);
    let usual = |factor: f64, scale: f64| {
        let v = usual_march(factor as f32, scale as f32);
        if !v.is_finite() {
            Cell::NotFinite
        } else if !(0.0..=1e3).contains(&v) {
            Cell::Diverged
        } else {
            usual_march_truth(factor, scale).map_or(Cell::Nothing, |truth| Cell::of(f64::from(v) / truth - 1.0))
        }
    };
    let mut cells = Vec::new();
    for scale in &y.values {
        for factor in &x.values {
            eprintln!("    air x{factor}, scale height {scale} m ..");
            cells.push(medium_cell(lab, options, *factor, *scale)?);
        }
    }
    let panels = vec![
        Panel::of("usual: (S - S T)/sigma, 1/(1 - f)", false, &x, &y, usual),
        Panel { title: "Welkin: directional".to_owned(), cells, ours: true },
    ];
    Ok(Map { title: "Odd media: 95th percentile of the error of 24 views", x, y, panels, tolerance: 0.1 })
}

fn medium_cell(lab: &Lab, options: &Options, factor: f64, scale_m: f64) -> Result<Cell> {
    let mut planet = Planet::earth().with_air_scaled(factor);
    (planet.rayleigh.scale_height_m, planet.mie.scale_height_m) = (scale_m, scale_m);
    if planet.check().is_err() {
        return Ok(Cell::Refused);
    }
    let orders = Orders::Converged { tolerance: 2e-2, limit: 40 };
    let reference = Reference::solve(&planet, &Truth { orders, disc_strips: 3, threads: 2, ..Default::default() })?;
    let mut probe = Probe::new(&lab.device, &settings(SkyModel::Directional, options.quick), &planet)?;
    let mut errors = Vec::new();
    for sun in [30.0, 80.0] {
        let views: Vec<(f64, f64)> =
            [5.0, 60.0, 85.0, 89.5].iter().flat_map(|v| [10.0, 90.0, 170.0].map(|a| (*v, a))).collect();
        let ray = |(v, a): &(f64, f64)| ProbeRay::at(v.to_radians(), a.to_radians(), 0.0);
        let rays: Vec<ProbeRay> = views.iter().map(ray).collect();
        let drawn = probe.under_sun(Question::Sky, 10.0, f64::to_radians(sun), &rays)?;
        let truth = views
            .iter()
            .map(|(v, a)| Ok(reference.radiance(&View::degrees(10.0, sun, *v, *a))?.radiance[1]))
            .collect::<Result<Vec<_>>>()?;
        for cell in row_cells(&drawn, &truth) {
            match cell {
                Cell::Error(e) => errors.push(e),
                other => return Ok(other),
            }
        }
    }
    errors.sort_by(f64::total_cmp);
    Ok(Cell::Error(welkin::plan::difference::percentile(&errors, 0.95)))
}
