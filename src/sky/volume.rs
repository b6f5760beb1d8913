//! One observer's tables: the sky by direction and the air in front of things, for each lamp.

use std::sync::Arc;

use bytemuck::{Zeroable as _, bytes_of};

use super::kit::Kit;
use super::observer::{Lamp, Observer};
use super::passes::{Builder, Slot, TABLE_FORMAT, bind, fade_blend, layout, table_texture, tex, uniform_buffer};
use super::recipe::Name;
use super::set::TableSet;
use super::settings::{SkyModel, SkySettings};
use super::tables::SkyTables;
use super::uniforms::{DimsUniform, EdgesUniform, LampUniform, ObserverUniform, ViewUniform};
use crate::error::Result;
use crate::gpu::Device;
use crate::gpu::pass::{FullscreenDesc, fullscreen};

/// Layers of a lamp: what is complete, and light scattered once by haze without its phase function.
const LAYERS: u32 = 2;
const LAMPS: usize = 2;

/// An array texture that passes draw into layer by layer.
struct Layered {
    whole: wgpu::TextureView,
    layers: Vec<wgpu::TextureView>,
}

impl Layered {
    fn new(device: &Device, label: &str, size: (u32, u32)) -> Self {
        let texture = table_texture(device, label, size, LAYERS * LAMPS as u32);
        let view = |dimension, base, count| {
            texture.create_view(&wgpu::TextureViewDescriptor {
                dimension: Some(dimension),
                base_array_layer: base,
                array_layer_count: count,
                ..Default::default()
            })
        };
        let layers = (0..LAYERS * LAMPS as u32).map(|i| view(wgpu::TextureViewDimension::D2, i, Some(1))).collect();
        Self { whole: view(wgpu::TextureViewDimension::D2Array, 0, None), layers }
    }
}

/// Plain and blending variant of a pass.
struct Pair([wgpu::RenderPipeline; 2]);

/// Layouts of what observers bind.
pub(crate) struct ObserverLayouts {
    planet: wgpu::BindGroupLayout,
    observer: wgpu::BindGroupLayout,
    view: wgpu::BindGroupLayout,
}

impl ObserverLayouts {
    pub fn new(device: &Device) -> Self {
        use Slot::{Sampler, Table, Uniform};
        Self {
            planet: layout(device, "sky of a planet", &[Uniform, Uniform, Table, Sampler, Table, Table, Uniform]),
            observer: layout(device, "sky observer", &[Uniform]),
            view: SkyVolume::view_layout(device),
        }
    }

    /// A planet's tables as observers read them: of light scattered more than once, and once by gas and by haze.
    pub fn planet_group(
        &self,
        device: &Device,
        builder: &Builder,
        [air, airs]: [&wgpu::Buffer; 2],
        [sources, gas, haze]: [&wgpu::TextureView; 3],
    ) -> wgpu::BindGroup {
        let sampler = wgpu::BindingResource::Sampler(&builder.sampler);
        let (air, dims) = (air.as_entire_binding(), builder.dims.as_entire_binding());
        let airs = airs.as_entire_binding();
        bind(device, &self.planet, &[air, dims, tex(sources), sampler, tex(gas), tex(haze), airs])
    }
}

/// Pipelines that all observers share.
pub(crate) struct ObserverPasses {
    sky: Pair,
    air: Pair,
}

impl ObserverPasses {
    pub fn new(device: &Device, settings: &SkySettings, layouts: &ObserverLayouts) -> Result<Self> {
        let layouts = [&layouts.planet, &layouts.observer];
        let (sky, air) = match settings.model {
            SkyModel::Table3d => ("sky_from_table", "volume_from_table"),
            _ => ("sky", "volume"),
        };
        Ok(Self { sky: pair(device, settings, sky, &layouts)?, air: pair(device, settings, air, &layouts)? })
    }
}

/// What an observer's table was drawn for.
#[derive(Clone, Copy, PartialEq)]
struct Drawn {
    revision: u64,
    altitude_m: f64,
    mu_s: f64,
}

/// An observer's tables, and the bind group with which shaders look them up (`shaders/sky/lookup.wgsl`, group 1).
///
/// One thread at a time; one [`SkyVolume::prepare`] a submission, since it writes uniforms through the queue.
pub struct SkyVolume {
    device: Arc<Device>,
    kit: Arc<Kit>,
    sky: Layered,
    air: Layered,
    observer_groups: Vec<wgpu::BindGroup>,
    observers: Vec<wgpu::Buffer>,
    view: wgpu::Buffer,
    view_group: wgpu::BindGroup,
    /// Whose sources the group holds, where pixels march through them.
    marched: Option<Arc<TableSet>>,
    drawn: [Option<Drawn>; LAMPS],
    written: ViewUniform,
}

impl SkyVolume {
    /// Makes an observer's textures for `tables`; nothing is drawn yet.
    ///
    /// # Errors
    /// GPU faults.
    pub fn new(tables: &SkyTables) -> Result<Self> {
        let (device, kit) = (tables.device.clone(), tables.kit().clone());
        let s = *tables.settings();
        let sky = Layered::new(&device, "sky of an observer", (s.sky_azimuths, s.sky_above + s.sky_below));
        let air_size = (s.air_azimuths * s.air_slices, s.air_above + s.air_below);
        let air = Layered::new(&device, "air of an observer", air_size);
        kit.observer_passes()?;
        let zero = bytes_of(&ObserverUniform::zeroed()).to_vec();
        let observers: Vec<_> = (0..LAMPS).map(|_| uniform_buffer(&device, "sky observer", &zero)).collect();
        let group = |b: &wgpu::Buffer| bind(&device, &kit.observer_layouts.observer, &[b.as_entire_binding()]);
        let observer_groups = observers.iter().map(group).collect();
        let written = ViewUniform::zeroed();
        let view = uniform_buffer(&device, "sky view", bytes_of(&written));
        let textures = [&sky.whole, &air.whole, &tables.light.view, &kit.nothing.view];
        let view_group = view_group(&kit, &view, textures);
        device.check()?;
        let (marched, drawn) = (None, [None; LAMPS]);
        Ok(Self { device, kit, sky, air, observer_groups, observers, view, view_group, marched, drawn, written })
    }

    /// Of the tables that it was made for.
    pub fn settings(&self) -> &SkySettings {
        &self.kit.settings
    }

    /// Layout of group 1 of every shader that includes `sky/lookup.wgsl`; equal for all volumes of a device.
    pub fn view_layout(device: &Device) -> wgpu::BindGroupLayout {
        use Slot::{Sampler, Table, TableArray, Uniform};
        layout(device, "sky view", &[Uniform, TableArray, TableArray, Table, Table, Sampler])
    }

    /// The layout that this volume's group was made with.
    pub fn layout(&self) -> &wgpu::BindGroupLayout {
        &self.kit.observer_layouts.view
    }

    /// Group 1 of every shader that includes `sky/lookup.wgsl`. Ask again after every [`SkyVolume::prepare`].
    pub fn bind_group(&self) -> &wgpu::BindGroup {
        &self.view_group
    }

    /// Brings the tables up to date and says whether anything had to be drawn. Nothing is, when neither altitude nor sun
    /// nor air changed: turning the camera is free.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] for an observer out of range.
    pub fn prepare(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        tables: &SkyTables,
        observer: &Observer,
    ) -> Result<bool> {
        observer.check()?;
        self.follow_sources(tables);
        let air = tables.air();
        let planet = tables.planet().copied().unwrap_or_else(super::Planet::earth);
        // Lamps that matter, and the altitude that all their tables were drawn for.
        let mut lit = observer.lamps.iter().flatten().filter(|l| l.is_lit());
        let lamps: [Option<&Lamp>; LAMPS] = std::array::from_fn(|_| lit.next());
        let lamps = || lamps.iter().flatten().copied();
        let kept = lamps().enumerate().all(|(i, lamp)| self.is_current(i, tables, observer, lamp));
        if !kept {
            let edges = EdgesUniform::of(&air, observer.altitude_m);
            for (i, lamp) in lamps().enumerate() {
                let drawn =
                    Drawn { revision: tables.revision(), altitude_m: observer.altitude_m, mu_s: lamp.toward[2] };
                let altitude = observer.altitude_m.max(0.0) as f32;
                let uniform = ObserverUniform { altitude, mu_s: lamp.toward[2] as f32, unused: [0.0; 2], edges };
                self.device.queue.write_buffer(&self.observers[i], 0, bytes_of(&uniform));
                self.draw(encoder, tables, i)?;
                self.drawn[i] = Some(drawn);
            }
        }
        let altitude_m = self.drawn[0].map_or(observer.altitude_m, |d| d.altitude_m).max(0.0);
        let mut view = ViewUniform {
            air,
            dims: DimsUniform::of(&self.kit.settings),
            edges: EdgesUniform::of(&air, altitude_m),
            altitude: altitude_m as f32,
            lamp_count: lamps().count() as u32,
            refraction: observer.refraction as f32,
            march_panels: self.kit.settings.march_cells.div_ceil(4),
            lamps: [LampUniform::zeroed(); LAMPS],
        };
        for (i, lamp) in lamps().enumerate() {
            view.lamps[i] = lamp.uniform(&planet, LAYERS * i as u32);
        }
        if view != self.written {
            self.device.queue.write_buffer(&self.view, 0, bytes_of(&view));
            self.written = view;
        }
        Ok(!kept)
    }

    /// Whether lamp `i`'s tables still serve.
    fn is_current(&self, i: usize, tables: &SkyTables, observer: &Observer, lamp: &Lamp) -> bool {
        let Some(drawn) = self.drawn[i] else { return false };
        let (altitude_m, mu_s) = (observer.altitude_m, lamp.toward[2]);
        if drawn.revision != tables.revision() {
            return false;
        }
        if observer.exact {
            return drawn.altitude_m == altitude_m && drawn.mu_s == mu_s;
        }
        (drawn.altitude_m - altitude_m).abs() <= 2e-3 * altitude_m.abs() + 1e-2 && (drawn.mu_s - mu_s).abs() <= 2e-5
    }

    /// Where every pixel marches, it reads the sources of the planet that is shown.
    fn follow_sources(&mut self, tables: &SkyTables) {
        let Some(shown) = tables.shown() else { return };
        let same = self.marched.as_ref().is_some_and(|m| Arc::ptr_eq(m, shown));
        if self.kit.settings.model != SkyModel::BruteForce || same {
            return;
        }
        let sources = &shown.result(Name::Sources).view;
        let textures = [&self.sky.whole, &self.air.whole, &tables.light.view, sources];
        self.view_group = view_group(&self.kit, &self.view, textures);
        self.marched = Some(shown.clone());
    }

    /// Draws lamp `i`'s tables; while an air fades into another, both, one over the other.
    fn draw(&self, encoder: &mut wgpu::CommandEncoder, tables: &SkyTables, i: usize) -> Result<()> {
        let Some(shown) = tables.shown() else { return Ok(()) };
        let next = tables.fading();
        if self.kit.settings.model == SkyModel::BruteForce {
            return Ok(());
        }
        let passes = self.kit.observer_passes()?;
        for (pass, target) in [(&passes.sky, &self.sky), (&passes.air, &self.air)] {
            let layer = |k: usize| {
                Some(wgpu::RenderPassColorAttachment {
                    view: &target.layers[LAYERS as usize * i + k],
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations {
                        load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
                        store: wgpu::StoreOp::Store,
                    },
                })
            };
            let mut recorded = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("sky of an observer"),
                color_attachments: &[layer(0), layer(1)],
                ..Default::default()
            });
            recorded.set_pipeline(&pass.0[0]);
            recorded.set_bind_group(0, &shown.observer_group, &[]);
            recorded.set_bind_group(1, &self.observer_groups[i], &[]);
            recorded.draw(0..3, 0..1);
            if let Some((next, t)) = next {
                let t = f64::from(t);
                recorded.set_pipeline(&pass.0[1]);
                recorded.set_blend_constant(wgpu::Color { r: t, g: t, b: t, a: t });
                recorded.set_bind_group(0, &next.observer_group, &[]);
                recorded.draw(0..3, 0..1);
            }
        }
        Ok(())
    }
}

/// What shaders look up: the observer's sky and air, the planet's light, and the sources where pixels march.
fn view_group(kit: &Kit, view: &wgpu::Buffer, textures: [&wgpu::TextureView; 4]) -> wgpu::BindGroup {
    let [sky, air, light, sources] = textures.map(tex);
    let sampler = wgpu::BindingResource::Sampler(&kit.builder.sampler);
    bind(&kit.device, &kit.observer_layouts.view, &[view.as_entire_binding(), sky, air, light, sources, sampler])
}

fn pair(device: &Device, s: &SkySettings, entry: &str, layouts: &[&wgpu::BindGroupLayout]) -> Result<Pair> {
    let make = |blend| {
        let target = wgpu::ColorTargetState { format: TABLE_FORMAT, blend, write_mask: wgpu::ColorWrites::ALL };
        let desc = FullscreenDesc {
            shader: "sky/observer.wgsl",
            entry,
            layouts,
            targets: &[target.clone(), target],
            constants: &[
                ("DIRECTIONAL", f64::from(u8::from(s.model.is_directional()))),
                ("LAYERS", f64::from(s.layers())),
            ],
            samples: 1,
        };
        fullscreen(device, &desc)
    };
    Ok(Pair([make(None)?, make(Some(fade_blend()))?]))
}
