//! The host's world: measured terrain, a road, posts at known distances, a simple excavator built from boxes.

use glam::{Vec2, Vec3};
use welkin::ground::SurfaceClass;

#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
pub struct Vertex {
    pub position: [f32; 3],
    pub normal: [f32; 3],
    pub albedo: [f32; 3],
    /// Number of the surface class.
    pub class: f32,
}

/// Distances of the posts along the road, m.
pub const POSTS_M: [f32; 8] = [50.0, 100.0, 200.0, 500.0, 1000.0, 2000.0, 5000.0, 10000.0];

/// Metres between the columns and rows of the terrain file (3 arc seconds at 36.59 N).
const SPACING: Vec2 = Vec2::new(74.4, 92.5);

pub struct Terrain {
    heights: Vec<f32>,
    size: (usize, usize),
}

impl Terrain {
    /// Reads 16-bit heights in metres; row 0 is the north edge.
    pub fn read(path: &str) -> Result<Self, Box<dyn std::error::Error>> {
        let picture = image::open(path)?.into_luma16();
        let size = (picture.width() as usize, picture.height() as usize);
        Ok(Self { heights: picture.pixels().map(|p| f32::from(p.0[0])).collect(), size })
    }

    fn position(&self, column: usize, row: usize) -> Vec3 {
        let (w, h) = (self.size.0 as f32 - 1.0, self.size.1 as f32 - 1.0);
        let xy = Vec2::new(column as f32 - 0.5 * w, 0.5 * h - row as f32) * SPACING;
        xy.extend(self.heights[row * self.size.0 + column])
    }

    /// Height at a point, bilinear, m.
    pub fn height(&self, at: Vec2) -> f32 {
        let (w, h) = (self.size.0 as f32 - 1.0, self.size.1 as f32 - 1.0);
        let x = (at.x / SPACING.x + 0.5 * w).clamp(0.0, w - 1e-3);
        let y = (0.5 * h - at.y / SPACING.y).clamp(0.0, h - 1e-3);
        let (c, r) = (x as usize, y as usize);
        let (fx, fy) = (x.fract(), y.fract());
        let z = |c: usize, r: usize| self.heights[r * self.size.0 + c];
        let top = z(c, r) * (1.0 - fx) + z(c + 1, r) * fx;
        let bottom = z(c, r + 1) * (1.0 - fx) + z(c + 1, r + 1) * fx;
        top * (1.0 - fy) + bottom * fy
    }

    fn mesh(&self, out: &mut Vec<Vertex>) {
        for row in 0..self.size.1 - 1 {
            for column in 0..self.size.0 - 1 {
                let p = [(0, 0), (0, 1), (1, 1), (0, 0), (1, 1), (1, 0)].map(|(c, r)| (column + c, row + r));
                for (c, r) in p {
                    let normal = self.normal(c, r);
                    let flat = (normal.z - 0.9).max(0.0) * 10.0;
                    let albedo = Vec3::new(0.10, 0.12, 0.05).lerp(Vec3::new(0.12, 0.15, 0.06), flat);
                    out.push(vertex(self.position(c, r), normal, albedo, SurfaceClass::Unspecified));
                }
            }
        }
    }

    fn normal(&self, c: usize, r: usize) -> Vec3 {
        let at = |c: usize, r: usize| self.position(c.min(self.size.0 - 1), r.min(self.size.1 - 1));
        let (e, n) = (at(c + 1, r) - at(c.saturating_sub(1), r), at(c, r.saturating_sub(1)) - at(c, r + 1));
        e.cross(n).normalize()
    }
}

fn vertex(position: Vec3, normal: Vec3, albedo: Vec3, class: SurfaceClass) -> Vertex {
    let [position, normal, albedo] = [position, normal, albedo].map(|v| v.to_array());
    Vertex { position, normal, albedo, class: f32::from(class as u8) }
}

/// An upright box that stands on `foot`.
fn cuboid(foot: Vec3, size: Vec3, albedo: Vec3, out: &mut Vec<Vertex>) {
    let centre = foot + Vec3::new(0.0, 0.0, 0.5 * size.z);
    for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
        for sign in [-1.0, 1.0] {
            let n = axis * sign;
            let u = Vec3::new(axis.z, axis.x, axis.y);
            let v = n.cross(u);
            let corner = |a: f32, b: f32| centre + 0.5 * size * (n + a * u + b * v);
            for (a, b) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
                out.push(vertex(corner(a, b), n, albedo, SurfaceClass::Building));
            }
        }
    }
}

/// The whole world as triangles in the host's axes (x east, y north, z up; metres above sea level), as seen from `eye`.
/// The road leads north from `eye`.
pub fn mesh(terrain: &Terrain, eye: Vec2) -> Vec<Vertex> {
    let mut out = Vec::new();
    terrain.mesh(&mut out);
    let ground = |at: Vec2| at.extend(terrain.height(at));
    for step in 0..400 {
        let y = step as f32 * 10.0 - 40.0;
        let ends = [(-3.0, y), (3.0, y), (3.0, y + 10.0), (-3.0, y), (3.0, y + 10.0), (-3.0, y + 10.0)];
        for (x, y) in ends {
            let p = ground(eye + Vec2::new(x, y)) + Vec3::new(0.0, 0.0, 0.3 + 0.002 * y.max(0.0));
            out.push(vertex(p, Vec3::Z, Vec3::splat(0.09), SurfaceClass::Paved));
        }
    }
    for d in POSTS_M {
        let size = Vec3::new(0.004, 0.004, 0.03) * d + Vec3::new(0.1, 0.1, 2.0);
        cuboid(ground(eye + Vec2::new(4.0 + 0.004 * d, d)), size, Vec3::splat(0.02), &mut out);
    }
    excavator(ground(eye + Vec2::new(-7.0, 24.0)), &mut out);
    out
}

fn excavator(foot: Vec3, out: &mut Vec<Vertex>) {
    let (yellow, dark) = (Vec3::new(0.6, 0.35, 0.03), Vec3::splat(0.04));
    for x in [-1.3, 1.3] {
        cuboid(foot + Vec3::new(x, 0.0, -0.3), Vec3::new(0.6, 4.0, 1.3), dark, out);
    }
    cuboid(foot + Vec3::new(0.0, -0.3, 1.2), Vec3::new(2.8, 3.4, 1.3), yellow, out);
    cuboid(foot + Vec3::new(-0.8, 0.8, 2.5), Vec3::new(1.1, 1.5, 1.2), dark, out);
    for i in 0..9 {
        let t = i as f32;
        let lift = if i < 5 { 1.8 + 0.6 * t } else { 4.2 - 0.7 * (t - 4.0) };
        cuboid(foot + Vec3::new(0.6, 1.6 + 0.6 * t, lift), Vec3::new(0.4, 0.7, 0.5), yellow, out);
    }
    cuboid(foot + Vec3::new(0.6, 7.0, 0.2), Vec3::new(1.2, 0.9, 0.9), dark, out);
}
