//! Rain of a view: the drops, cones, splashes, stones and columns that it draws for a scene and a camera.

use glam::DVec3;

use super::{
    area_pass::{AreaPass, Columns},
    candidates,
    classes::Classes,
    cones::{BANDS_M, CONES, ConeUniform},
    contrast::Streaks,
    ice_here::Ice,
    integrated::{self, SteppedDrops},
    light::DropLight,
    local::{Local, LocalColumn, LocalUniform},
    passes::{LayerDraw, RainLayer},
    presence::{RainPresence, begun_at},
    settings::{RainModel, RainSettings},
    shaft::{AreaField, EyeInWorld},
    shells::{HIDDEN_M, REACH_M, SHELLS, hidden_m},
    splash::{self, Splashes},
    stone_pass::StoneDraw,
    uniforms::RainUniform,
};
use crate::{
    error::Result,
    falling::{MAX_AREAS, curtain, drops},
    gpu::{Device, blocks::Blocks},
    moment::{Scene, SceneMoment},
    particles::{
        FallingTexture, MovingAir, StreakCamera,
        stepping::{self, Stepped},
    },
    stage::{
        Contribution, Diagnostic, DrawContext, DrawnEffect, Exchange, FrameBlock, FrameContext, MergedFrame, Output,
        Outputs, PutPart, RainReport, Recording, Report, Stages, Texture, rounding,
    },
    surroundings::ShelterReach,
    weather::Falling,
    wind::Remembered,
};

/// State that a view holds for its rain.
pub(crate) struct RainView {
    blocks: Blocks,
    layer: RainLayer,
    pub settings: RainSettings,
    /// Shares set by the plan: the drawn share of all rain, and the share of the near drops that are drawn as single
    /// drops.
    shares: [f32; 2],
    /// Recently counted classes of drops, each with the precipitation, the factor on fall speeds ([`drops::factor_in`])
    /// and the largest number of drops for which they were counted.
    counted: Vec<(Falling, f64, u32, Classes)>,
    /// The weather's own rain, reduced to the share that has begun to fall above the camera.
    own: Falling,
    /// Columns of rain areas around the camera.
    field: AreaField,
    /// Rain that falls within reach of the camera.
    local: Option<Local>,
    /// Pass for columns, once there are any.
    areas: Option<Box<AreaPass>>,
    /// Hail and ice pellets at the camera.
    ice: Ice,
    /// Displacement of the air at the births of the cones' sets of streaks.
    births: Remembered,
    /// Whether drops were stepped in the last frame.
    is_stepped: bool,
    /// Identifier of the last drawn frame, and the report of its rain.
    drawn: (u64, RainReport),
}

/// Number of precipitations whose classes are cached: more than the weather's and all areas' together.
const COUNTED: usize = 32;

/// Smallest weight of a nearby rain area in the rain for which cones are made, so that they exist before the camera
/// enters it.
const LEAST_OF_CONES: f64 = 1e-2;

impl RainView {
    pub fn new(device: &Device, blocks: &Blocks, settings: RainSettings, layer: FallingTexture) -> Self {
        Self {
            layer: RainLayer::new(device, blocks, layer, false),
            blocks: blocks.clone(),
            settings,
            shares: [1.0; 2],
            counted: Vec::new(),
            own: Falling::NONE,
            field: AreaField::empty(),
            local: None,
            areas: None,
            ice: Ice::default(),
            births: Remembered::default(),
            is_stepped: false,
            drawn: (u64::MAX, RainReport::default()),
        }
    }

    /// Sets whether the layer counts how often its pixels are drawn, instead of showing their light. A change recreates
    /// the layer's passes.
    pub fn set_counting(&mut self, device: &Device, counts: bool) {
        if self.layer.counts() != counts {
            let layer = self.layer.texture().clone();
            (self.layer, self.areas) = (RainLayer::new(device, &self.blocks, layer, counts), None);
        }
    }

    /// Returns the presence of rain and ice, as far as the settings draw them.
    fn presence(&self) -> RainPresence {
        RainPresence {
            drops: self.settings.model != RainModel::Veil && self.local.is_some_and(|l| l.has_drops(&self.field)),
            stones: self.ice.is_drawn(&self.settings),
            columns: !self.field.columns.is_empty(),
        }
    }

    /// Returns the presence of rain and ice that the plan draws in this frame.
    fn kept(&self) -> RainPresence {
        let presence = self.presence();
        RainPresence { drops: presence.drops && self.shares[0] > 0.0, ..presence }
    }

    /// Returns the number of drops of the weather's own rain that are drawn around the camera.
    fn drops(&mut self, device: &Device, scene: &Scene) -> u32 {
        self.classes(device, scene, &{ self.own }).per_shell * self.shells() as u32
    }

    /// Returns whether drops are stepped: always with [`RainModel::Integrated`], and with the automatic model near a
    /// wind that varies in space.
    fn steps(&self, now: &SceneMoment<'_>, device: &Device, is_pure: bool) -> bool {
        match self.settings.model {
            RainModel::Integrated => true,
            RainModel::Automatic => stepping::is_due(now, device, REACH_M, self.is_stepped, is_pure),
            RainModel::Drops | RainModel::Cones | RainModel::Veil => false,
        }
    }

    /// Returns the number of drawn shells of the lattice.
    fn shells(&self) -> usize {
        match self.settings.model {
            RainModel::Drops | RainModel::Integrated => SHELLS,
            RainModel::Automatic => 1,
            RainModel::Veil | RainModel::Cones => 0,
        }
    }

    /// Returns whether the plan decides how much of the rain is drawn: only with the automatic model, and only if drops
    /// fall.
    pub fn is_planned(&self) -> bool {
        self.settings.model == RainModel::Automatic && self.presence().drops
    }

    /// Sets the drawn share of all rain, and the share of near rain drawn as single drops. Both are 1 if the plan does
    /// not decide.
    fn set_shares(&mut self, shares: [f32; 2]) {
        self.shares = if self.is_planned() { shares } else { [1.0; 2] };
    }

    /// Returns ([extinction, distance], share) for the weather's own rain and the stones. The extinction, 1/m, is that
    /// of all drops and stones that can be drawn near the camera. The distance, m, is that up to which they are drawn.
    /// The share is the drawn share of this extinction. The extinction is that of the discs of drops and stones alone,
    /// half of the total (the other half is diffraction). It is multiplied by the contrast gain.
    fn hidden(&mut self, device: &Device, now: &SceneMoment<'_>) -> ([f32; 2], f32) {
        let scene = &now.scene;
        let falling = self.own;
        let reach = self.reach(now);
        let most = self.settings.most_on(device);
        // Spreads the optical depth of the stones, which are rare, over the drops' reach.
        let ice = self.ice.stones(scene, &self.settings, most).map_or(0.0, |s| s.hidden_depth());
        let rain = self.near(device, scene, &falling);
        let share =
            if rain > 0.0 { (f64::from(self.shares[0]) * rain + ice / reach) / (rain + ice / reach) } else { 1.0 };
        let hidden = self.settings.contrast_gain * (rain + ice / reach);
        ([hidden, reach].map(|v| v as f32), share as f32)
    }

    /// Returns whether there are cones: with the models that always have them, and beyond single drops where there are
    /// lamps, because lamps do not light the rain that is drawn as extinction.
    fn has_cones(&self, now: &SceneMoment<'_>) -> bool {
        match self.settings.model {
            RainModel::Automatic | RainModel::Cones => true,
            RainModel::Drops | RainModel::Integrated => now.has_lamps(),
            RainModel::Veil => false,
        }
    }

    /// Returns the distance up to which drops or cones are drawn, m.
    fn reach(&self, now: &SceneMoment<'_>) -> f64 {
        if self.has_cones(now) { BANDS_M[CONES] } else { HIDDEN_M }
    }

    /// Returns the share of the near drops that is drawn one by one; the rest is drawn on cones.
    fn share_of_drops(&self) -> f64 {
        match self.settings.model {
            RainModel::Automatic => self.shares[1].into(),
            RainModel::Drops | RainModel::Integrated => 1.0,
            RainModel::Veil | RainModel::Cones => 0.0,
        }
    }

    /// Returns the extinction, 1/m, that is drawn as drops or cones near the camera, and that is subtracted from the
    /// rain drawn with the fog.
    fn near(&mut self, device: &Device, scene: &Scene, falling: &Falling) -> f64 {
        match self.settings.model {
            RainModel::Veil => 0.0,
            _ => 0.5 * self.classes(device, scene, falling).extinction_per_m,
        }
    }

    /// Returns the lowest fall speed of the drawn drops and stones, m/s, and their largest distance from the camera, m.
    fn shelter_reach(&mut self, device: &Device, scene: &Scene) -> ShelterReach {
        let stones = self.ice.stones(scene, &self.settings, self.settings.most_on(device)).map_or(0.0, |s| s.reach_m());
        let reach_m = BANDS_M.into_iter().fold(REACH_M.max(splash::REACH_M).max(stones), f64::max);
        // Allows for the smallest stones, which fall a tenth more slowly than the smallest drops.
        ShelterReach { slowest_m_s: 0.9 * self.classes(device, scene, &{ self.own }).flux[0].1, reach_m }
    }

    /// Returns the classes of drops of a precipitation, counted or cached.
    fn classes(&mut self, device: &Device, scene: &Scene, falling: &Falling) -> Classes {
        // Gives the drops of shells that are not drawn to the drawn shells.
        let most = self.settings.most_on(device).saturating_mul((SHELLS / self.shells().max(1)) as u32);
        let station = &scene.conditions.air;
        let factor = drops::factor_in(station, station.station_altitude_m);
        let same = |c: &&(Falling, f64, u32, Classes)| c.0 == *falling && c.1 == factor && c.2 == most;
        if let Some((.., classes)) = self.counted.iter().find(same) {
            return *classes;
        }
        if self.counted.len() == COUNTED {
            self.counted.clear();
        }
        let classes = Classes::new(falling, factor, most);
        self.counted.reserve_exact(COUNTED - self.counted.len());
        self.counted.push((*falling, factor, most, classes));
        classes
    }

    /// Sets the pattern of the columns of rain areas, and the extinction that is drawn as drops near the camera and
    /// subtracted from the columns.
    fn set_near(&mut self, device: &Device, now: &SceneMoment<'_>) {
        let scene = &now.scene;
        let falling = self.own;
        self.field.near_m = self.reach(now);
        // Limits the gain to 2: no more than the whole extinction, twice that of the drops' discs, is subtracted from a
        // column.
        let share = f64::from(self.shares[0]) * self.settings.contrast_gain.min(2.0);
        self.field.own_near = share * self.near(device, scene, &falling);
        for i in 0..self.field.columns.len() {
            let shaft = *self.field.columns[i].shaft();
            let near = share * self.near(device, scene, &shaft.falling);
            self.field.columns[i].near = near * shaft.begun(scene.place.altitude_m);
        }
        self.field.waves = curtain::waves(now.seed as u32, curtain::COLUMN_LENGTHS_M);
    }

    /// Draws the columns of rain areas into the layer. Returns whether there are any.
    fn draw_areas(
        &mut self,
        context: &DrawContext<'_>,
        merged: &MergedFrame<'_>,
        recording: &mut Recording<'_>,
    ) -> Result<bool> {
        if self.field.columns.is_empty() {
            return Ok(false);
        }
        self.set_near(recording.device, context.now);
        let columns = Columns {
            field: &self.field,
            scene: &context.now.scene,
            clip: context.clip(),
            veiled: context.target.is_veiled,
        };
        let counts = self.layer.counts();
        let target = self.layer.texture().view(recording.device, context.picture().size());
        let pass =
            self.areas.get_or_insert_with(|| Box::new(AreaPass::new(recording.device, recording.blocks, counts)));
        pass.draw(recording, &columns, merged, context.frame.depth_layer(), &target)?;
        Ok(true)
    }

    /// Returns the drops that fall around the camera, and the block with the number of drops at each place if it
    /// differs from place to place.
    fn falling_here(&mut self, device: &Device, scene: &Scene) -> (Classes, Option<LocalUniform>) {
        let weather = self.own;
        match self.local.unwrap_or(Local::Pure(weather)) {
            Local::Pure(falling) => (self.classes(device, scene, &falling), None),
            Local::Mixed(falling, bits) => {
                let base = self.classes(device, scene, &falling);
                let mut near = [None; MAX_AREAS];
                for (i, to) in near.iter_mut().enumerate().take(self.field.columns.len()) {
                    let column = self.field.columns[i];
                    let begun = column.shaft().begun(scene.place.altitude_m);
                    if bits & (1 << i) != 0 {
                        *to = Some((column.uniform(), begun, self.classes(device, scene, &column.shaft().falling)));
                    }
                }
                let columns = near.iter().flatten().map(|(uniform, begun, classes)| LocalColumn {
                    uniform: *uniform,
                    begun: *begun,
                    classes,
                });
                let (block, envelope) = LocalUniform::new(&base, columns);
                (envelope, Some(block))
            }
        }
    }

    /// Returns the rain for which cones are made: that at the camera, plus a small share of each rain area nearby, so
    /// that cones exist before the camera enters it.
    fn falling_at(&mut self, device: &Device, scene: &Scene) -> Classes {
        let weather = self.own;
        let (base, bits) = match self.local.unwrap_or(Local::Pure(weather)) {
            Local::Pure(falling) => (falling, 0),
            Local::Mixed(falling, bits) => (falling, bits),
        };
        let base = self.classes(device, scene, &base);
        let mut left = 1.0;
        let mut mixture = None;
        for i in (0..self.field.columns.len()).filter(|i| bits & (1 << i) != 0) {
            let share = self.field.share(i, DVec3::ZERO);
            let shaft = *self.field.columns[i].shaft();
            left -= share;
            let area = self.classes(device, scene, &shaft.falling);
            let before = mixture.get_or_insert_with(|| base.part(0.0));
            *before = before.with(share.max(LEAST_OF_CONES) * shaft.begun(scene.place.altitude_m), &area);
        }
        mixture.map_or(base, |m| m.with(left.max(LEAST_OF_CONES), &base))
    }

    /// Returns the camera of the picture, with the exposure and the contrast gain of the settings.
    fn camera<'a>(&self, context: &DrawContext<'a>) -> StreakCamera<'a> {
        StreakCamera::new(context, self.settings.shutter_s, self.settings.contrast_gain)
    }

    /// Returns the contrast of the streaks in a picture, if the plan decides about them.
    pub fn streaks(&mut self, context: &DrawContext<'_>) -> Option<Streaks> {
        if !self.is_planned() {
            return None;
        }
        let (device, now) = (context.device, context.now);
        let (classes, _) = self.falling_here(device, &now.scene);
        let wind = now.carrying().ok()?.velocity_m_s();
        let light = (DropLight::of(&now.scene).exposed(context.target.exposure), context.tone());
        Some(Streaks::new((&classes, wind), &self.camera(context), light, now.has_lamps()))
    }

    /// Draws rain and ice around the camera into the layer, which already contains columns if `over_columns` is set.
    /// Returns the report.
    fn draw_near(
        &mut self,
        context: &DrawContext<'_>,
        merged: &MergedFrame<'_>,
        over_columns: bool,
        recording: &mut Recording<'_>,
    ) -> Result<RainReport> {
        if !self.kept().is_near() {
            return Ok(RainReport::default());
        }
        let (device, now, frame, scene) = (recording.device, context.now, context.frame, &context.now.scene);
        let (classes, mut local) = self.falling_here(device, scene);
        let camera = self.camera(context);
        let (wind, air) = (now.carrying()?, MovingAir::of(now)?);
        let mut block =
            RainUniform::new(now.seed, &classes, &DropLight::of(scene).exposed(context.target.exposure), &camera, &air);
        let [share, shown] = self.shares.map(f64::from);
        let near = self.share_of_drops();
        block.weight *= (share * near) as f32;
        // Draws no drops if only hail falls.
        let wet = self.kept().drops;
        block.shells = if wet && near > 0.0 { self.shells() as u32 } else { 0 };
        let splashes = Splashes::new(&classes);
        let most = self.settings.most_on(device);
        let stones = self.ice.stones(scene, &self.settings, most);
        let height_m = scene.place.altitude_m - scene.conditions.air.station_altitude_m;
        // Takes the births out of `self`, because the calls below need `self` mutably.
        let births = std::mem::take(&mut self.births);
        let carried = |from| wind.since(from, &births);
        let cones = (wet && self.has_cones(now)).then(|| {
            let there = self.falling_at(device, scene);
            local.iter_mut().for_each(|l| l.set_cones(there.extinction_per_m));
            let all = ConeUniform::new(block.seed, &there, &camera, &air, &carried);
            all.behind((hidden_m(self.shells()), near), share * self.settings.contrast_gain)
        });
        self.is_stepped = self.steps(now, device, frame.is_pure());
        let of_lattice = SteppedDrops { seed: now.seed, classes: &classes, shells: block.shells as usize, most };
        let stepped = (self.is_stepped && block.shells > 0).then(|| Stepped {
            anew: frame.is_pure(),
            ..integrated::stepped(&of_lattice, (&camera, &air), &carried, now.wind_texture(device))
        });
        let drawn = LayerDraw {
            rain: &block,
            cones: cones.as_ref(),
            stepped: stepped.as_ref(),
            rays: context.target.rays,
            surroundings: merged.surroundings,
            maps: now.has_maps(),
            lamps: now.has_lamps(),
            splash: &splashes.uniform(
                (camera.position_m, height_m),
                air.time_s,
                share * shown,
                frame.depth.map_or([0.0; 2], rounding),
            ),
            splashes: if block.shells > 0 { splashes.instances() } else { 0 },
            local: local.as_ref(),
            over: over_columns,
            stones: stones
                .map(|s| StoneDraw::new(&s, s.uniform(camera.position_m, height_m, air.displacement_m, air.time_s))),
        };
        let done = self.layer.draw(recording, &drawn, context.picture(), frame.depth_layer());
        self.births = births;
        done?;
        let drops = block.shells > 0;
        Ok(RainReport {
            drops: classes.per_shell * block.shells + stones.map_or(0, |s| s.drawn),
            drop_weight: if drops { classes.weight } else { 0.0 },
            contrast_gain: self.settings.contrast_gain,
            splashes_left_out_per_m2_s: if drops { splashes.left_out_per_m2_s } else { 0.0 },
            stones_left_out_per_m2_s: stones.map_or(0.0, |s| s.left_out_per_m2_s),
        })
    }
}

impl DrawnEffect for RainView {
    /// Columns of rain areas are drawn in front of the sky, so the sky's output must exist first.
    fn composes(&self) -> Exchange {
        Exchange { needs: &[Output::Sky], gives: &[Output::Rain] }
    }

    fn gather(&mut self, context: &FrameContext<'_>, _given: &mut Outputs) -> Result<()> {
        self.set_counting(context.device, context.frame.diagnostic == Diagnostic::Overdraw);
        let (now, scene) = (context.now, &context.now.scene);
        self.own = begun_at(&scene.conditions, scene.place.altitude_m);
        let eye = EyeInWorld { position: now.eye, to_enu: &scene.world_to_enu, altitude_m: scene.place.altitude_m };
        self.field.columns.clear();
        if !now.weather.regions.is_empty() {
            let shafts = now.weather.shafts_at(now.time_s, &scene.conditions)?;
            self.field.set(shafts, eye, &now.falling, now.time_s);
        }
        self.local = Some(Local::new(&self.own, &self.field, eye, REACH_M.max(self.reach(now))));
        self.ice.gather(now);
        Ok(())
    }

    fn stages(&self) -> Stages {
        if self.presence().is_any() { Stages::PARTICLES } else { Stages(0) }
    }

    fn hold(&mut self, device: &Device, color: &wgpu::Texture, stages: Stages) {
        if stages.has(Stages::PARTICLES) && self.kept().is_any() {
            let _ = self.layer.texture().view(device, color.size());
        }
    }

    fn parts(&mut self, context: &DrawContext<'_>, stages: Stages, put: &mut PutPart<'_>) {
        let is_there = stages.has(Stages::PARTICLES) && self.is_planned();
        let drops = if is_there { self.drops(context.device, &context.now.scene) } else { 0 };
        put(&candidates::RAIN, is_there, &candidates::rain_work(context.pixels(), drops));
    }

    fn compose(&mut self, context: &DrawContext<'_>, _given: &Outputs, added: &mut Contribution) -> Result<()> {
        self.set_shares([1, 0].map(|step| context.share(&candidates::RAIN, step)));
        let (hidden, share) =
            if self.presence().is_any() { self.hidden(context.device, context.now) } else { ([0.0; 2], 1.0) };
        added.set_frame_block(FrameBlock::Rain { hidden, share });
        let is_kept = self.kept().is_any();
        if is_kept {
            let layer = self.layer.texture().view(context.device, context.picture().size());
            added.set_texture(Texture::Before, Some(layer));
        }
        if context.stages.has(Stages::SURFACE) || is_kept && context.stages.has(Stages::PARTICLES) {
            added.set_near(self.shelter_reach(context.device, &context.now.scene));
        }
        Ok(())
    }

    /// Draws the layer in front of the picture: columns of rain areas, and the rain and ice near the camera.
    fn draw(
        &mut self,
        context: &DrawContext<'_>,
        merged: &MergedFrame<'_>,
        recording: &mut Recording<'_>,
    ) -> Result<()> {
        if !merged.composition.stages().has(Stages::PARTICLES) {
            return Ok(());
        }
        let over = self.draw_areas(context, merged, recording)?;
        self.drawn = (context.frame.frame_id, self.draw_near(context, merged, over, recording)?);
        recording.passes += u32::from(self.kept().is_any()) + u32::from(over);
        Ok(())
    }

    /// Returns the columns of rain areas for the veil of the host's own shaders.
    fn veil(
        &mut self,
        context: &DrawContext<'_>,
        merged: &MergedFrame<'_>,
    ) -> Option<(&'static str, wgpu::BindGroupLayout, wgpu::BindGroup)> {
        if self.field.columns.is_empty() {
            return None;
        }
        self.set_near(context.device, context.now);
        let columns = Columns { field: &self.field, scene: &context.now.scene, clip: context.clip(), veiled: true };
        let pass = self
            .areas
            .get_or_insert_with(|| Box::new(AreaPass::new(context.device, &self.blocks, self.layer.counts())));
        let (layout, group) = pass.bound(context.device, &columns, merged, context.frame.depth_layer())?;
        Some(("frame/froxels_areas.wgsl", layout, group))
    }

    fn bytes(&self) -> u64 {
        self.layer.bytes()
    }

    fn report(&self, report: &mut Report) {
        if self.drawn.0 == report.frame_id {
            report.rain = self.drawn.1;
        }
    }

    fn forget_picture(&mut self) {
        self.layer.texture().forget();
    }
}
