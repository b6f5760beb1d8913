//! `lab chart quadrature`: compares rules for the sky's two integrals in f32 on the GPU, using the library's own shader
//! functions. The integrals are the transmittance to space over 64 altitudes and 256 angles, and single scattering from
//! four altitudes under four suns.

use std::{path::Path, sync::Arc};

use welkin::gpu::{Device, readback, shader};
use welkin::plan::{Difference, difference};
use welkin::sky::reference::medium::Medium;
use welkin::sky::reference::ray::{Ray, horizon_mu};
use welkin::sky::reference::{Options as Truth, Orders, Reference, View};
use welkin::sky::{Planet, SkySettings, air_uniform};
use welkin::{Error, Result, Status};
use welkin_support::fullscreen;

use crate::chart::{COLUMNS, Lab, first_fields, plot, say_what_moved, today};
use crate::command::Options;
use crate::plot::Titles;
use crate::store::{Journal, Table};
use crate::timing::{interleaved, target, timed};

const COLUMN_COUNT: u32 = 256;
const ROWS: u32 = 64;
const RULES: [(&str, u32); 6] =
    [("offset-0.3", 0), ("midpoint", 1), ("trapezoid", 2), ("gauss-4", 3), ("welkin", 4), ("midpoint-stretched", 5)];
const COUNTS: [u32; 7] = [8, 16, 20, 32, 40, 64, 128];

/// Errors of single scattering by the sun's zenith angle.
pub const SUN_COLUMNS: [&str; 4] = ["p95_sun_30", "p95_sun_75", "p95_sun_88", "p95_sun_92"];

/// The air used: the Earth's, with a point sun.
fn planet() -> Planet {
    Planet { sun_angular_radius_deg: 0.0, ..Planet::earth() }
}

/// The lab's own passes.
struct Rules<'a> {
    device: &'a Device,
    module: wgpu::ShaderModule,
    layout: wgpu::BindGroupLayout,
    quad: wgpu::Buffer,
    group: wgpu::BindGroup,
}

impl<'a> Rules<'a> {
    fn new(device: &'a Device) -> Result<Self> {
        let gpu = &device.device;
        let text = [shader::assemble("sky/march.wgsl")?, shader::assemble("common/fullscreen.wgsl")?].concat();
        let source = wgpu::ShaderSource::Wgsl((text + include_str!("quadrature.wgsl")).into());
        let module = gpu.create_shader_module(wgpu::ShaderModuleDescriptor { label: Some("quadrature"), source });
        let uniform = wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: None,
        };
        let texture = wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: true },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        };
        let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
        let kinds = [uniform, uniform, uniform, texture, sampler];
        let entry = |(i, ty): (usize, &wgpu::BindingType)| wgpu::BindGroupLayoutEntry {
            binding: i as u32,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty: *ty,
            count: None,
        };
        let entries: Vec<_> = kinds.iter().enumerate().map(entry).collect();
        let layout = gpu.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries: &entries });
        let buffer = |bytes: &[u8]| {
            let b = gpu.create_buffer(&wgpu::BufferDescriptor {
                label: None,
                size: bytes.len() as u64,
                usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            });
            device.queue.write_buffer(&b, 0, bytes);
            b
        };
        let s = SkySettings { azimuths: 3, zeniths: 4, suns: 16, altitudes: 8, ..Default::default() };
        let mut dims = [0u32; 16];
        dims[..4].copy_from_slice(&[s.suns, s.altitudes, s.zeniths, s.azimuths]);
        let (air, dims) = (buffer(&air_uniform(&planet())), buffer(bytemuck::cast_slice(&dims)));
        let quad = buffer(bytemuck::cast_slice(&[ROWS, COLUMN_COUNT, 0, 16]));
        let nothing = target(device, (64, 64), wgpu::TextureFormat::Rgba16Float).create_view(&Default::default());
        let linear = gpu.create_sampler(&wgpu::SamplerDescriptor {
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            ..Default::default()
        });
        let resources = [
            air.as_entire_binding(),
            quad.as_entire_binding(),
            dims.as_entire_binding(),
            wgpu::BindingResource::TextureView(&nothing),
            wgpu::BindingResource::Sampler(&linear),
        ];
        let bound: Vec<_> = resources
            .iter()
            .enumerate()
            .map(|(i, r)| wgpu::BindGroupEntry { binding: i as u32, resource: r.clone() })
            .collect();
        let group = gpu.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout: &layout, entries: &bound });
        Ok(Self { device, module, layout, quad, group })
    }

    fn pipeline(&self, entry: &str, rule: u32, format: wgpu::TextureFormat) -> wgpu::RenderPipeline {
        let stages = (fullscreen::VERTEX, entry, &[("RULE", f64::from(rule))][..]);
        fullscreen::pipeline(&self.device.device, &self.module, stages, &[&self.layout], &[format.into()])
    }

    fn run(&self, pipeline: &wgpu::RenderPipeline, n: u32, target: &wgpu::Texture) -> Result<f64> {
        self.device.queue.write_buffer(&self.quad, 0, bytemuck::cast_slice(&[ROWS, COLUMN_COUNT, 0, n]));
        let mut encoder = self.device.device.create_command_encoder(&Default::default());
        let view = target.create_view(&Default::default());
        welkin::gpu::pass::draw(&mut encoder, "quadrature", pipeline, &[&self.group], &view);
        timed(self.device, encoder)
    }
}

/// Transmittance to space by direct quadrature, in green.
fn true_transmittance() -> Vec<f64> {
    let medium = Medium::of(&planet());
    let mut out = Vec::new();
    for row in 0..ROWS {
        let y = f64::from(row) / f64::from(ROWS - 1);
        let h = medium.top_m * 0.98 * y * y;
        let horizon = horizon_mu(&medium, h);
        for column in 0..COLUMN_COUNT {
            let x = (f64::from(column) + 0.5) / f64::from(COLUMN_COUNT);
            let ray = Ray::new(&medium, h, horizon + (1.0 - horizon) * x * x);
            out.push(medium.transmittance(&ray.columns_to_space(&medium))[1]);
        }
    }
    out
}

/// Single scattering in green, each group of altitude and sun divided by its mean.
fn true_scattering(means: &mut Vec<f64>) -> Result<Vec<f64>> {
    let planet = planet();
    let medium = Medium::of(&planet);
    let reference = Reference::solve(&planet, &Truth { orders: Orders::Exactly(1), ..Default::default() })?;
    let mut out = Vec::new();
    for row in 0..64u32 {
        let altitude_m = [2.0, 1500.0, 11_000.0, 50_000.0][(row / 16) as usize];
        let sun_zenith = [30.0f64, 75.0, 88.0, 92.0][(row / 4 % 4) as usize].to_radians();
        let azimuth = f64::from(row % 4) * std::f64::consts::PI / 3.0;
        let horizon = horizon_mu(&medium, altitude_m);
        for column in 0..COLUMN_COUNT {
            let x = (f64::from(column) + 0.5) / f64::from(COLUMN_COUNT);
            let view_zenith = (horizon + (1.0 - horizon) * x * x).acos();
            let along = reference.radiance(&View { altitude_m, sun_zenith, view_zenith, azimuth })?;
            out.push(along.radiance[1] / planet.solar_irradiance[1]);
        }
    }
    *means = out.chunks(4 * COLUMN_COUNT as usize).map(|g| g.iter().sum::<f64>() / g.len() as f64).collect();
    Ok(normal(&out, means))
}

fn normal(values: &[f64], means: &[f64]) -> Vec<f64> {
    values.iter().enumerate().map(|(i, v)| v / means[i / (4 * COLUMN_COUNT as usize)]).collect()
}

/// The 95th percentile for each sun. Rows are ordered by altitude, sun, azimuth.
fn by_sun(drawn: &[f64], truth: &[f64]) -> Result<[f64; 4]> {
    let group = 4 * COLUMN_COUNT as usize;
    let mut out = [0.0; 4];
    for (i, slot) in out.iter_mut().enumerate() {
        let of = |v: &[f64]| -> Vec<f64> { v.chunks(group).skip(i).step_by(4).flatten().copied().collect() };
        *slot = difference(&of(drawn), &of(truth), 1.0 / 0.18)?.p95;
    }
    Ok(out)
}

/// The current error of transmittance to space by the rule `name` with `n` nodes.
///
/// # Errors
/// An unknown rule; the GPU.
pub fn transmittance_error(device: &Arc<Device>, name: &str, n: u32) -> Result<Difference> {
    let known = || RULES.map(|r| r.0).join(", ");
    let rule = RULES.iter().find(|r| r.0 == name);
    let (_, number) = rule.ok_or_else(|| Error::range("rule", &format!("one of {}", known()), name))?;
    let rules = Rules::new(device)?;
    let wide = wgpu::TextureFormat::Rgba32Float;
    let small = target(device, (COLUMN_COUNT, ROWS), wide);
    rules.run(&rules.pipeline("transmittance", *number, wide), n, &small)?;
    let drawn: Vec<f64> = readback::rgba(device, &small)?.iter().map(|t| f64::from(t[1])).collect();
    difference(&drawn, &true_transmittance(), 1.0)
}

/// Measures all rules and draws both charts.
///
/// # Errors
/// Files and the GPU.
pub fn chart(lab: &Lab, options: &Options) -> Result<()> {
    let columns: Vec<&str> =
        COLUMNS.iter().copied().chain(["integral", "nodes"]).chain(SUN_COLUMNS).chain(["date"]).collect();
    let note = lab.note("quadrature", options);
    let mut journal = Journal::open(&options.out, "quadrature", &note, &columns, options.fresh)?;
    let rules = Rules::new(&lab.device)?;
    let mut means = Vec::new();
    let truths = [true_transmittance(), true_scattering(&mut means)?];
    let wide = wgpu::TextureFormat::Rgba32Float;
    let small = target(&lab.device, (COLUMN_COUNT, ROWS), wide);
    for (entry, truth) in ["transmittance", "scattering"].into_iter().zip(&truths) {
        for (rule, number) in RULES {
            let closed = entry == "transmittance" && number == 4;
            if entry == "transmittance" && number == 5 {
                continue;
            }
            let counts = if closed { &COUNTS[..1] } else { &COUNTS[..] };
            for n in counts {
                let name = if closed { format!("{entry}/closed form") } else { format!("{entry}/{rule} {n}") };
                if journal.has(&name) {
                    continue;
                }
                eprintln!("  {name} ..");
                let pipeline = rules.pipeline(entry, number, wide);
                rules.run(&pipeline, *n, &small)?;
                let drawn: Vec<f64> = readback::rgba(&lab.device, &small)?.iter().map(|t| f64::from(t[1])).collect();
                let error = if entry == "transmittance" {
                    difference(&drawn, truth, 1.0)?
                } else {
                    difference(&normal(&drawn, &means), truth, 1.0 / 0.18)?
                };
                let by_sun = if entry == "transmittance" { [0.0; 4] } else { by_sun(&normal(&drawn, &means), truth)? };
                let cost = interleaved(&lab.baseline, lab.rounds, |_| rules.run(&pipeline, *n, &small))?;
                let default = number == 4 && (closed || *n == 4 * SkySettings::default().sky_panels);
                let mut row = first_fields(&name, rule, default, &cost, &error);
                row.extend([entry.to_owned(), if closed { "0".into() } else { n.to_string() }]);
                row.extend(by_sun.map(|e| format!("{e:.6e}")));
                row.push(today());
                journal.push(row)?;
            }
        }
    }
    let (table, old) = journal.finish()?;
    say_what_moved(&table, old.as_ref());
    for (entry, title) in [
        ("transmittance", "Transmittance to space: rules of quadrature"),
        ("scattering", "Light scattered once: rules of quadrature"),
    ] {
        one_plot(&table, entry, title, &options.out.join(format!("quadrature-{entry}")))?;
    }
    Ok(())
}

/// Draws the rows of one integral as a chart.
fn one_plot(table: &Table, entry: &str, title: &str, stem: &Path) -> Result<()> {
    let column = table.columns.iter().position(|c| c == "integral");
    let column = column.ok_or_else(|| Error::new(Status::Parse, "quadrature.csv has no column integral".to_owned()))?;
    let mut part = table.clone();
    part.rows.retain(|r| r[column] == entry);
    part.rows.iter_mut().for_each(|r| r[0] = r[0][entry.len() + 1..].to_owned());
    let titles = Titles {
        title,
        x: "cost of 256x64 rays over the baseline's",
        y: "95th percentile of the error, relative with a floor of 0.01 of white",
        note: "numbers: nodes along a ray; line: nothing is both cheaper and better; ring: the default",
    };
    plot(&part, "cost", &titles, stem)
}
