//! Passes of a picture's clouds: march the rays of some pixels, reproject each square of pixels from the last frame,
//! and resolve the whole picture from both. The panorama of clouds in all directions is drawn too where a mirror or a
//! cube map shows it.

use std::sync::Arc;

use super::{
    drawn::{
        picture::{BEHIND, Picture, marched},
        pipelines::{March, PassTargets, Pipelines, Resolve, TargetPart, run, run_each},
        tables::CloudTables,
        uniforms::{CloudsUniform, PictureUniform, ShadowUniform},
    },
    field::layers::CloudLayers,
    light::lamps::{LampsUniform, glow_size},
    maps::{
        panorama::{CloudPanorama, PanoramaInputs},
        shadow_map::ShadowMap,
        shadow_projection::{HistoryUse, ShadowProjection},
    },
};
use crate::{
    error::Result,
    gpu::{
        Device, Layer, bind,
        blocks::{BlockView, Blocks, UniformBlock},
    },
};

/// Passes of a view, with their resources.
pub(super) struct CloudPasses {
    /// Look-up tables that the passes read.
    pub tables: CloudTables,
    /// Allocator of the uniform blocks.
    pages: Blocks,
    /// Block with [`CloudsUniform`].
    block: UniformBlock,
    /// Block with [`PictureUniform`].
    picture_block: UniformBlock,
    /// Pipelines, created at the first draw.
    pipelines: Option<Pipelines>,
    /// Textures of the picture, of its present size.
    picture: Option<Picture>,
    /// Key and bind group of the march. The key is the bind group of the sky's tables and whether the shadow map is
    /// bound.
    marched_of: Option<(wgpu::BindGroup, bool, wgpu::BindGroup)>,
    /// Shadow map, created when clouds first cast shadows.
    shadows: Option<ShadowMap>,
    /// Panorama of clouds in all directions.
    round: Option<CloudPanorama>,
    /// Key and bind group of the pass that applies shadows. The key is the host's depth texture and its layer.
    shaded: Option<(Option<(wgpu::Texture, u32)>, wgpu::BindGroup)>,
    /// Placeholder texture for inputs that a frame lacks.
    none: wgpu::TextureView,
    /// Placeholder for a texture of several layers.
    no_layers: wgpu::TextureView,
    /// Placeholder block where there is no shadow map.
    no_block: UniformBlock,
    /// Block with [`LampsUniform`].
    lamps_block: UniformBlock,
    /// Whether some clouds have local cover ([`super::field::placed`]).
    is_placed: bool,
}

/// Inputs of the pass that applies shadows: the shadow map's placement, and the depth of the surfaces.
pub(super) struct Shaded<'a> {
    /// Placement of the shadow map.
    pub projection: ShadowProjection,
    /// The host's depth.
    pub depth: Layer<'a>,
}

/// Passes that this frame still needs, after those that its earlier calls have drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Wanted {
    /// Whether an earlier call has begun the frame.
    pub is_begun: bool,
    /// Whether to march rays.
    pub march: bool,
    /// Whether to resolve the whole picture.
    pub resolve: bool,
    /// Whether to draw the panorama.
    pub round: bool,
    /// Whether the picture shows the panorama.
    pub shows_round: bool,
}

/// Inputs of the passes.
pub(super) struct CloudFrame<'a> {
    /// Passes to draw in this frame.
    pub wanted: Wanted,
    /// Block with the clouds of the frame.
    pub clouds: CloudsUniform,
    /// Reprojection, and the pixels that this frame marches.
    pub picture: PictureUniform,
    /// Uniform block of the frame.
    pub frame: &'a BlockView,
    /// The sky's tables: layout and bind group.
    pub sky: (&'a wgpu::BindGroupLayout, &'a wgpu::BindGroup),
    /// Texture of the light behind the sky's own light: stars and the glow between them.
    pub behind: Option<&'a wgpu::Texture>,
    /// Inputs of the shadows; `None` without shadows.
    pub shaded: Option<Shaded<'a>>,
    /// Whether shafts of light are drawn: the air in front of the surfaces is shaded too.
    pub has_shafts: bool,
    /// Lamps and flashes that light the clouds.
    pub lamps: Option<LampsUniform>,
    /// Inputs of the panorama.
    pub around: PanoramaInputs,
    /// Fineness of the march ([`super::CloudSettings`]).
    pub fineness: f64,
    /// Whether some clouds are blurred (`CloudLayers::is_coarse`).
    pub is_coarse: bool,
    /// Use that the frame makes of earlier frames.
    pub past: HistoryUse,
    /// Whether the host's depth has several samples a pixel.
    pub is_multisampled: bool,
    /// Kinds of depth that the host's depth texture may hold (`Rays::depth_kinds`).
    pub depth_kinds: f64,
}

impl CloudPasses {
    /// Creates the passes with the noise of a seed.
    pub fn new((device, blocks): (&Arc<Device>, &Blocks), seed: u64) -> Result<Self> {
        let none = bind::nothing(&device.device, wgpu::TextureFormat::Rgba8Unorm);
        Ok(Self {
            no_layers: bind::no_layers(&device.device),
            none,
            tables: CloudTables::new(device, seed)?,
            pages: blocks.clone(),
            block: blocks.block(device, size_of::<CloudsUniform>()),
            picture_block: blocks.block(device, size_of::<PictureUniform>()),
            pipelines: None,
            picture: None,
            marched_of: None,
            shadows: None,
            round: None,
            shaded: None,
            no_block: blocks.block(device, size_of::<ShadowUniform>()),
            lamps_block: blocks.block(device, size_of::<LampsUniform>()),
            is_placed: false,
        })
    }

    /// Writes the hosts' cover maps into the tables. If the maps' texture was created again, or local cover has begun
    /// or ended, drops the bindings and the panorama and creates the shadow map again in its texture.
    pub fn place(&mut self, device: &Device, overhead: &CloudLayers) -> Result<()> {
        let is_other = self.tables.place(device, overhead.maps.iter().flatten());
        if !is_other && self.is_placed == overhead.is_placed() {
            return Ok(());
        }
        self.is_placed = overhead.is_placed();
        (self.marched_of, self.round, self.shaded) = (None, None, None);
        if let Some(map) = self.shadows.take() {
            self.shadows = Some(self.shadow_map(device, map.view.texture())?);
        }
        Ok(())
    }

    /// Creates the shadow map in a texture.
    fn shadow_map(&self, device: &Device, texture: &wgpu::Texture) -> Result<ShadowMap> {
        ShadowMap::new((device, &self.pages), &self.tables, (&self.block, self.is_placed), texture)
    }

    /// Creates textures for a picture of `size` pixels, in squares of `side` x `side` pixels, unless the earlier ones
    /// have this size. Returns whether the earlier ones are kept.
    pub fn hold(&mut self, device: &Device, size: (u32, u32), side: u32) -> bool {
        if self.picture.as_ref().is_some_and(|p| p.of == (size, side)) {
            return true;
        }
        self.picture = Some(Picture::new(device, size, side));
        false
    }

    /// Drops the textures that depend on the picture's size.
    pub fn forget(&mut self) {
        self.picture = None;
    }

    /// Returns the layers that the composition reads: those that this draw writes, or the last that were written.
    pub fn layers(&self, wanted: &Wanted) -> Option<wgpu::TextureView> {
        let picture = self.picture.as_ref()?;
        let which = if wanted.resolve { picture.to_make(wanted.is_begun) } else { picture.newest };
        Some(picture.whole[which].layers.clone())
    }

    /// Returns the bytes of GPU memory in use.
    pub fn bytes(&self) -> u64 {
        let shadows = self.shadows.as_ref().map_or(0, |_| ShadowMap::BYTES);
        let round = self.round.as_ref().map_or(0, |_| CloudPanorama::BYTES);
        self.tables.bytes() + shadows + round + self.picture.as_ref().map_or(0, Picture::bytes)
    }

    /// Returns the bind group of the march.
    fn march_group(
        &mut self,
        device: &Device,
        layout: &wgpu::BindGroupLayout,
        inputs: &CloudFrame<'_>,
    ) -> wgpu::BindGroup {
        let is_shaded = inputs.has_shafts && inputs.shaded.is_some();
        if let Some((sky, was_shaded, group)) = &self.marched_of
            && (sky, *was_shaded) == (inputs.sky.1, is_shaded)
        {
            return group.clone();
        }
        let map = self.shadows.as_ref().filter(|_| is_shaded);
        let (solid, light) = (self.tables.solid.view(), self.tables.light.view());
        let group = device.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("clouds marched"),
            layout,
            entries: &[
                inputs.frame.entry(0),
                self.block.entry(1),
                bind::view(2, &self.tables.map),
                bind::view(3, &solid),
                bind::view(4, &light),
                bind::sampler(5, &self.tables.repeating),
                bind::sampler(6, &self.tables.clamping),
                self.picture_block.entry(7),
                bind::view(8, &self.tables.placed),
                map.map_or(&self.no_block, |m| &m.block).entry(9),
                bind::view(10, map.map_or(&self.none, |m| &m.view)),
                self.lamps_block.entry(11),
            ],
        });
        self.marched_of = Some((inputs.sky.1.clone(), is_shaded, group.clone()));
        group
    }

    /// Creates the bind groups of the passes after the march: one for the pass that reprojects squares, and one for
    /// resolving into each of the two whole pictures.
    fn picture_groups(
        &self,
        device: &Device,
        layout: &wgpu::BindGroupLayout,
        frame: &BlockView,
        picture: &Picture,
    ) -> [wgpu::BindGroup; 3] {
        let none = self.no_past();
        let [least, most, back] = &picture.followed;
        // Bind all layers: on OpenGL a view of a single layer reads nothing.
        let from = |i: usize| [&picture.whole[i].layers, least, most, back];
        [none, from(0), from(1)].map(|past| self.picture_group(device, layout, frame, (&picture.marched, past)))
    }

    /// Returns placeholder textures for a frame without history.
    fn no_past(&self) -> [&wgpu::TextureView; 4] {
        [&self.no_layers, &self.none, &self.none, &self.none]
    }

    /// Creates the bind group of a pass after the march, from the marched pixels and the last frame's textures.
    fn picture_group(
        &self,
        device: &Device,
        layout: &wgpu::BindGroupLayout,
        frame: &BlockView,
        (marched, [last, least, most, back]): (&[wgpu::TextureView; 2], [&wgpu::TextureView; 4]),
    ) -> wgpu::BindGroup {
        device.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("clouds of a picture"),
            layout,
            entries: &[
                frame.entry(0),
                self.picture_block.entry(1),
                bind::view(2, &marched[0]),
                bind::view(3, &marched[1]),
                bind::view(4, last),
                bind::sampler(5, &self.tables.clamping),
                bind::view(6, least),
                bind::view(7, most),
                bind::view(8, back),
            ],
        })
    }

    /// Creates the shadow map if there is none.
    fn hold_shadows(&mut self, device: &Device) -> Result<()> {
        if self.shadows.is_none() {
            let map = self.shadow_map(device, &ShadowMap::texture(device))?;
            (self.shadows, self.shaded, self.marched_of) = (Some(map), None, None);
        }
        Ok(())
    }

    /// Updates the shadow map for the frame. Returns a bind group, and the number of passes. The bind group has the map
    /// and the depth of the surfaces that shadows fall on, or placeholders where there are no shadows.
    fn shade(
        &mut self,
        device: &Device,
        encoder: &mut wgpu::CommandEncoder,
        layout: &wgpu::BindGroupLayout,
        (shaded, past): (Option<&Shaded<'_>>, HistoryUse),
    ) -> Result<(wgpu::BindGroup, u32)> {
        let passes = match (shaded, &mut self.shadows) {
            (Some(of), Some(shadows)) => shadows.draw(encoder, &of.projection, past),
            _ => 0,
        };
        let key = shaded.map(|of| (of.depth.texture.clone(), of.depth.index));
        if let Some((made, group)) = &self.shaded
            && *made == key
        {
            return Ok((group.clone(), passes));
        }
        let depth = shaded.map(|of| of.depth.view());
        let map = self.shadows.as_ref().filter(|_| shaded.is_some());
        let group = device.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("shadows of clouds"),
            layout,
            entries: &[
                bind::view(0, depth.as_ref().unwrap_or(&self.none)),
                map.map_or(&self.no_block, |m| &m.block).entry(1),
                bind::view(2, map.map_or(&self.none, |m| &m.view)),
                bind::sampler(3, &self.tables.repeating),
            ],
        });
        self.shaded = Some((key, group.clone()));
        Ok((group, passes))
    }

    /// Returns the texture of the shadow map, if there is one.
    pub fn shadow_texture(&self) -> Option<&wgpu::Texture> {
        self.shadows.as_ref().map(|map| map.view.texture())
    }

    /// Updates the shadow map for a frame in which a host's own materials read it. `texture` becomes the map's texture
    /// if there is no map yet.
    pub fn draw_shadows(
        &mut self,
        device: &Device,
        encoder: &mut wgpu::CommandEncoder,
        clouds: &CloudsUniform,
        projection: &ShadowProjection,
        past: HistoryUse,
        texture: &wgpu::Texture,
    ) -> Result<()> {
        self.block.write(bytemuck::bytes_of(clouds));
        if self.shadows.is_none() {
            self.shadows = Some(self.shadow_map(device, texture)?);
        }
        let Some(map) = &mut self.shadows else { return Ok(()) };
        map.draw(encoder, projection, past);
        Ok(())
    }

    /// Draws the wanted passes of a frame. Returns their number.
    pub fn draw(
        &mut self,
        device: &Device,
        encoder: &mut wgpu::CommandEncoder,
        inputs: &CloudFrame<'_>,
    ) -> Result<u32> {
        if inputs.shaded.is_some() {
            self.hold_shadows(device)?;
        }
        let mut pipelines = match self.pipelines.take() {
            Some(pipelines) => pipelines,
            None => Pipelines::new(device, inputs.sky.0)?,
        };
        let Some(mut picture) = self.picture.take() else { return Ok(0) };
        self.block.write(bytemuck::bytes_of(&inputs.clouds));
        let group = self.march_group(device, &pipelines.march_layouts[0], inputs);
        let (mut passes, mut of_shadows) = (0, 0);
        if inputs.wanted.march || inputs.wanted.resolve {
            (passes, of_shadows) =
                self.draw_picture(device, encoder, inputs, (&mut pipelines, &mut picture), &group)?;
        }
        let made = &picture.whole[picture.newest].texture;
        if let Some(behind) = inputs.behind {
            copy_layer(encoder, behind, made);
        }
        if inputs.wanted.shows_round {
            let [march, sky] = &pipelines.march_layouts;
            let round = match &mut self.round {
                Some(round) => round,
                none => none.insert(CloudPanorama::new(device, &[march, sky], self.is_placed)?),
            };
            if inputs.wanted.round {
                passes += round.draw(encoder, &[&group, inputs.sky.1], inputs.around, (inputs.past, of_shadows > 0));
            }
            round.copy(encoder, made, picture.of.0.1);
        }
        (self.picture, self.pipelines) = (Some(picture), Some(pipelines));
        Ok(passes + of_shadows)
    }

    /// Marches a frame's pixels and resolves its picture. Returns two numbers of passes: of the picture, and of the
    /// shadow map.
    fn draw_picture(
        &mut self,
        device: &Device,
        encoder: &mut wgpu::CommandEncoder,
        inputs: &CloudFrame<'_>,
        (pipelines, picture): (&mut Pipelines, &mut Picture),
        group: &wgpu::BindGroup,
    ) -> Result<(u32, u32)> {
        let has_history = inputs.picture.exposed > 0.0;
        let has_shadows = inputs.shaded.is_some();
        let is_multisampled = has_shadows && inputs.is_multisampled;
        let has_shafts = has_shadows && inputs.has_shafts;
        // Shafts are drawn in front of the sky too.
        let kinds = picture.kinds.as_ref().filter(|_| has_shadows && !has_shafts && !is_multisampled);
        let (depth_kinds, shades_apart) = (inputs.depth_kinds, kinds.is_some());
        let resolve = Resolve { has_history, has_shadows, has_shafts, is_multisampled, depth_kinds, shades_apart };
        self.picture_block.write(bytemuck::bytes_of(&inputs.picture));
        let layout = &pipelines.shadow_layouts[usize::from(is_multisampled)];
        let (shaded, of_shadows) = self.shade(device, encoder, layout, (inputs.shaded.as_ref(), inputs.past))?;
        let groups = match &picture.groups {
            Some(groups) => groups.clone(),
            None => self.picture_groups(device, &pipelines.picture_layout, inputs.frame, picture),
        };
        let mut passes = 1;
        // A picture's first frame marches more pixels than later frames.
        let begins = inputs.picture.side < picture.of.1;
        if !begins {
            picture.begun = None;
        } else if picture.begun.is_none() {
            let marched = marched(device, picture.of.0, inputs.picture.side);
            let group = self.picture_group(device, &pipelines.picture_layout, inputs.frame, (&marched, self.no_past()));
            picture.begun = Some((marched, group));
        }
        let march =
            March { fineness: inputs.fineness, is_placed: self.is_placed, has_shafts, is_coarse: inputs.is_coarse };
        if inputs.wanted.march {
            let [seen, reach] = picture.begun.as_ref().map_or(&picture.marched, |(marched, _)| marched);
            run(encoder, PassTargets::whole(&[seen, reach]), &pipelines.march(device, march)?, &[group, inputs.sky.1]);
            passes += 1;
        }
        if inputs.wanted.march && has_history {
            let [least, most, back] = &picture.followed;
            run(encoder, PassTargets::whole(&[least, most, back]), &pipelines.follow, &[&groups[0]]);
            passes += 1;
        }
        let made = picture.to_make(inputs.wanted.is_begun);
        let [seen, reach] = &picture.whole[made].written;
        let past = picture.begun.as_ref().map_or(&groups[1 + (1 - made)], |(_, group)| group);
        let part = Some(TargetPart { first_row: 0, size: picture.of.0 });
        run_each(
            encoder,
            PassTargets { colors: &[seen, reach], kinds, part },
            pipelines.resolve(device, resolve)?,
            &[past, &shaded],
        );
        if let Some(lamps) = &inputs.lamps {
            self.lamps_block.write(bytemuck::bytes_of(lamps));
            let below = TargetPart { first_row: picture.of.0.1, size: glow_size(picture.of.0) };
            run(
                encoder,
                PassTargets { part: Some(below), ..PassTargets::whole(&[reach]) },
                &pipelines.glow(device, march)?,
                &[group, inputs.sky.1],
            );
            passes += 1;
        }
        picture.newest = made;
        picture.groups = Some(groups);
        Ok((passes, of_shadows))
    }
}

/// Copies the texture of stars and glow, which stand behind the sky's own light, into layer [`BEHIND`] of `target`.
fn copy_layer(encoder: &mut wgpu::CommandEncoder, source: &wgpu::Texture, target: &wgpu::Texture) {
    let origin = wgpu::Origin3d { x: 0, y: 0, z: BEHIND };
    let size = wgpu::Extent3d { depth_or_array_layers: 1, ..source.size() };
    encoder.copy_texture_to_texture(
        source.as_image_copy(),
        wgpu::TexelCopyTextureInfo { origin, ..target.as_image_copy() },
        size,
    );
}
