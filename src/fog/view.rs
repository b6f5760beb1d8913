//! What a view draws of the fog: its block of numbers, and the constants of the composition.

use super::{FogKind, FogModel, FogVariant, Law, LowAirUniform, candidates};
use crate::{
    error::Result,
    gpu::{
        Device,
        blocks::{Blocks, UniformBlock},
    },
    moment::Moment,
    stage::{Block, Composition, DrawnEffect, PutPart, Shot, Stages, flag},
};

/// The fog of a view.
pub(crate) struct FogView {
    block: UniformBlock,
    uniform: Box<LowAirUniform>,
    model: Option<FogModel>,
    /// What shaders must be able to draw of it, if there is any.
    variant: Option<FogVariant>,
    /// A software driver takes both ways of every branch.
    software: bool,
}

impl FogView {
    pub fn new(device: &Device, blocks: &Blocks) -> Self {
        let block = blocks.block(device, size_of::<LowAirUniform>());
        Self { block, uniform: Box::default(), model: None, variant: None, software: device.caps().software }
    }

    /// Takes the fog of a moment, by the host's `law` if it asked for one.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] naming the parameter.
    pub fn gather(&mut self, now: &Moment<'_>, law: Option<&Law>) -> Result<()> {
        let model = now.scene.fog_model(law, now.seed, now.planet_radius_m)?.led_by(now.detour.clone());
        // A GPU keeps one pipeline for all fogs: exchanging it would cost a hitch when the weather changes. Detours, which few scenes
        // have, would cost every other one registers.
        self.variant = (model.kind != FogKind::Clear || model.falling.extinction > 0.0)
            .then(|| if self.software { model.variant() } else { FogVariant::all_of(&model) });
        self.model = Some(model);
        Ok(())
    }

    /// Optical depth straight up from an altitude; see [`FogModel::depth_above`].
    pub fn depth_above(&self, altitude_m: f64) -> f64 {
        self.model.as_ref().map_or(0.0, |model| model.depth_above(altitude_m))
    }
}

impl DrawnEffect for FogView {
    fn stages(&self) -> Stages {
        if self.variant.is_some() { Stages::MEDIUM } else { Stages(0) }
    }

    fn parts(&mut self, _: &Shot<'_>, stages: Stages, put: &mut PutPart<'_>) {
        let is_there = self.variant.is_some() && stages.has(Stages::MEDIUM);
        put(&candidates::FOG, is_there, &[candidates::FOG_WORK]);
    }

    fn compose(&mut self, shot: &Shot<'_>, to: &mut Composition) -> Result<()> {
        let share = shot.share(&candidates::FOG, 0);
        let least = self.variant.filter(|_| share > 0.0);
        to.between_and_veil("FOG", flag(self.variant.is_some()), flag(least.is_some()));
        (to.whole.traits.veils_all, to.least.traits.veils_all) = (self.variant.is_some(), least.is_some());
        let whole = self.variant.unwrap_or(FogVariant::ALL).constants();
        for ((name, whole), (_, least)) in whole.into_iter().zip(least.unwrap_or(FogVariant::ALL).constants()) {
            to.between(name, whole, least);
        }
        to.block.drawn[1] = share;
        to.set_block(Block::Between, &self.block);
        if let (Some(model), true) = (&self.model, self.variant.is_some()) {
            self.uniform.set(model);
            self.block.write(bytemuck::bytes_of(&*self.uniform));
        }
        Ok(())
    }
}
