//! The glow on the GPU: a sphere of directions with zodiacal light and starlight at its corners. The shader adds
//! airglow and air.

use bytemuck::Zeroable as _;
use glam::{DMat3, DVec3, Vec3};

use super::{
    galaxy::{equator_to_galactic, unresolved_s10},
    glow::{NightSky, S10_CD_M2, equator_to_sun_ecliptic, zodiacal_toward},
    uniforms::StarView,
};
use crate::{
    almanac::celestial::equatorial_direction,
    error::Result,
    gpu::{
        Device,
        bind::{self, Slot},
        pass::{self, MeshDesc},
    },
};

/// Galactic latitudes of the sphere's rows from the equator northwards, degrees, and the number of columns that the
/// side of a patch (an area between two rows) spans in the row. There are few rows, because a software driver spends
/// time on every edge. More than 30 degrees from the sun, 95 % of the triangles differ in their middle from the tables
/// by less than 3 % of the glow.
const RINGS: [(f64, usize); 15] = [
    (0.0, 1),
    (1.0, 1),
    (3.0, 1),
    (5.0, 1),
    (8.0, 1),
    (12.5, 1),
    (18.0, 1),
    (24.0, 1),
    (31.0, 1),
    (38.0, 1),
    (46.0, 1),
    (55.0, 2),
    (66.0, 2),
    (78.0, 4),
    (90.0, 4),
];
/// Number of rows of the sphere, from the south galactic pole to the north one.
const ROWS: usize = 2 * RINGS.len() - 1;
/// Number of corners in a row. The last one has the same direction as the first.
const COLUMNS: usize = 49;
/// Angle that the sun moves before the zodiacal light is computed again, rad: six hours.
const STALE_RAD: f64 = 0.0044;
/// Upper limit of [`NightSky::layer_ratio2`], which keeps the shader from dividing by 0 for an eye in the airglow
/// layer. An eye reaches the limit 3.2 km below the layer, where 32 % of the airglow is left. Above that height the
/// brightening towards the horizon stays as it is at the limit.
const MOST_LAYER_RATIO2: f64 = 0.999;

/// A corner of the sphere.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct Corner {
    /// Unit vector in J2000.0.
    direction: [f32; 3],
    /// Zodiacal light and starlight, S10.
    s10: [f32; 2],
}

/// Mirrors `GlowUniform` of `shaders/stars/glow.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
struct GlowUniform {
    clip: [[f32; 4]; 4],
    to_world: [[f32; 4]; 3],
    zodiacal: [f32; 3],
    layer_ratio2: f32,
    starlight: [f32; 3],
    y_sign: f32,
    airglow: [f32; 3],
    pad0: f32,
    lit_air: [f32; 3],
    pad1: f32,
    base: [f32; 3],
    pad2: f32,
    zenith_power: [f32; 3],
    pad3: f32,
}

/// Mix of the glow in twilight: luminance of the even sky, cd/m^2 a channel, and the share of the glow, 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Dusk {
    pub cd_m2: [f64; 3],
    pub share: f64,
}

/// GPU resources that a view holds for the glow.
pub(super) struct GlowPass {
    block: wgpu::Buffer,
    corners: wgpu::Buffer,
    indices: wgpu::Buffer,
    group: wgpu::BindGroup,
    pipeline: wgpu::RenderPipeline,
    /// Direction of the sun in J2000.0 for which the corners' zodiacal light was computed.
    sun: Option<DVec3>,
    triangles: VisibleTriangles,
    written: Option<GlowUniform>,
}

/// The sphere's triangles that a picture may show. Most triangles are outside the picture, and a software driver spends
/// time on each one that is submitted.
struct VisibleTriangles {
    /// Directions of the sphere's corners, in J2000.0.
    directions: Vec<Vec3>,
    all: Vec<[u16; 3]>,
    /// Bit mask for each corner: the sides of the picture beyond which it lies.
    beyond: Vec<u8>,
    /// Corner indices of the triangles that may show. If their number is odd one more is added, because uploads are
    /// multiples of four bytes.
    shown: Vec<u16>,
    /// Number of indices without the added one.
    count: u32,
}

impl VisibleTriangles {
    fn new(directions: Vec<Vec3>, all: Vec<[u16; 3]>) -> Self {
        let (beyond, shown) = (vec![0; directions.len()], Vec::with_capacity(3 * all.len() + 1));
        Self { directions, all, beyond, shown, count: 0 }
    }

    /// Finds the triangles that a picture may show. A triangle is left out if all its corners lie beyond the same side
    /// of the picture.
    fn find(&mut self, view: &StarView<'_>) {
        let rows = [0, 1, 3].map(|i| (view.heavens.to_world.transpose() * view.clip.row(i).truncate()).as_vec3());
        for (beyond, direction) in self.beyond.iter_mut().zip(&self.directions) {
            let [x, y, w] = rows.map(|row| row.dot(*direction));
            *beyond = [x > w, -x > w, y > w, -y > w].into_iter().fold(0, |bits, out| 2 * bits + u8::from(out));
        }
        self.shown.clear();
        for triangle in &self.all {
            if triangle.iter().fold(15, |bits, corner| bits & self.beyond[usize::from(*corner)]) == 0 {
                self.shown.extend(triangle);
            }
        }
        self.count = self.shown.len() as u32;
        if self.shown.len() % 2 == 1 {
            self.shown.push(0);
        }
    }
}

impl GlowPass {
    /// Creates the resources for targets of `format` with one sample a pixel.
    ///
    /// # Errors
    /// Fails if a shader file is missing; GPU faults come through [`Device::check`].
    pub fn new(device: &Device, format: wgpu::TextureFormat) -> Result<Self> {
        use wgpu::BufferUsages as U;
        let buffer = |label, size: usize, usage| {
            device.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size: size as u64,
                usage: usage | U::COPY_DST,
                mapped_at_creation: false,
            })
        };
        let block = buffer("glow", size_of::<GlowUniform>(), U::UNIFORM);
        let list = indices();
        let indices = buffer("glow", (size_of::<u16>() * list.len()).next_multiple_of(4), U::INDEX);
        let directions = corners(DVec3::X).iter().map(|corner| Vec3::from_array(corner.direction)).collect();
        let triangles = VisibleTriangles::new(directions, list.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect());
        let corners = buffer("glow", size_of::<Corner>() * ROWS * COLUMNS, U::VERTEX);
        let slots = [(0, Slot::Uniform(size_of::<GlowUniform>()))];
        let layout = bind::layout(&device.device, "glow", wgpu::ShaderStages::VERTEX_FRAGMENT, &slots);
        let group = device.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("glow"),
            layout: &layout,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: block.as_entire_binding() }],
        });
        let pipeline = pipeline(device, &layout, format)?;
        Ok(Self { block, corners, indices, group, pipeline, sun: None, triangles, written: None })
    }

    /// Uploads the data to draw `sky` as `view` sees it. Returns whether the draw differs from the last one.
    pub fn prepare(&mut self, device: &Device, sky: &NightSky, view: &StarView<'_>, dusk: &Dusk) -> bool {
        let sun = view.heavens.sun;
        let is_stale = self.sun.is_none_or(|s| s.angle_between(sun) > STALE_RAD);
        if is_stale {
            self.sun = Some(sun);
            device.write_buffer(&self.corners, 0, bytemuck::cast_slice(&corners(sun)));
        }
        let column = |i: usize| view.heavens.to_world.col(i).as_vec3().extend(0.0).to_array();
        let units = |light: [f64; 3], factor: f64| light.map(|v| (v * view.scale * factor) as f32);
        let night = |s10: f64, light: [f64; 3]| units(light, S10_CD_M2 * s10 * dusk.share);
        let [airglow, zodiacal, starlight] = sky.colors;
        let lit_air = units(sky.lit_air, dusk.share);
        let day = units(dusk.cd_m2, 1.0 - dusk.share);
        let block = GlowUniform {
            clip: view.clip.as_mat4().to_cols_array_2d(),
            to_world: [column(0), column(1), column(2)],
            zodiacal: night(1.0, zodiacal),
            layer_ratio2: sky.layer_ratio2().min(MOST_LAYER_RATIO2) as f32,
            starlight: night(1.0, starlight),
            y_sign: view.y_sign,
            airglow: night(sky.airglow_s10(), airglow),
            lit_air,
            base: [0, 1, 2].map(|k| day[k] + lit_air[k]),
            zenith_power: sky.zenith_depth.map(|d| (-d * std::f64::consts::LOG2_E) as f32),
            ..GlowUniform::zeroed()
        };
        if self.written == Some(block) {
            return is_stale;
        }
        self.written = Some(block);
        device.write_buffer(&self.block, 0, bytemuck::bytes_of(&block));
        self.triangles.find(view);
        device.write_buffer(&self.indices, 0, bytemuck::cast_slice(&self.triangles.shown));
        true
    }

    /// Draws the prepared glow and overwrites the target. Sets group 0, vertex buffer 0 and the index buffer.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.group, &[]);
        pass.set_vertex_buffer(0, self.corners.slice(..));
        pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint16);
        pass.draw_indexed(0..self.triangles.count, 0, 0..1);
    }

    /// Size on the GPU, bytes.
    pub fn bytes(&self) -> u64 {
        self.block.size() + self.corners.size() + self.indices.size()
    }
}

/// Latitude of a row, degrees, and the number of columns that a side of its patches spans.
fn ring(row: usize) -> (f64, usize) {
    let equator = RINGS.len() - 1;
    let (latitude, span) = RINGS[row.abs_diff(equator)];
    (if row < equator { -latitude } else { latitude }, span)
}

/// Corners of the sphere for a direction of the sun, row by row.
fn corners(sun: DVec3) -> Vec<Corner> {
    let to_equator: DMat3 = equator_to_galactic().transpose();
    let to_sun = equator_to_sun_ecliptic(sun);
    let corner = |i: usize| {
        let longitude = (i % COLUMNS) as f64 * 360.0 / (COLUMNS - 1) as f64;
        let galactic = equatorial_direction(longitude, ring(i / COLUMNS).0);
        let direction = to_equator * galactic;
        let s10 = [zodiacal_toward(to_sun * direction), unresolved_s10(galactic)];
        Corner { direction: direction.as_vec3().to_array(), s10: s10.map(|v| v as f32) }
    };
    (0..ROWS * COLUMNS).map(corner).collect()
}

/// Triangles between neighbouring rows. Where one row has fewer corners, each side of a patch in this row meets several
/// triangles of the other row, so that there is no gap.
fn indices() -> Vec<u16> {
    let at = |row: usize, column: usize| (row * COLUMNS + column) as u16;
    let mut list = Vec::new();
    for row in 0..ROWS - 1 {
        let (wide, fine) = if ring(row).1 > ring(row + 1).1 { (row, row + 1) } else { (row + 1, row) };
        let [span, step] = [wide, fine].map(|row| ring(row).1);
        for first in (0..COLUMNS - 1).step_by(span) {
            let end = first + span;
            list.extend([at(wide, first), at(wide, end), at(fine, end)]);
            (first..end).step_by(step).for_each(|c| list.extend([at(wide, first), at(fine, c), at(fine, c + step)]));
        }
    }
    list
}

fn pipeline(
    device: &Device,
    layout: &wgpu::BindGroupLayout,
    format: wgpu::TextureFormat,
) -> Result<wgpu::RenderPipeline> {
    let attributes = wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x2];
    let desc = MeshDesc {
        shader: "stars/glow.wgsl",
        vertex: "glow_vertex",
        fragment: "glow_fragment",
        layouts: &[Some(layout)],
        vertices: wgpu::VertexBufferLayout {
            array_stride: size_of::<Corner>() as u64,
            step_mode: wgpu::VertexStepMode::Vertex,
            attributes: &attributes,
        },
        format,
    };
    pass::mesh(device, &desc)
}

#[cfg(test)]
mod tests {
    use glam::DMat4;

    use super::*;
    use crate::{
        almanac::{Utc, celestial::direction},
        gpu::shader::assert_layout,
        scene::{Camera, DepthMapping, Place, ViewRays},
        stars::{Heavens, StarSettings},
    };

    /// Compares the sphere with the tables. At 30 degrees from the sun the zodiacal light halves within 10 degrees.
    #[test]
    fn between_its_corners_the_ball_glows_as_the_tables_say() {
        let sun = DVec3::X;
        let (corners, to_galactic, to_sun) = (corners(sun), equator_to_galactic(), equator_to_sun_ecliptic(sun));
        let mut off = Vec::new();
        for triangle in indices().chunks(3) {
            let [a, b, c] = [0, 1, 2].map(|i| corners[usize::from(triangle[i])]);
            let mean = |of: fn(&Corner) -> DVec3| (of(&a) + of(&b) + of(&c)) / 3.0;
            let middle = mean(|corner| DVec3::from_array(corner.direction.map(f64::from))).normalize_or_zero();
            if middle.angle_between(sun) < 0.52 || middle == DVec3::ZERO {
                continue;
            }
            let drawn = mean(|corner| DVec3::new(corner.s10[0].into(), corner.s10[1].into(), 0.0));
            let wanted = zodiacal_toward(to_sun * middle) + unresolved_s10(to_galactic * middle);
            off.push(((drawn.x + drawn.y - wanted) / (wanted + 145.0)).abs());
        }
        off.sort_by(f64::total_cmp);
        let (usual, most) = (off[off.len() * 95 / 100], off[off.len() - 1]);
        println!("of the glow over airglow straight up: 95 % within {usual:.4}, all within {most:.4}");
        assert!(usual < 0.03 && most < 0.15, "{usual} {most}");
    }

    /// Each ray of a picture meets one of the triangles found for that picture, wherever the camera looks.
    #[test]
    fn triangles_that_a_picture_shows_are_kept_and_most_others_are_not() {
        let place = Place { latitude_deg: 50.0, longitude_deg: 10.0, altitude_m: 0.0 };
        let heavens = Heavens::at(Utc(1.7e9), &place, &StarSettings::default()).unwrap();
        let directions = corners(DVec3::X).iter().map(|c| Vec3::from_array(c.direction)).collect();
        let mut triangles =
            VisibleTriangles::new(directions, indices().chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect());
        for (azimuth, elevation) in [(0.0, 5.0), (100.0, 40.0), (190.0, 89.0), (280.0, -20.0), (350.0, 60.0)] {
            let camera = Camera::look_to(DVec3::ZERO, direction(azimuth, elevation), DVec3::Z, 1.0, 16.0 / 9.0, 0.1);
            let mapping = DepthMapping { reversed: true, ..Default::default() };
            let rays = ViewRays::new(&camera, &mapping).unwrap();
            let view = StarView {
                heavens: &heavens,
                clip: camera.projection * DMat4::from_mat3(camera.rotation()),
                rays: &rays,
                size: [160, 90],
                y_sign: 1.0,
                zenith_depth: [0.1; 3],
                transmittance: 1.0,
                air_density: 1.0,
                horizon_deg: 0.0,
                scale: 1.0,
                faintest_lux: 0.0,
            };
            triangles.find(&view);
            let kept = &triangles.shown[..triangles.count as usize];
            assert!(kept.len() < 3 * triangles.all.len() / 3, "{} of {}", kept.len() / 3, triangles.all.len());
            let to_sphere = (view.clip * DMat4::from_mat3(heavens.to_world)).inverse();
            for i in 0..40 {
                let at = DVec3::new(f64::from(i % 8) / 3.6 - 0.97, f64::from(i / 8) / 2.1 - 0.95, 0.5);
                let ray = to_sphere.project_point3(at).as_vec3();
                let is_met = kept.chunks_exact(3).any(|t| {
                    let [a, b, c] = [0, 1, 2].map(|k| triangles.directions[usize::from(t[k])]);
                    let sides = [a.cross(b), b.cross(c), c.cross(a)].map(|n| n.dot(ray));
                    // The triangle may be seen from inside or outside, and may be missed by a rounding error at an
                    // edge. It must not be on the other side of the sphere.
                    let is_inside = sides.iter().all(|s| *s > -1e-6) || sides.iter().all(|s| *s < 1e-6);
                    is_inside && (a + b + c).dot(ray) > 0.0
                });
                assert!(is_met, "{azimuth} {elevation}: nothing at {at}");
            }
        }
    }

    #[test]
    fn offsets_agree_with_the_shader() {
        assert_layout!(
            "stars/glow.wgsl",
            "GlowUniform",
            GlowUniform,
            [clip, to_world, zodiacal, layer_ratio2, starlight, y_sign, airglow, lit_air, base, zenith_power]
        );
    }
}
