//! Smooth-shaded hills of large triangles, as a host without materials draws them, with the depth of its depth buffer.

use glam::{DMat4, DVec2, DVec3, DVec4};
use welkin::{
    frame::{Frame, FrameFlags, Stages},
    ground::{GroundGrid, SurfaceClass},
    scene::{Camera, DepthMapping, ViewRays},
};

use crate::host::{Host, SIZE, ndc};

/// Side of a triangle's square, m, and nodes along either side of the terrain.
pub const FACET_M: f64 = 75.0;
pub const NODES: u32 = 65;
const FAR_M: f64 = 12_000.0;

/// Height of the hills, m: smooth, 0 along a road that runs east at y = 300.
pub fn height(at: DVec2) -> f64 {
    let off_road = 1.0 - (-(at.y - 300.0).powi(2) / (2.0 * 150.0f64.powi(2))).exp();
    off_road * (35.0 * (at.x / 170.0 + 0.8).sin() * (at.y / 210.0).sin() + 40.0)
}

fn corner() -> DVec2 {
    DVec2::new(-0.5 * f64::from(NODES - 1) * FACET_M, -300.0)
}

/// Height of the triangles.
fn facets(at: DVec2) -> f64 {
    let p = (at - corner()) / FACET_M;
    let low = p.floor();
    let f = p - low;
    let h = |i: f64, j: f64| height(corner() + (low + DVec2::new(i, j)) * FACET_M);
    if f.x + f.y < 1.0 {
        h(0.0, 0.0) + f.x * (h(1.0, 0.0) - h(0.0, 0.0)) + f.y * (h(0.0, 1.0) - h(0.0, 0.0))
    } else {
        h(1.0, 1.0) + (1.0 - f.x) * (h(0.0, 1.0) - h(1.0, 1.0)) + (1.0 - f.y) * (h(1.0, 0.0) - h(1.0, 1.0))
    }
}

/// Returns the same ground as a grid that the host sets.
pub fn grid(class: impl Fn(DVec2) -> SurfaceClass) -> GroundGrid {
    let nodes =
        || (0..NODES * NODES).map(|i| corner() + DVec2::new(f64::from(i % NODES), f64::from(i / NODES)) * FACET_M);
    GroundGrid {
        origin: corner().extend(0.0),
        cell_m: FACET_M,
        nodes: [NODES; 2],
        heights_m: nodes().map(|at| height(at) as f32).collect(),
        classes: nodes().map(class).collect(),
    }
}

/// The normal that the host interpolates over its triangles.
pub fn normal(at: DVec2) -> DVec3 {
    let rise = |d: DVec2| (height(at + d) - height(at - d)) / (2.0 * FACET_M);
    DVec3::new(-rise(DVec2::X * FACET_M), -rise(DVec2::Y * FACET_M), 1.0).normalize()
}

/// A camera with the depth range of an engine that fits its near plane.
pub fn camera(eye: DVec3, elevation_deg: f64, near_m: f64) -> Camera {
    let aspect = f64::from(SIZE.0) / f64::from(SIZE.1);
    let look = crate::host::look(eye, 0.0, elevation_deg, 0.8);
    let focal = 1.0 / 0.4f64.tan();
    let depth = FAR_M / (near_m - FAR_M);
    let projection = DMat4::from_cols(
        DVec4::new(focal / aspect, 0.0, 0.0, 0.0),
        DVec4::new(0.0, focal, 0.0, 0.0),
        DVec4::new(0.0, 0.0, depth, -1.0),
        DVec4::new(0.0, 0.0, near_m * depth, 0.0),
    );
    Camera { projection, ..look }
}

pub const MAPPING: DepthMapping = DepthMapping {
    kind: welkin::scene::DepthKind::Perspective,
    reversed: false,
    clip: welkin::scene::ClipSpace::ZeroToOne,
};

/// Returns the point at which the ray of each pixel meets the triangles, if any.
pub fn hits(camera: &Camera) -> Vec<Option<DVec3>> {
    let rays = ViewRays::new(camera, &MAPPING).unwrap();
    let pixels = (0..SIZE.1).flat_map(|y| (0..SIZE.0).map(move |x| (x, y)));
    pixels.map(|(x, y)| hit(camera.position, rays.view_ray(ndc(x, y)).direction)).collect()
}

fn hit(eye: DVec3, d: DVec3) -> Option<DVec3> {
    let over = |t: f64| (eye + d * t).z - facets((eye + d * t).truncate());
    let mut t: f64 = 2.0;
    while t < 3500.0 {
        let next = t + (0.01 * t).max(1.0);
        if over(next) < 0.0 {
            let (mut low, mut high) = (t, next);
            for _ in 0..40 {
                let middle = 0.5 * (low + high);
                if over(middle) < 0.0 { high = middle } else { low = middle }
            }
            return Some(eye + d * high);
        }
        t = next;
    }
    None
}

/// Images of surfaces that the host gives beside colour and depth, and flags of the frame.
#[derive(Clone, Copy, Default)]
pub struct SurfaceImages<'a> {
    pub classes: Option<&'a wgpu::Texture>,
    pub normals: Option<&'a wgpu::Texture>,
    pub flags: u32,
}

/// The picture, 0 to 255 a channel as a display shows it. `albedo`: of a place of the ground.
pub fn shoot(
    host: &mut Host,
    camera: Camera,
    hits: &[Option<DVec3>],
    albedo: impl Fn(DVec2) -> [f64; 3],
    given: SurfaceImages<'_>,
) -> Vec<[f64; 3]> {
    let light = host.context.scene_at(camera.position, host.context.time_s()).unwrap();
    let color = |p: &DVec3| {
        let n = normal(p.truncate());
        let of_lamp = n.dot(light.brighter().apparent).max(0.0);
        let lux = |c: usize| light.ground.sun_lux[c] * of_lamp + light.ground.sky_lux[c] * (0.5 + 0.5 * n.z);
        let a = albedo(p.truncate());
        [0, 1, 2].map(|c| a[c] * lux(c) / std::f64::consts::PI)
    };
    let rays = ViewRays::new(&camera, &MAPPING).unwrap();
    let mut depths = Vec::new();
    let mut colors = Vec::new();
    for (i, hit) in hits.iter().enumerate() {
        let at = ndc(i as u32 % SIZE.0, i as u32 / SIZE.0);
        depths.push(hit.map_or(1.0, |p| rays.depth_at((p - camera.position).length(), at)));
        let c = hit.as_ref().map_or([0.0; 3], color);
        colors.push([c[0] as f32, c[1] as f32, c[2] as f32, 1.0]);
    }
    host.write(&colors);
    let depth = host.depth_24(&depths);
    let frame = Frame {
        depth_mapping: MAPPING,
        surface_classes: given.classes,
        normals: given.normals,
        flags: FrameFlags(given.flags),
        ..Frame::new(host.next_frame(), camera, &host.color, Some(&depth))
    };
    host.view.record(&host.context, &frame, Stages::SURFACE.with(Stages::TONE)).unwrap();
    host.pixels().iter().map(|p| [p[0], p[1], p[2]].map(|v| 255.0 * encoded(f64::from(v)))).collect()
}

fn encoded(v: f64) -> f64 {
    let v = v.clamp(0.0, 1.0);
    if v <= 0.003_130_8 { 12.92 * v } else { 1.055 * v.powf(1.0 / 2.4) - 0.055 }
}

/// Writes a picture to look at, if the environment names a folder.
pub fn save(name: &str, pixels: &[[f64; 3]]) {
    let Ok(folder) = std::env::var("WELKIN_PICTURES") else { return };
    let bytes = pixels.iter().flat_map(|p| p.map(|v| v.round() as u8)).collect::<Vec<_>>();
    let path = std::path::Path::new(&folder).join(format!("{name}.png"));
    image::save_buffer(path, &bytes, SIZE.0, SIZE.1, image::ExtendedColorType::Rgb8).unwrap();
}
