//! Maps of precision lost in f32: lengths near a planet, the forward peak, depth, distant origins, fog over distance.

use glam::{DVec2, DVec3};
use welkin::Result;
use welkin::scene::depth::DepthFormat;
use welkin::scene::{Camera, DepthMapping, ViewRays};

use super::{Axis, Cell, Map, Panel};
use crate::chart::Lab;
use crate::command::Options;

/// Distance to the horizon from r^2 - R^2, as in much code.
pub fn horizon_by_squares(radius: f32, altitude: f32) -> f32 {
    let r = radius + altitude;
    (r * r - radius * radius).sqrt()
}

/// Distance to the horizon without a difference of large numbers.
pub fn horizon_by_product(radius: f32, altitude: f32) -> f32 {
    (altitude * (2.0 * radius + altitude)).sqrt()
}

/// Distance to the horizon by height and planet.
pub fn horizon_distance() -> Map {
    let x = Axis::ratios("height, m", 1e-2, 1e7, 46);
    let y = Axis::ratios("planet's radius, m", 1e4, 1e8, 25);
    let error = |f: fn(f32, f32) -> f32, h: f64, radius: f64| {
        let (h32, r32) = (h as f32, radius as f32);
        let exact = (f64::from(h32) * (2.0 * f64::from(r32) + f64::from(h32))).sqrt();
        Cell::of(f64::from(f(r32, h32)) / exact - 1.0)
    };
    let panels = vec![
        Panel::of("usual: sqrt(r^2 - R^2)", false, &x, &y, |h, r| error(horizon_by_squares, h, r)),
        Panel::of("Welkin: sqrt(h (2R + h))", true, &x, &y, |h, r| error(horizon_by_product, h, r)),
    ];
    Map { title: "Distance to the horizon in f32", x, y, panels, tolerance: 1e-5 }
}

/// Henyey and Greenstein's function in f32 with the usual denominator, times 4 pi.
pub fn peak_usual(g: f32, cos: f32) -> f32 {
    let d = 1.0 + g * g - 2.0 * g * cos;
    (1.0 - g * g) / (d * d.sqrt())
}

/// Henyey and Greenstein's function from 1 - cos, as Welkin's fog and sky use it.
pub fn peak_from_versine(g: f32, versine: f32) -> f32 {
    let d = (1.0 - g) * (1.0 - g) + 2.0 * g * versine;
    (1.0 - g) * (1.0 + g) / (d * d.sqrt())
}

/// The forward peak by asymmetry and angle.
pub fn phase() -> Map {
    let x = Axis::ratios("1 - g", 1e-6, 0.5, 40);
    let y = Axis::ratios("angle off the sun, rad", 1e-5, 3.0, 40);
    let exact = |g: f32, angle: f64| {
        let g = f64::from(g);
        let versine = 2.0 * (0.5 * angle).sin().powi(2);
        let d = (1.0 - g) * (1.0 - g) + 2.0 * g * versine;
        (1.0 - g) * (1.0 + g) / (d * d.sqrt())
    };
    let error = |drawn: f32, g: f32, angle: f64| Cell::of(f64::from(drawn) / exact(g, angle) - 1.0);
    let g_of = |x: f64| (1.0 - x) as f32;
    let panels = vec![
        Panel::of("usual: 1 + g^2 - 2 g cos", false, &x, &y, |x, a| {
            error(peak_usual(g_of(x), a.cos() as f32), g_of(x), a)
        }),
        Panel::of("Welkin's sky: 1 - cos in f32", true, &x, &y, |x, a| {
            if x < 0.99e-4 {
                return Cell::Refused;
            }
            let g = g_of(x);
            error(peak_from_versine(g, 1.0 - a.cos() as f32), g, a)
        }),
        Panel::of("Welkin's fog: |a - b|^2/2", true, &x, &y, |x, a| {
            if x < 0.0499 {
                return Cell::Refused;
            }
            let g = g_of(x);
            // Two unit vectors in f32 that enclose the angle.
            let (s, c) = (a.sin() as f32, a.cos() as f32);
            let versine = 0.5 * (s * s + (c - 1.0) * (c - 1.0));
            error(peak_from_versine(g, versine), g, a)
        }),
    ];
    Map { title: "Forward peak of Henyey and Greenstein in f32", x, y, panels, tolerance: 0.05 }
}

/// Relative step of a depth buffer by distance and near plane.
pub fn depth() -> Result<Map> {
    let x = Axis::ratios("distance, m", 1.0, 1e6, 49);
    let y = Axis::ratios("near plane, m", 1e-2, 10.0, 25);
    let step = |near: f64, reversed: bool, distance: f64| -> Result<f64> {
        let mut camera = Camera::look_to(DVec3::ZERO, DVec3::Y, DVec3::Z, 1.0, 1.6, near);
        if !reversed {
            // Depth 1 - near/w instead of near/w.
            camera.projection.z_axis.z = -1.0;
            camera.projection.w_axis.z = -near;
        }
        let rays = ViewRays::new(&camera, &DepthMapping { reversed, ..Default::default() })?;
        Ok(rays.resolution_m(distance, DVec2::ZERO, DepthFormat::Float32) / distance)
    };
    let cell = |near: f64, reversed, distance: f64| {
        if distance < near {
            return Cell::Nothing;
        }
        step(near, reversed, distance).map_or(Cell::Refused, Cell::of)
    };
    let panels = vec![
        Panel::of("standard depth", false, &x, &y, |d, near| cell(near, false, d)),
        Panel::of("reversed depth, Welkin's own cameras", true, &x, &y, |d, near| cell(near, true, d)),
    ];
    let title = "Step of a 32-bit float depth buffer over the distance";
    Ok(Map { title, x, y, panels, tolerance: 1e-4 })
}

/// Displacement of a point by a distant origin.
pub fn origin() -> Result<Map> {
    let x = Axis::ratios("world's origin away, m", 1.0, 1e9, 37);
    let y = Axis::ratios("distance of the point, m", 0.1, 1e4, 26);
    let direction = DVec3::new(0.353, 0.517, 0.779).normalize();
    let usual = |offset: f64, distance: f64| {
        let eye = DVec3::splat(offset / 3f64.sqrt());
        let point = eye + direction * distance;
        let relative = (point.as_vec3() - eye.as_vec3()).as_dvec3();
        Cell::of((relative - direction * distance).length() / distance)
    };
    let ours = |offset: f64, distance: f64| {
        let eye = DVec3::splat(offset / 3f64.sqrt());
        let camera = Camera::look_to(eye, DVec3::Y, DVec3::Z, 1.0, 1.6, 0.01);
        let rays = ViewRays::new(&camera, &DepthMapping { reversed: true, ..Default::default() });
        let Ok(rays) = rays else { return Cell::Refused };
        // Writes the host's point to its depth buffer and reads it back, as Welkin does.
        let point = camera.position + direction * distance;
        let local = point - camera.position;
        let view = camera.view.transform_vector3(local);
        let clip = camera.projection * view.extend(1.0);
        let ndc = DVec2::new(clip.x / clip.w, clip.y / clip.w);
        let back =
            rays.view_ray(ndc).direction.as_vec3() * rays.view_range(f64::from((clip.z / clip.w) as f32), ndc) as f32;
        Cell::of((back.as_dvec3() - local).length() / distance)
    };
    let panels = vec![
        Panel::of("usual: world coordinates in f32", false, &x, &y, usual),
        Panel::of("Welkin: camera-relative", true, &x, &y, ours),
    ];
    Ok(Map { title: "A far origin: misplacement of a point over its distance", x, y, panels, tolerance: 1e-4 })
}

/// Contrast by distance in fog, as drawn.
pub fn fog_distance(lab: &Lab, _options: &Options) -> Result<Map> {
    let x = Axis::ratios("distance, m", 0.5, 1e6, 43);
    let y = Axis::ratios("visibility, m", 1.0, 1e5, 26);
    let exact = |d: f64, v: f64| 0.05f64.powf(d / v);
    let mut drawn = Vec::new();
    for v in &y.values {
        drawn.extend(welkin::fog::probe(&lab.device, *v, &x.values)?);
    }
    let mut next = drawn.into_iter();
    let panels = vec![
        Panel::of("usual: exp(-(k d)^2)", false, &x, &y, |d, v| Cell::of(0.05f64.powf((d / v).powi(2)) - exact(d, v))),
        Panel::of("Welkin's layer, as drawn", true, &x, &y, |d, v| {
            next.next().map_or(Cell::NotFinite, |[contrast, _]| Cell::of(contrast - exact(d, v)))
        }),
    ];
    Ok(Map { title: "Contrast left in fog, absolute error", x, y, panels, tolerance: 1e-3 })
}
