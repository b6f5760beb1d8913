//! Draws that together make the picture of a weather: the coarse grid and its cells, and one draw for each kind of
//! pixels. A view keeps them, because searching all pipelines for one takes longer than recording a draw.

use std::sync::Arc;

use super::{
    composite::Composite,
    even::{self, CoarseWeather},
    kinds::{self, KindAttachment},
    pixel_kind::Pixels,
    variant::Variant,
};
use crate::{
    error::{Error, Result},
    gpu::{Device, pass},
    stage::Pipeline,
};

/// Number of calls of a frame whose draws a view keeps.
pub(in crate::frame) const MOST_DRAWS: usize = 4;

/// Key of the draws in their cache.
pub(in crate::frame) struct DrawKey {
    pub of: Variant,
    pub has_grid: bool,
}

impl DrawKey {
    /// Whether this is the key of a variant with these constants.
    pub fn is(&self, variant: &Variant<()>, constants: &Pipeline, has_grid: bool) -> bool {
        self.has_grid == has_grid && self.of.is_with(variant, constants)
    }
}

/// Pipelines of a variant's draws.
pub(in crate::frame) struct Draws {
    /// Pipelines of the grid and its cells, if any pixel is interpolated.
    even: Option<[wgpu::RenderPipeline; 2]>,
    pixels: Kinds,
}

/// Pipelines for the pixels of a picture.
enum Kinds {
    /// One draw of all pixels.
    One(wgpu::RenderPipeline),
    /// A draw that writes the kinds of the pixels, and one for each kind.
    Several(Vec<wgpu::RenderPipeline>),
    /// No pixel changes.
    None,
}

/// Reason for which a variant has no draws yet.
pub(in crate::frame) enum PipelineNotReady {
    /// Not all pipelines are compiled yet; until they are, a single draw takes their place.
    Coming(Draws),
    Failed(Error),
}

impl From<Error> for PipelineNotReady {
    fn from(error: Error) -> Self {
        Self::Failed(error)
    }
}

impl Draws {
    /// Returns the draws of a variant. Missing pipelines are compiled in this call, except for a picture with a coarse
    /// grid unless `at_once`: then each call compiles one large pipeline, and until all are compiled the result is a
    /// single draw of all pixels ([`PipelineNotReady`]). `splits` is passed on to [`kinds::draws`].
    ///
    /// # Errors
    /// [`PipelineNotReady::Coming`] with the single draw; [`PipelineNotReady::Failed`] for a missing shader file.
    pub fn new(
        device: &Arc<Device>,
        composite: &mut Composite,
        drawn: &DrawKey,
        (splits, at_once): (bool, bool),
    ) -> std::result::Result<Self, PipelineNotReady> {
        let of = &drawn.of;
        let draws = kinds::draws(of, drawn.has_grid && even::may_be(of), splits);
        let looks_up = draws.iter().flatten().any(|variant| variant.pixels.are_even());
        if looks_up && !at_once {
            let all = Variant { pixels: Pixels::All, ..*of };
            let each = draws.iter().flatten().copied().chain([even::grid_of(of)]);
            let mut missing = [all].into_iter().chain(each).filter(|variant| !composite.has(variant));
            if let (Some(next), more) = (missing.next(), missing.next().is_some()) {
                composite.pipeline(device, next)?;
                if more {
                    let one = Kinds::One(composite.pipeline(device, all)?.clone());
                    return Err(PipelineNotReady::Coming(Self { even: None, pixels: one }));
                }
            }
        }
        Self::whole(device, composite, of, (draws, looks_up)).map_err(PipelineNotReady::Failed)
    }

    /// Returns all draws, and compiles the pipelines that are missing.
    fn whole(
        device: &Arc<Device>,
        composite: &mut Composite,
        all: &Variant,
        (draws, looks_up): ([Option<Variant>; kinds::DRAWS], bool),
    ) -> Result<Self> {
        let is_one = draws.iter().flatten().all(|variant| variant.pixels == Pixels::All);
        let even = looks_up.then(|| composite.even(device, all)).transpose()?;
        let mut pipelines = Vec::new();
        for variant in draws.into_iter().flatten() {
            pipelines.push(composite.pipeline(device, variant)?.clone());
        }
        if is_one {
            return Ok(Self { even, pixels: pipelines.pop().map_or(Kinds::None, Kinds::One) });
        }
        pipelines.insert(0, composite.kinds(device, all, looks_up)?.clone());
        Ok(Self { even, pixels: Kinds::Several(pipelines) })
    }

    /// Records the draws with the images that the view holds for a picture. Returns the number of passes.
    pub fn record(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        (attachment, grid): (Option<&KindAttachment>, Option<&CoarseWeather>),
        groups: &[&wgpu::BindGroup; 3],
        target: &wgpu::TextureView,
    ) -> u32 {
        match (&self.pixels, attachment) {
            (Kinds::One(pipeline), _) => {
                pass::draw(encoder, "composite", pipeline, groups, target);
                1
            }
            (Kinds::Several(pipelines), Some(attachment)) => match (&self.even, grid) {
                (Some([weather, cells]), Some(grid)) => {
                    grid.draw(encoder, [weather, cells], groups);
                    let [frame, between, around] = *groups;
                    attachment.draw(encoder, pipelines.iter(), &[frame, between, around, &grid.group], target);
                    3
                }
                _ => {
                    attachment.draw(encoder, pipelines.iter(), groups, target);
                    1
                }
            },
            _ => 0,
        }
    }
}
