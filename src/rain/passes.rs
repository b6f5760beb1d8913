//! Layer of rain in front of a picture: its texture, its pipelines and the draw.

use std::ops::Range;

use super::{
    cone_pass::{ConeKind, ConePass},
    cones::{self, ConeUniform},
    crown_pass::{CrownKind, CrownPass},
    cull_pass::{CullPass, DropLattice},
    integrated,
    local::{COLUMNS_BYTES, LOCAL, LocalUniform},
    splash::SplashUniform,
    stone_pass::{StoneDraw, StoneKind, StonePass},
    uniforms::RainUniform,
};
use crate::{
    error::Result,
    gpu::{
        Device, KeptLayer, Layer,
        bind::{self, Slot},
        blocks::{Blocks, UniformBlock},
        is_kept,
        pass::{self, PassPipelines, QuadsDesc},
    },
    particles::{
        DepthRead, FallingTexture, LAYER_FORMAT, layer_pass,
        stepping::{StepPass, Stepped},
    },
    scene::ViewRays,
    stage::Recording,
    surroundings::{self, SurroundingsBlock},
};

/// Layer of drops, composited in front of the picture: premultiplied light and opacity, one sample a pixel.
pub(crate) struct RainLayer {
    /// Block of drops ([`RainUniform`]), followed by that of splashes ([`SPLASHES`]).
    block: UniformBlock,
    /// Columns of rain areas, followed by the numbers of drops near a rim ([`LocalUniform`]).
    local: wgpu::Buffer,
    /// Layout of group 0 for depth with one and with several samples.
    layouts: [wgpu::BindGroupLayout; 2],
    /// Layout of the group of shelters, occluder maps and lamps.
    surroundings: wgpu::BindGroupLayout,
    /// Pipelines of drops and of splashes, for devices that cannot draw by lists.
    pipelines: PassPipelines<CrownKind, [wgpu::RenderPipeline; 2]>,
    /// Passes that list drops and crowns, on devices with compute shaders.
    listed: Option<Box<(CullPass, CrownPass)>>,
    cones: Option<ConePass>,
    /// Pass that steps drops, once any are stepped.
    stepped: Option<Box<StepPass>>,
    /// Pass for hail and pellets, created when the first stones fall.
    stones: Option<StonePass>,
    /// Whether the layer counts how often its pixels are drawn, instead of showing the drops' light.
    counts: bool,
    /// Placeholder for a missing depth.
    none: Option<wgpu::TextureView>,
    texture: FallingTexture,
    /// Depth to which the bind group of group 0 refers, and the bind group.
    bound: Option<(Option<KeptLayer>, wgpu::BindGroup)>,
}

/// Inputs of one frame's draw into the layer.
pub(crate) struct LayerDraw<'a> {
    pub rain: &'a RainUniform,
    /// Cones, if any are drawn: instead of drops and splashes, or beyond the drops.
    pub cones: Option<&'a ConeUniform>,
    /// Drops that are stepped, instead of drops without a state.
    pub stepped: Option<&'a Stepped<'a>>,
    /// View rays of the camera.
    pub rays: &'a ViewRays,
    /// Surroundings: shelters, occluder maps and lamps.
    pub surroundings: &'a SurroundingsBlock,
    /// Whether the surroundings contain occluder maps.
    pub maps: bool,
    /// Whether the surroundings contain lamps.
    pub lamps: bool,
    /// Block of the splashes.
    pub splash: &'a SplashUniform,
    /// Number of slots of splashes; 0 for none.
    pub splashes: u32,
    /// Number of drops at each place, if a rim of a rain area is near.
    pub local: Option<&'a LocalUniform>,
    /// Whether the layer already contains columns of rain areas; drops are then drawn in front of them.
    pub over: bool,
    /// Hail and pellets, if any fall.
    pub stones: Option<StoneDraw>,
}

fn layout(device: &wgpu::Device, multisampled: bool) -> wgpu::BindGroupLayout {
    let all = wgpu::ShaderStages::VERTEX_FRAGMENT | wgpu::ShaderStages::COMPUTE;
    let slots = [
        (0, Slot::Uniform(size_of::<RainUniform>())),
        (1, Slot::texels(multisampled)),
        (3, Slot::Uniform(size_of::<SplashUniform>())),
        (7, Slot::Uniform(COLUMNS_BYTES)),
        (8, Slot::Uniform(size_of::<LocalUniform>() - COLUMNS_BYTES)),
    ];
    bind::layout(device, "rain", all, &slots)
}

/// Range of bytes of the splashes in the block, after the rain.
pub(super) const SPLASHES: Range<usize> = {
    let at = size_of::<RainUniform>().next_multiple_of(256);
    at..at + size_of::<SplashUniform>()
};
impl RainLayer {
    /// Creates a layer of light, or one that counts how often its pixels are drawn.
    pub fn new(device: &Device, blocks: &Blocks, texture: FallingTexture, counts: bool) -> Self {
        Self {
            counts,
            block: blocks.block(device, SPLASHES.end),
            local: bind::block(&device.device, "rain areas near", LOCAL.end),
            layouts: [layout(&device.device, false), layout(&device.device, true)],
            surroundings: surroundings::layout(&device.device),
            pipelines: PassPipelines::NONE,
            listed: None,
            cones: None,
            stepped: None,
            stones: None,
            none: None,
            texture,
            bound: None,
        }
    }

    /// Returns whether the layer counts how often its pixels are drawn.
    pub fn counts(&self) -> bool {
        self.counts
    }

    /// Bytes of GPU memory that the layer holds.
    pub fn bytes(&self) -> u64 {
        let cones = self.cones.as_ref().map_or(0, ConePass::bytes);
        let listed = self.listed.as_ref().map_or(0, |l| l.0.bytes() + l.1.bytes());
        self.texture.bytes() + cones + listed + self.stepped.as_ref().map_or(0, |s| s.bytes())
    }

    /// Returns the texture of the layer, which other effects may share.
    pub fn texture(&self) -> &FallingTexture {
        &self.texture
    }

    /// Prepares stones and cones, and draws the grid of shelter for the cones.
    fn prepare_far(
        &mut self,
        recording: &mut Recording<'_>,
        drawn: &LayerDraw<'_>,
        picture: wgpu::Extent3d,
        cone_kind: ConeKind,
    ) -> Result<()> {
        let (device, blocks, depth) = (recording.device, recording.blocks, cone_kind.depth);
        let (frame, counts) = ([&self.layouts[usize::from(depth.multi)], &self.surroundings], self.counts);
        if let Some(stones) = &drawn.stones {
            let own = self.stones.get_or_insert_with(|| StonePass::new(device, blocks, counts));
            own.prepare(device, stones, frame, LAYER_FORMAT, StoneKind { depth, maps: drawn.maps })?;
        }
        if let Some(block) = drawn.cones {
            let cones = self.cones.get_or_insert_with(|| ConePass::new(device, blocks, counts));
            cones.prepare(device, block, frame, cone_kind)?;
            if cone_kind.sheltered {
                cones.shelter(recording, &self.block, &self.surroundings, drawn.surroundings, picture, drawn.maps)?;
            }
        }
        Ok(())
    }

    /// Draws the cones, the drops and the stones for a picture of the size of `color` with the host's `depth`. Splashes
    /// and stones on the ground are drawn only if there is depth.
    ///
    /// # Errors
    /// A missing shader file.
    pub fn draw(
        &mut self,
        recording: &mut Recording<'_>,
        drawn: &LayerDraw<'_>,
        color: &wgpu::Texture,
        depth: Option<Layer<'_>>,
    ) -> Result<()> {
        let device = recording.device;
        self.write(device, drawn);
        let read = DepthRead::of(depth, drawn.rays);
        self.bind(device, depth, read.multi);
        self.texture.view(device, color.size());
        let kind = CrownKind { depth: read, areas: drawn.local.is_some(), maps: drawn.maps };
        let cone_kind = ConeKind {
            depth: read,
            sheltered: drawn.surroundings.shelters(),
            areas: kind.areas,
            lamps: drawn.lamps,
            over: drawn.over,
            innermost: drawn.cones.is_some_and(|c| c.first == 0),
            growing: drawn.cones.is_some_and(|c| (c.first..cones::NONE_GROWS).contains(&c.growing)),
        };
        let surroundings = drawn.surroundings.bind_group();
        self.prepare_far(recording, drawn, color.size(), cone_kind)?;
        if drawn.rain.shells == 0 {
            self.draw_into(recording.encoder, drawn.over, surroundings, |pass, layer| {
                if drawn.cones.is_some() {
                    layer.cones.iter().for_each(|c| c.draw(pass, cone_kind));
                }
                layer.draw_stones(pass, read, drawn);
            });
            return Ok(());
        }
        if let Some(stepped) = drawn.stepped {
            let pass = self.stepped.get_or_insert_with(|| Box::new(integrated::pass(device, recording.blocks)));
            pass.step(device, recording.encoder, self.block.range(0, size_of::<RainUniform>()), stepped)?;
        }
        let splashes = drawn.splashes * u32::from(depth.is_some());
        if CullPass::serves(device) {
            self.list(device, recording.encoder, drawn, kind, splashes)?;
        } else {
            let (frame, counts) = ([&self.layouts[usize::from(read.multi)], &self.surroundings], self.counts);
            let make = |entries| pipeline(device, frame, entries, kind, counts);
            self.pipelines.prepare(kind, |_| {
                Ok([make(["rain_vertex", "rain_fragment"])?, make(["splash_vertex", "crown_fragment"])?])
            })?;
        }
        self.draw_into(recording.encoder, drawn.over, surroundings, |pass, layer| {
            if drawn.cones.is_some() {
                layer.cones.iter().for_each(|c| c.draw(pass, cone_kind));
                // The drops' pipeline layout lacks group 1, which the cones' layout has. On OpenGL group 2 then has
                // other binding points. wgpu 30 does not notice this, and it ignores a group that is set already, so
                // group 2 is first removed.
                pass.set_bind_group(2, None, &[]);
                pass.set_bind_group(2, surroundings, &[]);
            }
            match (layer.listed.as_deref(), layer.pipelines.get(&kind)) {
                (Some((cull, crowns)), _) => {
                    cull.draw(pass, read);
                    if splashes > 0 {
                        crowns.draw(pass, kind);
                    }
                }
                (None, Some([falling, splashing])) => {
                    pass.set_pipeline(falling);
                    pass.draw(0..4, 0..drawn.rain.per_shell * drawn.rain.shells);
                    pass.set_pipeline(splashing);
                    pass.draw(0..4, 0..splashes);
                }
                _ => {}
            }
            layer.draw_stones(pass, read, drawn);
        });
        Ok(())
    }

    /// Lists the drops and splashes in the picture.
    fn list(
        &mut self,
        device: &Device,
        encoder: &mut wgpu::CommandEncoder,
        drawn: &LayerDraw<'_>,
        kind: CrownKind,
        splashes: u32,
    ) -> Result<()> {
        let CrownKind { depth, areas, maps } = kind;
        let frame = [&self.layouts[usize::from(depth.multi)], &self.surroundings];
        let (own, counts) = (&device.device, self.counts);
        let make = || Box::new((CullPass::new(own, (&self.block, &self.local), counts), CrownPass::new(own, counts)));
        let (cull, crowns) = &mut **self.listed.get_or_insert_with(make);
        let around = drawn.surroundings.bind_group();
        let states = self.stepped.as_ref().filter(|_| drawn.stepped.is_some()).and_then(|s| s.states());
        cull.prepare_draw(device, frame[0], depth)?;
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        let lattice = DropLattice { shells: drawn.rain.shells, per_shell: drawn.rain.per_shell, states, areas, maps };
        cull.find(device, &mut pass, (frame[1], around), lattice)?;
        if let (Some((.., own)), 1..) = (&self.bound, splashes) {
            crowns.prepare(device, frame, kind)?;
            crowns.make(&device.device, &mut pass, [own, around], kind, splashes);
        }
        Ok(())
    }

    fn draw_stones(&self, pass: &mut wgpu::RenderPass<'_>, depth: DepthRead, drawn: &LayerDraw<'_>) {
        if let (Some(stones), Some(own)) = (&drawn.stones, &self.stones) {
            own.draw(pass, StoneKind { depth, maps: drawn.maps }, stones);
        }
    }

    /// Draws into the layer. The layer is cleared first, unless `keeps` is set.
    fn draw_into(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        keeps: bool,
        surroundings: &wgpu::BindGroup,
        draw: impl FnOnce(&mut wgpu::RenderPass<'_>, &Self),
    ) {
        let (Some((.., group)), Some(target)) = (&self.bound, self.texture.held()) else { return };
        let mut pass = layer_pass(encoder, "drops", &target, keeps);
        pass.set_bind_group(0, group, &[]);
        pass.set_bind_group(2, surroundings, &[]);
        draw(&mut pass, self);
    }

    fn write(&self, device: &Device, drawn: &LayerDraw<'_>) {
        self.block.write(bytemuck::bytes_of(drawn.rain));
        self.block.write_at(SPLASHES.start, bytemuck::bytes_of(drawn.splash));
        if let Some(local) = drawn.local {
            let (columns, counts) = bytemuck::bytes_of(local).split_at(COLUMNS_BYTES);
            device.write_buffer(&self.local, 0, columns);
            device.write_buffer(&self.local, LOCAL.start as u64, counts);
        }
    }

    fn bind(&mut self, device: &Device, depth: Option<Layer<'_>>, multi: bool) {
        if self.bound.as_ref().is_some_and(|(d, _)| is_kept(depth, d.as_ref())) {
            return;
        }
        let view = depth.map(Layer::view);
        let none = self.none.get_or_insert_with(|| bind::nothing(&device.device, wgpu::TextureFormat::Rgba8Unorm));
        let group = device.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("rain"),
            layout: &self.layouts[usize::from(multi)],
            entries: &[
                self.block.part(0, 0, size_of::<RainUniform>()),
                bind::view(1, view.as_ref().unwrap_or(none)),
                self.block.part(3, SPLASHES.start, SPLASHES.len()),
                bind::part(7, &self.local, 0..COLUMNS_BYTES),
                bind::part(8, &self.local, LOCAL),
            ],
        });
        self.bound = Some((depth.map(Layer::kept), group));
    }
}

fn pipeline(
    device: &Device,
    [frame, around]: [&wgpu::BindGroupLayout; 2],
    [vertex, fragment]: [&str; 2],
    CrownKind { depth, areas, maps }: CrownKind,
    counts: bool,
) -> Result<wgpu::RenderPipeline> {
    let module = device.shader(&depth.shader("rain/drops_view.wgsl"))?;
    // Sets OVERLAPS to 0: near a rim the drops are mixed one column after another, so later ones cover earlier ones.
    let near = [("AREAS", f64::from(u8::from(areas))), ("OVERLAPS", 0.0), ("MAPS", f64::from(u8::from(maps)))];
    pass::quads(
        device,
        &QuadsDesc {
            label: "drops",
            vertex: (&module, vertex, &near),
            fragment: (&module, fragment, &depth.constants()),
            layouts: &[Some(frame), None, Some(around)],
            buffers: &[],
            format: LAYER_FORMAT,
            counts,
        },
    )
}
