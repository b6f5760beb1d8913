//! The one full-screen draw of a call: what each effect contributes to it, and what the frame merges of that.

use super::{
    stages::Stages,
    uniform::{FrameBlock, FrameUniform},
};
use crate::{
    gpu::blocks::BlockView,
    surroundings::{ShelterReach, SurroundingsBlock},
};

/// Name and value of an `override` constant.
pub(crate) type Constant = (&'static str, f64);

/// As the value of an `override` constant.
pub(crate) fn flag(b: bool) -> f64 {
    f64::from(u8::from(b))
}

/// Most constants that the effects may add.
const MOST: usize = 56;

/// A list of constants, without allocation.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Constants {
    list: [Constant; MOST],
    count: usize,
}

impl Constants {
    /// None.
    pub const NONE: Self = Self { list: [("", 0.0); MOST], count: 0 };

    /// Adds one. There is room for those of all effects.
    pub fn push(&mut self, constant: Constant) {
        debug_assert!(self.count < MOST, "room for {constant:?}");
        if let Some(place) = self.list.get_mut(self.count) {
            *place = constant;
            self.count += 1;
        }
    }

    /// All of them.
    pub fn all(&self) -> &[Constant] {
        &self.list[..self.count]
    }

    /// Adds all of a list.
    pub fn extend(&mut self, constants: &[Constant]) {
        constants.iter().for_each(|c| self.push(*c));
    }

    /// The value of one, 0 where there is none of that name.
    pub fn value(&self, name: &str) -> f64 {
        self.all().iter().find(|c| c.0 == name).map_or(0.0, |c| c.1)
    }
}

impl PartialEq for Constants {
    fn eq(&self, other: &Self) -> bool {
        self.all() == other.all()
    }
}

/// Places for textures of the effects, which all that are drawn alike share. Their bindings are those of
/// `shaders/frame/composite.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Texture {
    /// A layer before the picture: colour with the exposure on it, and cover.
    Before = 0,
    /// Cover that lies on the ground, by cells of the host's terrain.
    OnGround = 1,
    /// Heights and classes of the host's terrain.
    Terrain = 2,
    /// Layers of the sky. The last is what stands behind the sky's own light: radiance over [`FrameUniform::behind`].
    /// Before it may be two of what hangs before the sky: light with the exposure on it and what it lets through, and
    /// how far away it is (`shaders/between/hung.wgsl`).
    Behind = 3,
}

/// Places for blocks of the effects.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Block {
    /// Block of what lies between the eye and a place.
    Between = 0,
    /// Block of what lies on surfaces.
    OnSurfaces = 1,
}

/// Properties of the weather that select the shader's variant and the kinds of pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Traits {
    /// Something lies before every pixel, those too on which the host drew nothing.
    pub veils_all: bool,
    /// Something lies before what the host drew.
    pub veils_drawn: bool,
    /// Rays are marched in every pixel alike: nothing is gained by a draw for each kind of pixels.
    pub is_marched: bool,
    /// Something is in the picture that changes from pixel to pixel, as stars do: it cannot be looked up in a grid.
    pub is_fine: bool,
    /// Each pixel lays clouds over what it looks up in the grid. Fog lies before clouds: where both are, nothing is
    /// looked up.
    pub is_overlaid: bool,
}

impl Traits {
    /// Returns the traits that either has.
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

/// The constants of a pipeline, and what follows of them for the frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pipeline {
    /// Constants of every shader that applies air, cloud and fog.
    pub between: Constants,
    /// Subset that the veil for hosts' shaders needs; the full set would compile a pipeline for many weathers.
    pub of_veil: Constants,
    /// Constants of the composition alone.
    pub composed: Constants,
    /// Traits that the effects state beside their constants.
    pub traits: Traits,
}

impl Pipeline {
    /// None.
    pub const NONE: Self = Self {
        between: Constants::NONE,
        of_veil: Constants::NONE,
        composed: Constants::NONE,
        traits: Traits { veils_all: false, veils_drawn: false, is_marched: false, is_fine: false, is_overlaid: false },
    };
}

/// The shaders that a constant is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Scope {
    /// Every shader that applies air, cloud and fog.
    Between,
    /// Every shader that applies air, cloud and fog, and the veil for hosts' shaders.
    BetweenAndVeil,
    /// The composition alone.
    Composition,
}

/// A constant: its value where every part is drawn, and where only what shows now is.
#[derive(Clone, Copy)]
struct ScopedConstant {
    scope: Scope,
    name: &'static str,
    whole: f64,
    least: f64,
}

/// Most constants of one effect.
const MOST_OF_ONE: usize = 12;

/// Contribution of one effect to a draw. The effect returns it; the frame merges those of all effects
/// ([`Composition::merge`]).
pub(crate) struct Contribution<'a> {
    constants: [ScopedConstant; MOST_OF_ONE],
    count: usize,
    /// Where every part is drawn, and where only what shows now is.
    traits: [Traits; 2],
    /// Its fields of the frame's block.
    block: Option<FrameBlock<'a>>,
    own_block: Option<(Block, BlockView)>,
    textures: [Option<wgpu::TextureView>; 4],
    tables: Option<(wgpu::BindGroupLayout, wgpu::BindGroup)>,
    needs_panorama: bool,
    near: Option<ShelterReach>,
}

impl<'a> Contribution<'a> {
    /// Nothing.
    pub fn none() -> Self {
        let none = ScopedConstant { scope: Scope::Composition, name: "", whole: 0.0, least: 0.0 };
        Self {
            constants: [none; MOST_OF_ONE],
            count: 0,
            traits: [Traits::default(); 2],
            block: None,
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

    /// Adds a constant of what lies between: its value where every part is drawn, and where only what shows now is.
    pub fn between(&mut self, name: &'static str, whole: f64, least: f64) {
        self.push(Scope::Between, name, whole, least);
    }

    /// Adds as [`Self::between`] does, to the constants of the veil too.
    pub fn between_and_veil(&mut self, name: &'static str, whole: f64, least: f64) {
        self.push(Scope::BetweenAndVeil, name, whole, least);
    }

    /// Adds as [`Self::between`] does a constant of the composition alone.
    pub fn constant(&mut self, name: &'static str, whole: f64, least: f64) {
        self.push(Scope::Composition, name, whole, least);
    }

    /// Says what is in the picture where every part is drawn, and where only what shows now is.
    pub fn set_traits(&mut self, whole: Traits, least: Traits) {
        self.traits = [whole, least];
    }

    /// Gives its fields of the frame's block.
    pub fn set_frame_block(&mut self, block: FrameBlock<'a>) {
        self.block = Some(block);
    }

    /// Gives a block of its own.
    pub fn set_block(&mut self, place: Block, block: &BlockView) {
        self.own_block = Some((place, block.clone()));
    }

    /// Gives a texture. At [`Texture::Behind`] and [`Texture::Before`] it takes the place of what it names as its
    /// input.
    pub fn set_texture(&mut self, place: Texture, view: Option<wgpu::TextureView>) {
        self.textures[place as usize] = view;
    }

    /// Whether any of the stars shows.
    pub fn shows_stars(&self) -> bool {
        matches!(self.block, Some(FrameBlock::Stars { behind }) if behind[1] > 0.0)
    }

    /// The texture that it gives at a place.
    pub fn texture(&self, place: Texture) -> Option<&wgpu::TextureView> {
        self.textures[place as usize].as_ref()
    }

    /// Gives the look-up tables of what lies behind and between.
    pub fn set_tables(&mut self, layout: &wgpu::BindGroupLayout, group: &wgpu::BindGroup) {
        self.tables = Some((layout.clone(), group.clone()));
    }

    /// Says that something shows what stands about the camera outside of the picture too: mirrors, a cube map.
    pub fn require_panorama(&mut self) {
        self.needs_panorama = true;
    }

    /// Says which drops or flakes are drawn near the camera.
    pub fn set_near(&mut self, reach: ShelterReach) {
        self.near = Some(reach);
    }
}

/// A draw with what all effects have added to it.
pub(crate) struct Composition {
    stages: Stages,
    block: FrameUniform,
    whole: Pipeline,
    least: Pipeline,
    blocks: [Option<BlockView>; 2],
    textures: [Option<wgpu::TextureView>; 4],
    tables: Option<(wgpu::BindGroupLayout, wgpu::BindGroup)>,
    needs_panorama: bool,
    near: Option<ShelterReach>,
}

impl Composition {
    /// With nothing of any effect.
    pub fn new(stages: Stages, block: FrameUniform) -> Self {
        Self {
            stages,
            block,
            whole: Pipeline::NONE,
            least: Pipeline::NONE,
            blocks: [const { None }; 2],
            textures: [const { None }; 4],
            tables: None,
            needs_panorama: false,
            near: None,
        }
    }

    /// Takes what one effect adds out of its contribution.
    pub fn merge(&mut self, contribution: &mut Contribution<'_>) {
        for c in &contribution.constants[..contribution.count] {
            for (pipeline, value) in [(&mut self.whole, c.whole), (&mut self.least, c.least)] {
                let constant = (c.name, value);
                match c.scope {
                    Scope::Between => pipeline.between.push(constant),
                    Scope::BetweenAndVeil => {
                        pipeline.between.push(constant);
                        pipeline.of_veil.push(constant);
                    }
                    Scope::Composition => pipeline.composed.push(constant),
                }
            }
        }
        let [whole, least] = contribution.traits;
        self.whole.traits = self.whole.traits.or(whole);
        self.least.traits = self.least.traits.or(least);
        if let Some(block) = &contribution.block {
            self.block.merge(block);
        }
        if let Some((place, block)) = contribution.own_block.take() {
            self.blocks[place as usize] = Some(block);
        }
        for (place, texture) in self.textures.iter_mut().zip(&mut contribution.textures) {
            *place = texture.take().or(place.take());
        }
        self.tables = contribution.tables.take().or(self.tables.take());
        self.needs_panorama |= contribution.needs_panorama;
        self.near = match (self.near, contribution.near) {
            (Some(all), Some(near)) => Some(all.with(near)),
            (all, near) => all.or(near),
        };
    }

    /// Ends the merging: there is no stage of what falls where no effect has a layer before the picture.
    pub fn finish(&mut self, has_cube_map: bool) {
        if self.texture(Texture::Before).is_none() {
            self.stages = self.stages.without(Stages::PARTICLES);
        }
        self.needs_panorama |= has_cube_map;
        self.block.finish();
    }

    /// Adds a constant of the frame's own to what lies between.
    pub fn set_between(&mut self, name: &'static str, value: f64) {
        self.whole.between.push((name, value));
        self.least.between.push((name, value));
    }

    /// Adds a constant of the frame's own to the composition: its value where every part is drawn, and where only what
    /// shows now is.
    pub fn set_constant(&mut self, name: &'static str, whole: f64, least: f64) {
        self.whole.composed.push((name, whole));
        self.least.composed.push((name, least));
    }

    /// Takes out a stage that has nothing to draw.
    pub fn leave_out(&mut self, stage: Stages) {
        self.stages = self.stages.without(stage);
    }

    /// Says how many draws of the same kind the planner counts.
    pub fn set_compositions(&mut self, count: u32) {
        self.block.compositions = count;
    }

    /// Stages that are drawn.
    pub fn stages(&self) -> Stages {
        self.stages
    }

    /// The frame's block.
    pub fn block(&self) -> &FrameUniform {
        &self.block
    }

    /// Constants of a pipeline that can draw every part.
    pub fn whole(&self) -> &Pipeline {
        &self.whole
    }

    /// Constants of a pipeline without the parts of which nothing is drawn now: cheaper than a branch on a software
    /// driver, which takes both ways.
    pub fn least(&self) -> &Pipeline {
        &self.least
    }

    /// The block at a place, if an effect has given one.
    pub fn own_block(&self, place: Block) -> Option<&BlockView> {
        self.blocks[place as usize].as_ref()
    }

    /// The texture at a place, if an effect has given one.
    pub fn texture(&self, place: Texture) -> Option<&wgpu::TextureView> {
        self.textures[place as usize].as_ref()
    }

    /// Textures by [`Texture`].
    pub fn textures(&self) -> &[Option<wgpu::TextureView>; 4] {
        &self.textures
    }

    /// Look-up tables of what lies behind and between (group 1), and their layout.
    pub fn tables(&self) -> Option<(&wgpu::BindGroupLayout, &wgpu::BindGroup)> {
        self.tables.as_ref().map(|(layout, group)| (layout, group))
    }

    /// Whether something shows what stands about the camera outside of the picture too.
    pub fn needs_panorama(&self) -> bool {
        self.needs_panorama
    }

    /// Drops and flakes that are drawn near the camera.
    pub fn near(&self) -> ShelterReach {
        self.near.unwrap_or(ShelterReach::NONE)
    }
}

/// A finished composition with the frame's blocks on the GPU: what the effects' own passes draw with.
#[derive(Clone, Copy)]
pub(crate) struct MergedFrame<'a> {
    pub composition: &'a Composition,
    pub block: &'a BlockView,
    pub surroundings: &'a SurroundingsBlock,
}
