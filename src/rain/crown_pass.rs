//! Splashes on devices with compute shaders. A list has the slots of the grid on the ground ([`super::splash`]) whose
//! splash may be in the picture ([`crate::particles::listing`]). For each listed slot the foot of its crown is searched
//! once in the picture's depth. Shaders: `shaders/rain/crowns.wgsl`, `crowns_view.wgsl`.

use super::cull_pass::{ListedQuads, listed_pipeline};
use crate::{
    error::Result,
    gpu::{
        Device,
        pass::{self, ComputeDesc, PassPipelines},
    },
    particles::{DepthRead, listing::Listing},
};

/// Size of a `Crown` of `shaders/rain/splash.wgsl`, bytes.
const CROWN_BYTES: u64 = 64;

/// State that a view holds to draw crowns.
pub(super) struct CrownPass {
    listing: Listing,
    /// Pipelines of `mark` and `order`, by whether rims of areas are near and whether depth is multisampled.
    marks: PassPipelines<[bool; 2], [wgpu::ComputePipeline; 2]>,
    /// Pipelines of `make_crowns`.
    makes: PassPipelines<CrownKind, wgpu::ComputePipeline>,
    /// Pipelines of the draw, by how depth is read.
    draws: PassPipelines<DepthRead, wgpu::RenderPipeline>,
    /// Whether the pass counts how often each pixel is drawn, instead of drawing light.
    counts: bool,
}

/// Properties that select the pipelines: how depth is read, whether rims of areas are near, whether there are occluder
/// maps.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct CrownKind {
    pub depth: DepthRead,
    pub areas: bool,
    pub maps: bool,
}

impl CrownPass {
    pub fn new(device: &wgpu::Device, counts: bool) -> Self {
        let listing = Listing::new(device, CROWN_BYTES);
        Self { listing, marks: PassPipelines::NONE, makes: PassPipelines::NONE, draws: PassPipelines::NONE, counts }
    }

    /// Returns the bytes of GPU memory held.
    pub fn bytes(&self) -> u64 {
        self.listing.bytes()
    }

    /// Compiles the pipelines for `kind` that do not exist yet. `frame` is the layout of group 0 of the drops' pass,
    /// `around` that of the surroundings.
    ///
    /// # Errors
    /// A missing shader file.
    pub fn prepare(
        &mut self,
        device: &Device,
        [frame, around]: [&wgpu::BindGroupLayout; 2],
        kind: CrownKind,
    ) -> Result<()> {
        let CrownKind { depth, areas, maps } = kind;
        let ([list, made], counts) = (&self.listing.layouts, self.counts);
        let flag = |name, on| (name, f64::from(u8::from(on)));
        self.marks.prepare([areas, depth.multi], |_| {
            let constants = &[flag("AREAS", areas), flag("OVERLAPS", false)];
            let layouts = &[Some(frame), Some(list)];
            let shader = "rain/crowns.wgsl";
            let make = |entry| pass::compute(device, &ComputeDesc { shader, entry, layouts, constants });
            Ok([make("mark")?, make("order")?])
        })?;
        self.makes.prepare(kind, |_| {
            let [_, kinds] = depth.constants();
            let constants = &[flag("AREAS", areas), flag("OVERLAPS", false), flag("MAPS", maps), kinds];
            let layouts = &[Some(frame), Some(made), Some(around)];
            let shader = &depth.shader("rain/crowns_view.wgsl");
            pass::compute(device, &ComputeDesc { shader, entry: "make_crowns", layouts, constants })
        })?;
        let attributes = wgpu::vertex_attr_array![0 => Float32x4, 1 => Float32x4, 2 => Float32x4, 3 => Uint32];
        let entries = ["crown_vertex", "crown_fragment"];
        let listed = ListedQuads { entries, attributes: &attributes, bytes: CROWN_BYTES };
        self.draws.prepare(depth, |_| listed_pipeline(device, frame, &listed, depth, counts))
    }

    /// Computes the crowns of `slots` slots. `frame` and `around` are bound as groups 0 and 2.
    pub fn make(
        &mut self,
        device: &wgpu::Device,
        pass: &mut wgpu::ComputePass<'_>,
        [frame, around]: [&wgpu::BindGroup; 2],
        kind: CrownKind,
        slots: u32,
    ) {
        self.listing.make_room(device, [slots, 1]);
        let (Some([mark, order]), Some(make)) =
            (self.marks.get(&[kind.areas, kind.depth.multi]), self.makes.get(&kind))
        else {
            return;
        };
        pass.set_bind_group(0, frame, &[]);
        pass.set_bind_group(2, around, &[]);
        self.listing.find(pass, [mark, order, make], [slots, 1]);
    }

    /// Draws the crowns. The caller has set group 0.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>, kind: CrownKind) {
        if let Some(draw) = self.draws.get(&kind.depth) {
            pass.set_pipeline(draw);
            self.listing.draw(pass);
        }
    }
}
