//! Fog in a view: its uniform block, and its constants of the composition.

use super::{
    banks::FogBanks,
    candidates,
    held::HeldFog,
    model::{FogKind, FogModel},
    uniforms::{FogVariant, LowAirUniform},
};
use crate::{
    error::Result,
    gpu::{
        Device,
        blocks::{Blocks, UniformBlock},
    },
    stage::{
        Block, Contribution, DrawContext, DrawnEffect, Exchange, FrameBlock, FrameContext, Output, Outputs, PutPart,
        Stages, Traits, flag,
    },
};

/// Fog of a view.
pub(crate) struct FogView {
    /// Block with [`LowAirUniform`].
    block: UniformBlock,
    /// Content of the block.
    uniform: Box<LowAirUniform>,
    /// Fog of the frame outside all banks.
    model: Option<FogModel>,
    /// Fog banks of the frame.
    banks: FogBanks,
    /// Features that shaders need to draw the fog; `None` if there is no fog.
    variant: Option<FogVariant>,
    /// Whether the driver is a software driver, which executes both sides of every branch.
    software: bool,
}

impl FogView {
    /// Creates the fog of a view, without fog at first.
    pub fn new(device: &Device, blocks: &Blocks) -> Self {
        let block = blocks.block(device, size_of::<LowAirUniform>());
        Self {
            block,
            uniform: Box::default(),
            model: None,
            banks: FogBanks::new(),
            variant: None,
            software: device.caps().software,
        }
    }
}

impl DrawnEffect for FogView {
    fn gathers(&self) -> Exchange {
        Exchange { gives: &[Output::FogDepth], ..Exchange::NONE }
    }

    fn gather(&mut self, context: &FrameContext<'_>, given: &mut Outputs) -> Result<()> {
        let (now, law) = (context.now, context.held.of::<HeldFog>()?.law.as_ref());
        let here = now.scene.fog_model(law, now.seed, now.planet_radius_m)?;
        given.fog_depth = here.depth_above(now.scene.place.altitude_m);
        // A fog law of the host applies at all places.
        self.banks.gather(context, law.is_some())?;
        let model = self.model.insert(here);
        if !self.banks.list().is_empty() {
            *model = now.scene.with_fog(now.outer_fog).fog_model(law, now.seed, now.planet_radius_m)?;
        }
        model.set_detour(now.detour.clone());
        // A GPU keeps one pipeline for all fogs, because exchanging it would cost a hitch when the weather changes.
        // Detours and banks are exceptions: few scenes have them, and they would cost registers in all others.
        let is_there = model.kind != FogKind::Clear || model.falling.extinction > 0.0 || self.banks.any_seen();
        let least = if self.software { model.variant() } else { FogVariant::all_of(model) };
        self.variant = is_there.then(|| least.with_banks(&self.banks, self.software));
        Ok(())
    }

    fn stages(&self) -> Stages {
        if self.variant.is_some() { Stages::MEDIUM } else { Stages(0) }
    }

    fn parts(&mut self, _: &DrawContext<'_>, stages: Stages, put: &mut PutPart<'_>) {
        let is_there = self.variant.is_some() && stages.has(Stages::MEDIUM);
        put(&candidates::FOG, is_there, &[candidates::FOG_WORK]);
    }

    fn compose(&mut self, context: &DrawContext<'_>, _given: &Outputs, added: &mut Contribution) -> Result<()> {
        let share = context.share(&candidates::FOG, 0);
        let least = self.variant.filter(|_| share > 0.0);
        added.between_and_veil("FOG", flag(self.variant.is_some()), flag(least.is_some()));
        let banks = self.variant.is_some_and(|variant| variant.bank_shapes != 0);
        let traits = |veils_all| Traits { veils_all, ..Traits::default() };
        added.set_traits(traits(self.variant.is_some()), traits(least.is_some()));
        added.between_and_veil("BY_PLACE", flag(banks), flag(banks));
        let [whole, least] = [self.variant, least].map(|variant| variant.unwrap_or(FogVariant::ALL));
        let values = |variant: FogVariant| variant.constants().into_iter().chain(variant.bank_constants());
        for ((name, whole), (_, least)) in values(whole).zip(values(least)) {
            added.between(name, whole, least);
        }
        added.set_frame_block(FrameBlock::Fog { share });
        added.set_block(Block::Between, &self.block);
        if let (Some(model), true) = (&self.model, self.variant.is_some()) {
            self.uniform.set(model);
            self.uniform.set_banks(&self.banks);
            // Writes only the banks that exist.
            self.block.write(&bytemuck::bytes_of(&*self.uniform)[..LowAirUniform::size_with(self.banks.list().len())]);
        }
        Ok(())
    }
}
