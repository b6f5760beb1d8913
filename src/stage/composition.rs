//! What the effects add to the one full-screen draw of a call.

use super::{FrameUniform, Stages};
use crate::{gpu::blocks::BlockView, surroundings::ShelterReach};

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
    /// What lies on the ground, by cells of the host's terrain.
    OnGround = 1,
    /// Heights and classes of the host's terrain.
    Terrain = 2,
    /// Layers of the sky. The last is what stands behind the sky's own light: radiance over [`FrameUniform::behind`]. Before it may be
    /// two of what hangs before the sky: light with the exposure on it and what it lets through, and how far away it is
    /// (`shaders/between/hung.wgsl`).
    Behind = 3,
}

/// Places for blocks of the effects.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Block {
    /// Of what lies between the eye and a place.
    Between = 0,
    /// Of what lies on surfaces.
    OnSurfaces = 1,
}

/// Properties of the weather that select the shader's variant and the kinds of pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Traits {
    /// Something lies before every pixel, those too on which the host drew nothing.
    pub veils_all: bool,
    /// Something lies before what the host drew.
    pub veils_drawn: bool,
    /// Rays are marched in every pixel alike: nothing is gained by a draw for each kind of pixels.
    pub is_marched: bool,
    /// Something is in the picture that changes from pixel to pixel, as stars do: it cannot be looked up in a grid.
    pub is_fine: bool,
    /// Each pixel lays clouds over what it looks up in the grid. Fog lies before clouds: where both are, nothing is looked up.
    pub is_overlaid: bool,
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
    /// Set by the effects beside their constants.
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

/// What the effects add to the composition.
pub(crate) struct Composition {
    /// Stages that are drawn; an effect takes out its own where there turns out to be nothing.
    pub stages: Stages,
    /// Stages of the call: where another effect finds nothing to draw, one may put a stage back that was asked for.
    pub asked: Stages,
    /// The frame's block.
    pub block: FrameUniform,
    /// Constants of a pipeline that can draw every part.
    pub whole: Pipeline,
    /// Those without the parts of which nothing is drawn now: cheaper than a branch on a software driver, which takes both ways.
    pub least: Pipeline,
    /// Buffers by [`Block`].
    pub blocks: [Option<BlockView>; 2],
    /// Textures by [`Texture`].
    pub textures: [Option<wgpu::TextureView>; 4],
    /// Look-up tables of what lies behind and between (group 1), and their layout.
    pub tables: Option<(wgpu::BindGroupLayout, wgpu::BindGroup)>,
    /// Something shows what stands about the camera outside of the picture too: mirrors, a cube map.
    pub needs_panorama: bool,
    /// Drops and flakes that are drawn near the camera.
    pub near: ShelterReach,
}

impl Composition {
    /// With nothing of any effect.
    pub fn new(stages: Stages, block: FrameUniform) -> Self {
        Self {
            stages,
            asked: stages,
            block,
            whole: Pipeline::NONE,
            least: Pipeline::NONE,
            blocks: [const { None }; 2],
            textures: [const { None }; 4],
            tables: None,
            needs_panorama: false,
            near: ShelterReach::NONE,
        }
    }

    /// Adds a constant of what lies between: its value where every part is drawn, and where only what shows now is.
    pub fn between(&mut self, name: &'static str, whole: f64, least: f64) {
        self.whole.between.push((name, whole));
        self.least.between.push((name, least));
    }

    /// Adds as [`Self::between`] does, to the constants of the veil too.
    pub fn between_and_veil(&mut self, name: &'static str, whole: f64, least: f64) {
        self.between(name, whole, least);
        self.whole.of_veil.push((name, whole));
        self.least.of_veil.push((name, least));
    }

    /// Adds a constant of the composition alone, likewise.
    pub fn constant(&mut self, name: &'static str, whole: f64, least: f64) {
        self.whole.composed.push((name, whole));
        self.least.composed.push((name, least));
    }

    /// Says that something is in the picture that changes from pixel to pixel.
    pub fn mark_fine(&mut self) {
        (self.whole.traits.is_fine, self.least.traits.is_fine) = (true, true);
    }

    /// Says that each pixel has clouds to lay over what it looks up.
    pub fn mark_overlaid(&mut self) {
        (self.whole.traits.is_overlaid, self.least.traits.is_overlaid) = (true, true);
    }

    /// Gives a block.
    pub fn set_block(&mut self, place: Block, block: &BlockView) {
        self.blocks[place as usize] = Some(block.clone());
    }

    /// The texture at a place, if an effect has given one.
    pub fn texture(&self, place: Texture) -> Option<&wgpu::TextureView> {
        self.textures[place as usize].as_ref()
    }

    /// Gives a texture.
    pub fn set_texture(&mut self, place: Texture, view: Option<wgpu::TextureView>) {
        self.textures[place as usize] = view;
    }
}
