//! Measures the drawn clouds alone: `probe slab`. Light and march are those of the picture
//! (`shaders/clouds/light.wgsl`, `march.wgsl`); the cloud is a uniform box of droplets.

use std::sync::Arc;

use std::f64::consts::PI;

use bytemuck::Zeroable as _;
use glam::DVec3;

use super::{
    tables::{LightTables, sampler},
    uniforms::{CloudsUniform, LayerUniform, MediumUniform},
};
use crate::{
    clouds::light::{
        lamps::{CloudLampUniform, LampsUniform},
        transport::{Scattering, Transport},
    },
    error::{Result, check_range},
    gpu::{
        Device,
        bind::{self, Slot},
        flat_texture,
        pass::{self, FullscreenDesc},
        readback,
    },
    light::{Phase, PhaseLobes},
    scene::LightUniform,
};

/// Number of rays for each face, along each side of its tile of the target.
const SIDE: u32 = 64;
/// Thickness of the box, m.
const THICKNESS_M: f64 = 10.0;
/// Width of a slab in thicknesses, so large that no light comes from the sides.
const WIDE: f64 = 1e6;

/// A box of uniform cloud under a sun.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EvenCloud {
    /// Optical depths from side to side (x, y), and from top to base, [0, 1000]. x and y are infinite for a slab.
    pub depths: [f64; 3],
    /// Asymmetry parameter of its droplets (Henyey and Greenstein 1941), [0, 0.95].
    pub asymmetry: f64,
    /// Single-scattering albedo, [0, 1].
    pub albedo: f64,
    /// Cosine of the sun's zenith angle, [0.01, 1]. The sun stands on the side of low x.
    pub cosine: f64,
}

impl EvenCloud {
    /// Checks that every field with a range is in it. Optical depths from side to side are not checked.
    fn check(&self) -> Result<()> {
        check_range("tau", self.depths[2], 0.0, 1e3, "")?;
        check_range("g", self.asymmetry, 0.0, 0.95, "")?;
        check_range("mu0", self.cosine, 0.01, 1.0, "")?;
        check_range("albedo", self.albedo, 0.0, 1.0, "")
    }

    /// Whether the cloud is a slab, which has no sides.
    fn is_slab(&self) -> bool {
        self.depths[0].is_infinite()
    }

    /// Returns the block of the cloud for shaders.
    fn uniform(&self, scattering: &Scattering) -> CloudsUniform {
        let [x, y, z] = self.depths;
        let side = |depth: f64| if self.is_slab() { WIDE * THICKNESS_M } else { depth / z * THICKNESS_M };
        let mut uniform = CloudsUniform::zeroed();
        uniform.to_sun = [-(1.0 - self.cosine * self.cosine).sqrt() as f32, 0.0, self.cosine as f32];
        uniform.layer_count = 1;
        uniform.media = [MediumUniform::new(scattering); 2];
        uniform.layers[0] = LayerUniform {
            size: [0.0, 1.0 / THICKNESS_M as f32, 1.0, (z / THICKNESS_M) as f32],
            sheets: [side(x) as f32, side(y) as f32, 0.0, 0.0],
            sun: [1.0; 4],
            medium: [0.0, scattering.scale() as f32, 0.0, 0.0],
            ..LayerUniform::zeroed()
        };
        uniform
    }
}

/// Returns the share of the light on a box that leaves through each face: low and high x, low and high y, base and top.
/// The share includes light that is not scattered or is scattered straight on. A slab has base and top only.
///
/// # Errors
/// [`crate::Status::InvalidArgument`] naming the parameter; GPU faults.
pub fn fluxes(device: &Device, cloud: &EvenCloud) -> Result<[f64; 6]> {
    cloud.check()?;
    let lobes = PhaseLobes::new(&Phase::HenyeyGreenstein { g: cloud.asymmetry });
    let of = Scattering::new(lobes, cloud.albedo);
    if cloud.depths[2] == 0.0 {
        return Ok([0.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    }
    let mut out = draw(device, cloud, &of, None)?;
    let (sine, cosine) = ((1.0 - cloud.cosine * cloud.cosine).sqrt(), cloud.cosine);
    let sides = cloud.depths;
    if cloud.is_slab() {
        out = [0.0, 0.0, 0.0, 0.0, out[4] / cosine + (-sides[2] / cosine).exp(), out[5] / cosine];
        return Ok(out);
    }
    let areas = [sides[1] * sides[2], sides[0] * sides[2], sides[0] * sides[1]];
    let falls = cosine * areas[2] + sine * areas[0];
    for (face, flux) in out.iter_mut().enumerate() {
        *flux *= areas[face / 2] / falls;
    }
    let (far, base) = straight(sides, sine, cosine);
    out[1] += far * sides[1] / falls;
    out[4] += base * sides[1] / falls;
    Ok(out)
}

/// Returns the unscattered light of a beam on a box that leaves through the far side (high x), and through the base,
/// per unit of the box's depth along y. Lengths are optical depths.
fn straight([x, _, z]: [f64; 3], sine: f64, cosine: f64) -> (f64, f64) {
    let steps = 4096;
    let (mut far, mut base) = (0.0, 0.0);
    for i in 0..steps {
        let at = (f64::from(i) + 0.5) / f64::from(steps);
        for (falls, across, down) in [(cosine * x, at * x, 0.0), (sine * z, 0.0, at * z)] {
            let to_base = (z - down) / cosine;
            let to_far = if sine > 1e-9 { (x - across) / sine } else { f64::INFINITY };
            let left = falls / f64::from(steps) * (-to_base.min(to_far)).exp();
            *if to_far < to_base { &mut far } else { &mut base } += left;
        }
    }
    (far, base)
}

/// Returns the scattered light that leaves each face of a box, per unit of area, for a lamp that sends 1 cd in all
/// directions. The unit of length is optical depth 1. `position` is measured from the box's low corner. Faces are
/// ordered as in [`fluxes`].
///
/// # Errors
/// Errors of [`fluxes`].
pub fn lamp_fluxes(device: &Device, cloud: &EvenCloud, position: DVec3) -> Result<[f64; 6]> {
    cloud.check()?;
    let lobes = PhaseLobes::new(&Phase::HenyeyGreenstein { g: cloud.asymmetry });
    let of = Scattering::new(lobes, cloud.albedo);
    let unit_m = THICKNESS_M / cloud.depths[2];
    let mut lamps = LampsUniform { count: 1, ..LampsUniform::zeroed() };
    lamps.lamps[0] = CloudLampUniform {
        light: LightUniform {
            position: (position * unit_m).as_vec3().to_array(),
            direction: [0.0, 0.0, 1.0],
            end: -2.0,
            // Intensity in units of length instead of metres.
            intensity: [(unit_m * unit_m) as f32; 3],
            steepness: 1.0,
            pad: 0.0,
        },
        even: 1.0,
        ..CloudLampUniform::zeroed()
    };
    draw(device, cloud, &of, Some(&lamps))
}

/// Draws the box and returns the light that leaves each face, per unit of area.
fn draw(device: &Device, cloud: &EvenCloud, scattering: &Scattering, lamps: Option<&LampsUniform>) -> Result<[f64; 6]> {
    let gpu = &device.device;
    let target = flat_texture(
        gpu,
        "cloud probe",
        (6 * SIDE, SIDE),
        wgpu::TextureFormat::Rgba16Float,
        wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
    );
    let medium = Arc::new(Transport::new(*scattering));
    let mut tables = LightTables::new(device, [medium.clone(), medium]);
    tables.update(device, cloud.cosine);
    let block = bind::block(gpu, "cloud probe", size_of::<CloudsUniform>());
    device.queue.write_buffer(&block, 0, bytemuck::bytes_of(&cloud.uniform(scattering)));
    let of_lamps = bind::block(gpu, "cloud probe", size_of::<LampsUniform>());
    device.queue.write_buffer(&of_lamps, 0, bytemuck::bytes_of(lamps.unwrap_or(&LampsUniform::zeroed())));
    let slots = [
        (1, Slot::Uniform(size_of::<CloudsUniform>())),
        (4, Slot::FilteredVolume),
        (6, Slot::Sampler),
        (11, Slot::Uniform(size_of::<LampsUniform>())),
    ];
    let layout = bind::layout(gpu, "cloud probe", wgpu::ShaderStages::FRAGMENT, &slots);
    let pipeline = pass::fullscreen(
        device,
        &FullscreenDesc {
            shader: if lamps.is_some() { "clouds/probe.wgsl:box:lamps" } else { "clouds/probe.wgsl:box" },
            entry: "box_probe",
            layouts: &[&layout],
            targets: &[wgpu::TextureFormat::Rgba16Float.into()],
            // Follow every ray to its end.
            constants: &[
                ("CLOUD_STEPS", 1024.0),
                ("CLOUD_STEP_DEPTH", 0.2),
                ("CLOUD_LEAST", 1e-4),
                ("CLOUD_STEP_ANGLE", 0.0),
            ],
            samples: 1,
        },
    )?;
    let (view, sampler) = (tables.view(), sampler(device, wgpu::AddressMode::ClampToEdge));
    let group = gpu.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("cloud probe"),
        layout: &layout,
        entries: &[
            wgpu::BindGroupEntry { binding: 1, resource: block.as_entire_binding() },
            wgpu::BindGroupEntry { binding: 4, resource: wgpu::BindingResource::TextureView(&view) },
            wgpu::BindGroupEntry { binding: 6, resource: wgpu::BindingResource::Sampler(&sampler) },
            wgpu::BindGroupEntry { binding: 11, resource: of_lamps.as_entire_binding() },
        ],
    });
    let mut encoder = gpu.create_command_encoder(&Default::default());
    pass::draw(&mut encoder, "cloud probe", &pipeline, &[&group], &target.create_view(&Default::default()));
    device.submit_and_wait(encoder)?;
    let mut sums = [0.0; 6];
    for (i, texel) in readback::rgba(device, &target)?.iter().enumerate() {
        sums[i % (6 * SIDE as usize) / SIDE as usize] += f64::from(texel[0]);
    }
    // The mean radiance times pi is the flux through a unit of the face.
    Ok(sums.map(|s| s / f64::from(SIDE * SIDE) * PI))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        clouds::{light::lamp_light, reference::tests::even},
        gpu::DeviceOptions,
    };

    fn slab(device: &Device, tau: f64, albedo: f64, cosine: f64) -> [f64; 2] {
        let depths = [f64::INFINITY, f64::INFINITY, tau];
        let flux = fluxes(device, &EvenCloud { depths, asymmetry: 0.85, albedo, cosine }).unwrap();
        [flux[5], flux[4]]
    }

    /// Compared with discrete ordinates (PythonicDISORT), Henyey-Greenstein g = 0.85.
    #[test]
    fn drawn_slabs_reflect_and_let_through_what_discrete_ordinates_say() {
        let device = Device::headless(&DeviceOptions::default()).expect("a software driver is installed");
        let near = |got: f64, want: f64| (got - want).abs() < (0.05 * want).max(0.01);
        for (tau, overhead, low) in
            [(1.0, 0.04232, 0.16488), (4.0, 0.19092, 0.41602), (16.0, 0.55721, 0.69740), (64.0, 0.84628, 0.89497)]
        {
            for (cosine, want) in [(1.0, overhead), (0.5, low)] {
                let [r, t] = slab(&device, tau, 1.0, cosine);
                println!(
                    "depth {tau}, cosine {cosine}: R {r:.4} ({want}), T {t:.4} ({:.4}), sum {:.4}",
                    1.0 - want,
                    r + t
                );
                assert!(near(r, want) && near(t, 1.0 - want), "{tau} {cosine}: {r} {t}");
                assert!(r + t < 1.01, "{tau} {cosine}: light is made, {}", r + t);
            }
        }
        for (tau, reflected, diffuse) in
            [(1.0, 0.04079, 0.57960), (4.0, 0.17284, 0.74785), (16.0, 0.41773, 0.30610), (64.0, 0.47197, 0.01134)]
        {
            let [r, t] = slab(&device, tau, 0.99, 1.0);
            let through = diffuse + f64::exp(-tau);
            println!("depth {tau}, albedo 0.99: R {r:.4} ({reflected}), T {t:.4} ({through:.4})");
            assert!(near(r, reflected) && near(t, through), "{tau}: {r} {t}");
        }
    }

    /// Compared with the model in f64.
    #[test]
    fn drawn_cubes_glow_as_the_model_of_lamps_has_it() {
        let device = Device::headless(&DeviceOptions::default()).expect("a software driver is installed");
        let cloud = EvenCloud { depths: [16.0; 3], asymmetry: 0.85, albedo: 1.0, cosine: 1.0 };
        for position in [DVec3::splat(8.0), DVec3::new(3.0, 8.0, 8.0), DVec3::new(8.0, 8.0, -8.0)] {
            let got = lamp_fluxes(&device, &cloud, position).unwrap();
            let want = lamp_light::tests::modelled_faces(16.0, position);
            println!("lamp at {position}: {got:.6?}, model {want:.6?}");
            for (got, want) in got.into_iter().zip(want) {
                assert!((got / want - 1.0).abs() < 0.05, "{position}: {got} not {want}");
            }
        }
    }

    /// Compared with photons traced through the same cubes.
    #[test]
    fn drawn_cubes_send_through_each_face_what_photons_say() {
        let device = Device::headless(&DeviceOptions::default()).expect("a software driver is installed");
        for (depth, cosine) in [(16.0, 1.0), (16.0, 0.5), (4.0, 0.5), (16.0, 0.8), (48.0, 0.5)] {
            let cloud = EvenCloud { depths: [depth; 3], asymmetry: 0.85, albedo: 1.0, cosine };
            let got = fluxes(&device, &cloud).unwrap();
            let want = even(DVec3::splat(depth), 0.85, 1.0, cosine, 100_000);
            println!(
                "cube of {depth}, cosine {cosine}: {got:.3?}, photons {want:.3?}, sum {:.3}",
                got.iter().sum::<f64>()
            );
            for (got, want) in got.into_iter().zip(want) {
                assert!((got - want).abs() < (0.15 * want).max(0.03), "{depth} {cosine}: {got} not {want}");
            }
            assert!(got.iter().sum::<f64>() < 1.05, "light is made");
        }
    }
}
