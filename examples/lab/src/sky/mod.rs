//! Draws and times every way to draw a sky, and computes the truth.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use welkin::candidates::Method as LibraryMethod;
use welkin::gpu::Device;
use welkin::gpu::pass::{FullscreenDesc, draw, fullscreen};
use welkin::sky::probe::{Probe, Question, Ray};
use welkin::sky::reference::{Options as Truth, Reference, Resolution, View};
use welkin::sky::spectral::Conversion;
use welkin::sky::{Lamp, Observer, Planet, SkySettings, SkyTables, SkyVolume};
use welkin::{Result, Status};

use crate::candidates::{Candidate, Method};
use crate::picture::Picture;
use crate::scenes::{SkyAir, SkyScene};
use crate::timing::{target, timed};

pub mod elek;

/// Size of the pictures whose error is measured.
pub const SIZE: (u32, u32) = (64, 36);
/// Reflectance of the ground in these pictures.
const GROUND: f64 = 0.2;

/// A ray of a scene's picture, with the distance to the ground if the ray meets it.
#[derive(Clone, Copy, Debug)]
pub struct Pixel {
    pub direction: [f64; 3],
    pub ground_m: Option<f64>,
}

impl Pixel {
    fn ray(&self) -> Ray {
        Ray { direction: self.direction, distance_m: self.ground_m.unwrap_or(0.0) }
    }
}

/// The air along a pixel's ray: its radiance and its transmittance.
pub type Veil = ([f64; 3], [f64; 3]);

/// The rays of a scene, with the sun above the x axis.
pub fn pixels(scene: &SkyScene, size: (u32, u32)) -> Vec<Pixel> {
    let planet = scene.air.planet();
    let (sin_e, cos_e) = scene.elevation_deg.to_radians().sin_cos();
    let (sin_a, cos_a) = scene.azimuth_deg.to_radians().sin_cos();
    let forward = glam::DVec3::new(cos_e * cos_a, cos_e * sin_a, sin_e);
    let right = forward.cross(glam::DVec3::Z).normalize();
    let up = right.cross(forward);
    let half = (0.5 * scene.width_deg.to_radians()).tan();
    let (w, h) = (f64::from(size.0), f64::from(size.1));
    let mut out = Vec::new();
    for y in 0..size.1 {
        for x in 0..size.0 {
            let u = (2.0 * (f64::from(x) + 0.5) / w - 1.0) * half;
            let v = (1.0 - 2.0 * (f64::from(y) + 0.5) / h) * half * h / w;
            let direction = (forward + right * u + up * v).normalize();
            out.push(Pixel {
                direction: direction.to_array(),
                ground_m: to_ground(&planet, scene.altitude_m, direction.z),
            });
        }
    }
    out
}

/// Distance to the planet's ground along a ray.
fn to_ground(planet: &Planet, altitude_m: f64, mu: f64) -> Option<f64> {
    let c = altitude_m * (2.0 * planet.bottom_radius_m + altitude_m);
    let b = (planet.bottom_radius_m + altitude_m) * mu;
    let root = (b * b - c).sqrt();
    (mu < 0.0 && b * b > c).then(|| c / (root - b))
}

/// Combines the veils with a ground of radiance `ground` (per wavelength) to a picture.
pub fn compose(scene: &SkyScene, pixels: &[Pixel], veils: &[Veil], ground: [f64; 3], size: (u32, u32)) -> Picture {
    let planet = scene.air.planet();
    let colors = Conversion::per_channel();
    let texel = |(p, (light, through)): (&Pixel, &Veil)| {
        let behind = if p.ground_m.is_some() { ground } else { [0.0; 3] };
        let l: [f64; 3] = std::array::from_fn(|c| light[c] + through[c] * behind[c]);
        colors.rec709_of_radiance(&planet.wavelengths_nm, &l)
    };
    Picture { width: size.0, height: size.1, texels: pixels.iter().zip(veils).map(texel).collect() }
}

/// The truth of a scene.
pub struct TrueScene {
    pub picture: Picture,
    /// Radiance of the ground: the host's own colour, the same for all methods.
    pub ground: [f64; 3],
}

/// Computes the truth of all scenes with this air, or reads it from `out/lab` if it was computed before.
pub fn truth(scenes: &[SkyScene], air: SkyAir, size: (u32, u32), quick: bool) -> Result<Vec<TrueScene>> {
    let planet = air.planet();
    let resolution = if quick { Resolution::QUICK } else { Resolution::FINE };
    let options = Truth { disc_strips: 3, resolution, threads: 2, ..Default::default() };
    let mut solved: Option<Reference> = None;
    let mut out = Vec::new();
    for scene in scenes {
        let rays = pixels(scene, size);
        let path = kept_path(scene, &planet, size, quick);
        let numbers = match kept(&path, 6 * rays.len() + 3) {
            Some(n) => n,
            None => {
                if solved.is_none() {
                    eprintln!("  truth for {air:?} air ..");
                    solved = Some(Reference::solve(&planet, &options)?);
                }
                let Some(reference) = &solved else { continue };
                eprintln!("  truth of {} ..", scene.name);
                let numbers = compute(reference, scene, &rays)?;
                keep(&path, &numbers)?;
                numbers
            }
        };
        let ground = [numbers[0], numbers[1], numbers[2]];
        let veils: Vec<Veil> = numbers[3..].chunks_exact(6).map(|n| ([n[0], n[1], n[2]], [n[3], n[4], n[5]])).collect();
        out.push(TrueScene { picture: compose(scene, &rays, &veils, ground, size), ground });
    }
    Ok(out)
}

fn compute(reference: &Reference, scene: &SkyScene, rays: &[Pixel]) -> Result<Vec<f64>> {
    let sun_zenith = scene.sun_zenith_deg.to_radians();
    let light = reference.irradiance(0.0, sun_zenith)?;
    let mut out: Vec<f64> = (0..3).map(|c| GROUND / std::f64::consts::PI * (light.direct[c] + light.sky[c])).collect();
    let one = |p: &Pixel| {
        let [x, y, z] = p.direction;
        let view_zenith = z.clamp(-1.0, 1.0).acos();
        let view = View { altitude_m: scene.altitude_m, sun_zenith, view_zenith, azimuth: y.atan2(x) };
        match p.ground_m {
            Some(d) => reference.aerial(&view, d),
            None => reference.radiance(&view),
        }
    };
    let half = rays.len().div_ceil(2);
    let parts: Vec<_> = std::thread::scope(|s| {
        let workers: Vec<_> =
            rays.chunks(half).map(|part| s.spawn(move || part.iter().map(one).collect::<Result<Vec<_>>>())).collect();
        workers.into_iter().map(|w| w.join()).collect()
    });
    for part in parts {
        let fault = |_| welkin::Error::new(Status::Internal, "the truth's thread panicked".to_owned());
        for along in part.map_err(fault)?? {
            out.extend(along.radiance);
            out.extend(along.transmittance);
        }
    }
    Ok(out)
}

fn kept_path(scene: &SkyScene, planet: &Planet, size: (u32, u32), quick: bool) -> PathBuf {
    use std::hash::{Hash as _, Hasher as _};
    let mut h = std::hash::DefaultHasher::new();
    (planet.hash(), size, quick, format!("{scene:?}")).hash(&mut h);
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../out/lab");
    folder.join(format!("truth-{}-{:016x}.bin", scene.name, h.finish()))
}

fn kept(path: &PathBuf, count: usize) -> Option<Vec<f64>> {
    let bytes = std::fs::read(path).ok()?;
    let (numbers, rest) = bytes.as_chunks::<8>();
    (rest.is_empty() && numbers.len() == count).then(|| numbers.iter().map(|b| f64::from_le_bytes(*b)).collect())
}

fn keep(path: &Path, numbers: &[f64]) -> Result<()> {
    let io = |e: std::io::Error| crate::store::io(path, &e);
    if let Some(directory) = path.parent() {
        std::fs::create_dir_all(directory).map_err(io)?;
    }
    let bytes: Vec<u8> = numbers.iter().flat_map(|v| v.to_le_bytes()).collect();
    welkin_command_line::write_whole(path, &bytes)
}

/// One way to draw a sky, ready to run.
pub trait SkyDraw {
    /// Builds everything that depends on the planet; returns the time, s.
    fn rebuild(&mut self, planet: &Planet) -> Result<f64>;
    /// The air at every pixel.
    fn veils(&mut self, scene: &SkyScene, pixels: &[Pixel]) -> Result<Vec<Veil>>;
    /// Draws one frame and returns its time, ms. `step` counts frames; with `follows`, sun and altitude change with it.
    fn frame(&mut self, size: (u32, u32), step: usize, follows: bool) -> Result<f64>;
}

/// Prepares a candidate.
///
/// # Errors
/// GPU faults; a candidate that is not for the sky.
pub fn make(device: &Arc<Device>, candidate: &Candidate) -> Result<Box<dyn SkyDraw>> {
    match candidate.method {
        Method::Library(LibraryMethod::Sky(settings)) => Ok(Box::new(Library::new(device, &settings)?)),
        Method::Elek(table) => Ok(Box::new(elek::Elek::new(device, table)?)),
        _ => Err(welkin::Error::range("candidate", "one of the sky", candidate.name)),
    }
}

/// The library's sky.
pub struct Library {
    device: Arc<Device>,
    probe: Probe,
    volume: SkyVolume,
    pipeline: wgpu::RenderPipeline,
    camera: wgpu::BindGroup,
    target: Option<wgpu::Texture>,
}

impl Library {
    /// Makes tables and pipelines.
    ///
    /// # Errors
    /// GPU faults.
    pub fn new(device: &Arc<Device>, settings: &SkySettings) -> Result<Self> {
        let mut tables = SkyTables::new(device, settings)?;
        let planet = SkyAir::Clear.planet();
        build(device, &mut tables, &planet)?;
        let mut probe = Probe::with_tables(tables, &planet)?;
        let volume = SkyVolume::new(probe.tables())?;
        let layout = camera_layout(device);
        let desc = FullscreenDesc {
            shader: "sky/picture.wgsl",
            entry: "picture",
            layouts: &[&layout, volume.layout()],
            targets: &[wgpu::TextureFormat::Rgba16Float.into()],
            constants: &probe.tables().pipeline_constants(),
            samples: 1,
        };
        let pipeline = fullscreen(device, &desc)?;
        let camera = camera_group(device, &layout);
        Ok(Self { device: device.clone(), probe, volume, pipeline, camera, target: None })
    }
}

/// Builds a planet's tables; returns the time, s.
///
/// # Errors
/// GPU faults.
pub fn build(device: &Device, tables: &mut SkyTables, planet: &Planet) -> Result<f64> {
    // The tables are shared, and may be submitted before this function's own encoder.
    let start = std::time::Instant::now();
    let mut encoder = device.device.create_command_encoder(&Default::default());
    tables.update(&mut encoder, planet, 1.0)?;
    device.submit_and_wait(encoder)?;
    Ok(start.elapsed().as_secs_f64())
}

/// Layout of the picture's camera: one uniform.
pub fn camera_layout(device: &Device) -> wgpu::BindGroupLayout {
    device.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("lab camera"),
        entries: &[wgpu::BindGroupLayoutEntry {
            binding: 0,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Uniform,
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        }],
    })
}

/// A camera that looks along the x axis, 90 degrees wide, 16:9.
pub fn camera_group(device: &Device, layout: &wgpu::BindGroupLayout) -> wgpu::BindGroup {
    let buffer = device.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("lab camera"),
        size: 16,
        usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    device.queue.write_buffer(&buffer, 0, bytemuck::cast_slice(&[1.0f32, 0.0, 0.0, 360.0 / 640.0]));
    device.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("lab camera"),
        layout,
        entries: &[wgpu::BindGroupEntry { binding: 0, resource: buffer.as_entire_binding() }],
    })
}

/// Sun and observer of frame `step`.
pub fn moving(planet: &Planet, step: usize, follows: bool) -> Observer {
    let i = if follows { step as f64 } else { 0.0 };
    Observer::under_sun(planet, 500.0 + 10.0 * i, 1.2 + 0.004 * i)
}

/// A target of `size` in `slot`, created if there is none.
pub fn sized(slot: &mut Option<wgpu::Texture>, device: &Device, size: (u32, u32)) -> wgpu::TextureView {
    let fits = slot.take().filter(|t| (t.width(), t.height()) == size);
    let texture = fits.unwrap_or_else(|| target(device, size, wgpu::TextureFormat::Rgba16Float));
    slot.insert(texture).create_view(&Default::default())
}

impl SkyDraw for Library {
    fn rebuild(&mut self, planet: &Planet) -> Result<f64> {
        build(&self.device, self.probe.tables(), planet)
    }

    fn veils(&mut self, scene: &SkyScene, pixels: &[Pixel]) -> Result<Vec<Veil>> {
        let lamps = [Some(Lamp::sun_at_zenith_angle(&scene.air.planet(), scene.sun_zenith_deg.to_radians())), None];
        let observer = Observer { altitude_m: scene.altitude_m, lamps, refraction: 0.0, exact: true };
        let rays: Vec<Ray> = pixels.iter().map(Pixel::ray).collect();
        let sky = self.probe.ask(Question::Sky, &observer, &rays)?;
        let air = self.probe.ask(Question::Aerial, &observer, &rays)?;
        let veil = |((p, sky), air): ((&Pixel, _), _)| {
            let a: &welkin::sky::probe::Answer = if p.ground_m.is_some() { air } else { sky };
            (a.radiance.map(f64::from), a.transmittance.map(f64::from))
        };
        Ok(pixels.iter().zip(&sky).zip(&air).map(veil).collect())
    }

    fn frame(&mut self, size: (u32, u32), step: usize, follows: bool) -> Result<f64> {
        let planet = SkyAir::Clear.planet();
        let view = sized(&mut self.target, &self.device, size);
        let mut encoder = self.device.device.create_command_encoder(&Default::default());
        self.volume.prepare(&mut encoder, self.probe.tables(), &moving(&planet, step, follows))?;
        draw(&mut encoder, "sky", &self.pipeline, &[&self.camera, self.volume.bind_group()], &view);
        timed(&self.device, encoder)
    }
}
