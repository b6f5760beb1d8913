//! The composition: the one full-screen draw of a call. Each effect fills in a contribution to it, and the frame
//! merges these contributions.

use std::sync::Arc;

use super::{
    stages::Stages,
    uniform::{BowTable, FlashBlock, FrameBlock, FrameUniformBlock, FrameValues},
};
use crate::{
    gpu::blocks::BlockView,
    surroundings::{ShelterReach, SurroundingsBlock},
};

/// Name and value of an `override` constant.
pub(crate) type Constant = (&'static str, f64);

/// Converts a flag to the value of an `override` constant.
pub(crate) fn flag(b: bool) -> f64 {
    f64::from(u8::from(b))
}

/// Largest number of constants that the effects and the frame together may add.
const MOST: usize = 56;

/// A list of constants, without allocation.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Constants {
    list: [Constant; MOST],
    count: usize,
}

impl Constants {
    /// The empty list.
    pub const NONE: Self = Self { list: [("", 0.0); MOST], count: 0 };

    /// Adds a constant. The list has room for the constants of all effects.
    pub fn push(&mut self, constant: Constant) {
        debug_assert!(self.count < MOST, "room for {constant:?}");
        if let Some(place) = self.list.get_mut(self.count) {
            *place = constant;
            self.count += 1;
        }
    }

    /// All constants of the list.
    pub fn all(&self) -> &[Constant] {
        &self.list[..self.count]
    }

    /// Adds all constants of a slice.
    pub fn extend(&mut self, constants: &[Constant]) {
        constants.iter().for_each(|c| self.push(*c));
    }

    /// Value of the constant `name`; 0 if the list has none of that name.
    pub fn value(&self, name: &str) -> f64 {
        self.all().iter().find(|c| c.0 == name).map_or(0.0, |c| c.1)
    }
}

impl PartialEq for Constants {
    fn eq(&self, other: &Self) -> bool {
        let (own, others) = (self.all(), other.all());
        // A name is mostly the same static string in both lists: comparing addresses is faster than reading text.
        let is_same = |a: &str, b: &str| std::ptr::eq(a, b) || a == b;
        own.len() == others.len() && own.iter().zip(others).all(|(a, b)| a.1 == b.1 && is_same(a.0, b.0))
    }
}

/// Slots for textures of the effects, shared by all draws of the composition. `shaders/frame/composite.wgsl` has their
/// bindings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Texture {
    /// Layer in front of the picture: exposed colour, and cover.
    Before = 0,
    /// Water on the host's terrain, one texel for each cell (`shaders/ground/terrain.wgsl`).
    OnGround = 1,
    /// Slopes, heights, classes and snow of the host's terrain, one texel for each cell
    /// (`shaders/ground/binding.wgsl`).
    Terrain = 2,
    /// Layers of the sky (`shaders/between/sky_sample.wgsl`). The last array layer lies behind the sky's own light; its
    /// texels times [`FrameValues::behind`]`[0]` are radiances, cd/m^2. Two array layers for clouds may precede it:
    /// one with exposed light and transmittance, one with distances.
    Behind = 3,
}

/// Slots for uniform blocks of the effects.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Block {
    /// Block for what lies between the eye and a place; the fog sets it.
    Between = 0,
    /// Block for what lies on surfaces; the ground sets it.
    OnSurfaces = 1,
}

/// Returns the name of the variant of `shader` to use. This is the shader itself if its veil differs from place to
/// place (constant `BY_PLACE`), otherwise the variant `:plain`, which lacks the code for that.
pub(crate) fn veiled(shader: &str, constants: &[Constant]) -> String {
    let by_place = constants.iter().any(|(name, value)| *name == "BY_PLACE" && *value > 0.0);
    format!("{shader}{}", if by_place { "" } else { ":plain" })
}

/// Properties of the weather that select the shader's variant and the kinds of pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Traits {
    /// The weather veils every pixel, including those on which the host drew nothing.
    pub veils_all: bool,
    /// The weather veils what the host drew.
    pub veils_drawn: bool,
    /// Every pixel marches a ray. Separate draws for each kind of pixels would then gain nothing.
    pub is_marched: bool,
    /// The picture contains detail that changes from pixel to pixel, such as stars. The coarse grid cannot hold such
    /// detail.
    pub is_fine: bool,
    /// Each pixel composites clouds over what it looks up in the coarse grid. Fog lies in front of clouds; in weather
    /// with both, the coarse grid is not used.
    pub is_overlaid: bool,
}

impl Traits {
    /// Returns the traits that `self` or `other` has.
    fn or(self, other: Self) -> Self {
        Self {
            veils_all: self.veils_all | other.veils_all,
            veils_drawn: self.veils_drawn | other.veils_drawn,
            is_marched: self.is_marched | other.is_marched,
            is_fine: self.is_fine | other.is_fine,
            is_overlaid: self.is_overlaid | other.is_overlaid,
        }
    }
}

/// Constants of a pipeline, and the traits that come with them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pipeline {
    /// Constants of every shader that applies air, cloud and fog.
    pub between: Constants,
    /// Subset of `between` that the veil for hosts' shaders needs. With all of `between`, many weathers would each need
    /// another pipeline.
    pub of_veil: Constants,
    /// Constants of the composition alone.
    pub composed: Constants,
    /// Traits that the effects state beside their constants.
    pub traits: Traits,
}

impl Pipeline {
    /// Pipeline of a frame without effects.
    pub const NONE: Self = Self {
        between: Constants::NONE,
        of_veil: Constants::NONE,
        composed: Constants::NONE,
        traits: Traits { veils_all: false, veils_drawn: false, is_marched: false, is_fine: false, is_overlaid: false },
    };
}

/// Shaders that a constant is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Scope {
    /// Every shader that applies air, cloud and fog.
    Between,
    /// Every shader that applies air, cloud and fog, and the veil for hosts' shaders.
    BetweenAndVeil,
    /// The composition alone.
    Composition,
}

/// A constant with two values: `whole` for the pipeline that draws every part, `least` for the pipeline without the
/// parts whose drawn share is 0 now.
#[derive(Clone, Copy)]
struct ScopedConstant {
    /// Shaders that the constant is for.
    scope: Scope,
    name: &'static str,
    whole: f64,
    least: f64,
}

/// Largest number of constants of one effect.
const MOST_OF_ONE: usize = 12;

/// Contribution of one effect to a draw. The effect fills it in, and the frame merges the contributions of all effects
/// ([`Composition::merge`]).
pub(crate) struct Contribution {
    constants: [ScopedConstant; MOST_OF_ONE],
    count: usize,
    /// Traits of the pipeline with every part, and of the pipeline without the parts whose drawn share is 0 now.
    traits: [Traits; 2],
    /// Fields that the effect writes into the frame's block.
    block: Option<FrameBlock>,
    flashes: Option<FlashBlock>,
    bows: Option<Arc<[BowTable; 2]>>,
    own_block: Option<(Block, BlockView)>,
    textures: [Option<wgpu::TextureView>; 4],
    tables: Option<(wgpu::BindGroupLayout, wgpu::BindGroup)>,
    needs_panorama: bool,
    near: Option<ShelterReach>,
}

impl Contribution {
    /// A contribution that adds nothing.
    pub fn none() -> Self {
        let none = ScopedConstant { scope: Scope::Composition, name: "", whole: 0.0, least: 0.0 };
        Self {
            constants: [none; MOST_OF_ONE],
            count: 0,
            traits: [Traits::default(); 2],
            block: None,
            flashes: None,
            bows: None,
            own_block: None,
            textures: [const { None }; 4],
            tables: None,
            needs_panorama: false,
            near: None,
        }
    }

    fn push(&mut self, scope: Scope, name: &'static str, whole: f64, least: f64) {
        debug_assert!(self.count < MOST_OF_ONE, "room for {name}");
        if let Some(place) = self.constants.get_mut(self.count) {
            *place = ScopedConstant { scope, name, whole, least };
            self.count += 1;
        }
    }

    /// Adds a constant for every shader that applies air, cloud and fog. `whole` is its value with every part, `least`
    /// its value without the parts whose drawn share is 0 now.
    pub fn between(&mut self, name: &'static str, whole: f64, least: f64) {
        self.push(Scope::Between, name, whole, least);
    }

    /// Adds a constant as [`Self::between`] does, and passes the constant to the veil for hosts' shaders too.
    pub fn between_and_veil(&mut self, name: &'static str, whole: f64, least: f64) {
        self.push(Scope::BetweenAndVeil, name, whole, least);
    }

    /// Adds a constant as [`Self::between`] does, but for the composition alone.
    pub fn constant(&mut self, name: &'static str, whole: f64, least: f64) {
        self.push(Scope::Composition, name, whole, least);
    }

    /// Sets the traits with every part (`whole`), and without the parts whose drawn share is 0 now (`least`).
    pub fn set_traits(&mut self, whole: Traits, least: Traits) {
        self.traits = [whole, least];
    }

    /// Sets the fields that the effect writes into the frame's block.
    pub fn set_frame_block(&mut self, block: FrameBlock) {
        self.block = Some(block);
    }

    /// Sets the light of lightning flashes.
    pub fn set_flashes(&mut self, flashes: FlashBlock) {
        self.flashes = Some(flashes);
    }

    /// Sets the tables of bows ([`super::FrameUniform::bows`]).
    pub fn set_bows(&mut self, bows: &Arc<[BowTable; 2]>) {
        self.bows = Some(bows.clone());
    }

    /// Sets a uniform block of the effect's own.
    pub fn set_block(&mut self, place: Block, block: &BlockView) {
        self.own_block = Some((place, block.clone()));
    }

    /// Sets a texture. At [`Texture::Behind`] and [`Texture::Before`] it replaces the texture that the effect took as
    /// an input.
    pub fn set_texture(&mut self, place: Texture, view: Option<wgpu::TextureView>) {
        self.textures[place as usize] = view;
    }

    /// Whether any star shows.
    pub fn shows_stars(&self) -> bool {
        matches!(self.block, Some(FrameBlock::Stars { behind }) if behind[1] > 0.0)
    }

    /// Texture that the effect has set at a slot, if any.
    pub fn texture(&self, place: Texture) -> Option<&wgpu::TextureView> {
        self.textures[place as usize].as_ref()
    }

    /// Sets the look-up tables of sky, air and fog (group 1).
    pub fn set_tables(&mut self, layout: &wgpu::BindGroupLayout, group: &wgpu::BindGroup) {
        self.tables = Some((layout.clone(), group.clone()));
    }

    /// Requests a panorama: mirrors or a cube map show surroundings that lie outside the picture.
    pub fn require_panorama(&mut self) {
        self.needs_panorama = true;
    }

    /// Sets the reach and the slowest fall speed of the drops or flakes drawn near the camera.
    pub fn set_near(&mut self, reach: ShelterReach) {
        self.near = Some(reach);
    }
}

/// One draw, with everything that the effects have added to it.
pub(crate) struct Composition {
    stages: Stages,
    block: FrameValues,
    bows: Option<Arc<[BowTable; 2]>>,
    whole: Pipeline,
    least: Pipeline,
    blocks: [Option<BlockView>; 2],
    textures: [Option<wgpu::TextureView>; 4],
    tables: Option<(wgpu::BindGroupLayout, wgpu::BindGroup)>,
    needs_panorama: bool,
    near: Option<ShelterReach>,
}

impl Composition {
    /// Creates a composition to which no effect has added anything.
    pub fn new(stages: Stages, block: FrameValues) -> Self {
        Self {
            stages,
            block,
            bows: None,
            whole: Pipeline::NONE,
            least: Pipeline::NONE,
            blocks: [const { None }; 2],
            textures: [const { None }; 4],
            tables: None,
            needs_panorama: false,
            near: None,
        }
    }

    /// Merges the contribution of one effect, and moves the textures, the uniform block and the tables out of it.
    pub fn merge(&mut self, contribution: &mut Contribution) {
        for c in &contribution.constants[..contribution.count] {
            let (whole, least) = ((c.name, c.whole), (c.name, c.least));
            match c.scope {
                Scope::Composition => {
                    self.whole.composed.push(whole);
                    self.least.composed.push(least);
                }
                Scope::Between | Scope::BetweenAndVeil => {
                    self.whole.between.push(whole);
                    self.least.between.push(least);
                }
            }
            if c.scope == Scope::BetweenAndVeil {
                self.whole.of_veil.push(whole);
                self.least.of_veil.push(least);
            }
        }
        let [whole, least] = contribution.traits;
        self.whole.traits = self.whole.traits.or(whole);
        self.least.traits = self.least.traits.or(least);
        if let Some(block) = &contribution.block {
            self.block.merge(block);
        }
        if let Some(flashes) = &contribution.flashes {
            self.block.set_flashes(flashes);
        }
        if contribution.bows.is_some() {
            self.bows = contribution.bows.take();
        }
        if let Some((place, block)) = contribution.own_block.take() {
            self.blocks[place as usize] = Some(block);
        }
        for (place, texture) in self.textures.iter_mut().zip(&mut contribution.textures) {
            if texture.is_some() {
                *place = texture.take();
            }
        }
        if contribution.tables.is_some() {
            self.tables = contribution.tables.take();
        }
        self.needs_panorama |= contribution.needs_panorama;
        self.near = match (self.near, contribution.near) {
            (Some(all), Some(near)) => Some(all.with(near)),
            (all, near) => all.or(near),
        };
    }

    /// Ends the merging. Stage PARTICLES is left out if no effect has a layer in front of the picture. A cube map
    /// (`has_cube_map`) needs a panorama.
    pub fn finish(&mut self, has_cube_map: bool) {
        if self.texture(Texture::Before).is_none() {
            self.stages = self.stages.without(Stages::PARTICLES);
        }
        self.needs_panorama |= has_cube_map;
        self.block.finish();
    }

    /// Adds a constant of the frame itself for every shader that applies air, cloud and fog.
    pub fn set_between(&mut self, name: &'static str, value: f64) {
        self.whole.between.push((name, value));
        self.least.between.push((name, value));
    }

    /// Adds a constant of the frame itself for the composition: its value with every part (`whole`), and without the
    /// parts whose drawn share is 0 now (`least`).
    pub fn set_constant(&mut self, name: &'static str, whole: f64, least: f64) {
        self.whole.composed.push((name, whole));
        self.least.composed.push((name, least));
    }

    /// Removes a stage that has nothing to draw.
    pub fn leave_out(&mut self, stage: Stages) {
        self.stages = self.stages.without(stage);
    }

    /// Sets the number of times that the gauge composes a pixel.
    pub fn set_compositions(&mut self, count: u32) {
        self.block.compositions = count;
    }

    /// Stages that are drawn.
    pub fn stages(&self) -> Stages {
        self.stages
    }

    /// Values of the frame's block.
    pub fn block(&self) -> &FrameValues {
        &self.block
    }

    /// Writes the frame's block.
    pub fn write_block(&self, block: &mut FrameUniformBlock) {
        block.write(&self.block, self.bows.as_deref());
    }

    /// Constants of the pipeline that can draw every part.
    pub fn whole(&self) -> &Pipeline {
        &self.whole
    }

    /// Constants of the pipeline that leaves out the parts whose drawn share is 0 now. On a software driver this
    /// pipeline is cheaper than a branch, because such a driver executes both sides of a branch.
    pub fn least(&self) -> &Pipeline {
        &self.least
    }

    /// Block at a slot, if an effect has set one.
    pub fn own_block(&self, place: Block) -> Option<&BlockView> {
        self.blocks[place as usize].as_ref()
    }

    /// Texture at a slot, if an effect has set one.
    pub fn texture(&self, place: Texture) -> Option<&wgpu::TextureView> {
        self.textures[place as usize].as_ref()
    }

    /// Textures, indexed by [`Texture`].
    pub fn textures(&self) -> &[Option<wgpu::TextureView>; 4] {
        &self.textures
    }

    /// Look-up tables of sky, air and fog (group 1), with their layout.
    pub fn tables(&self) -> Option<(&wgpu::BindGroupLayout, &wgpu::BindGroup)> {
        self.tables.as_ref().map(|(layout, group)| (layout, group))
    }

    /// Whether the frame needs a panorama: mirrors or a cube map show surroundings that lie outside the picture.
    pub fn needs_panorama(&self) -> bool {
        self.needs_panorama
    }

    /// Reach and slowest fall speed of the drops and flakes drawn near the camera; [`ShelterReach::NONE`] if none are
    /// drawn.
    pub fn near(&self) -> ShelterReach {
        self.near.unwrap_or(ShelterReach::NONE)
    }
}

/// A finished composition and the frame's blocks on the GPU, with which the effects' own passes draw.
#[derive(Clone, Copy)]
pub(crate) struct MergedFrame<'a> {
    pub composition: &'a Composition,
    pub block: &'a BlockView,
    pub surroundings: &'a SurroundingsBlock,
}
