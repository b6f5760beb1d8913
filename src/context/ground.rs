//! The water on the ground: as the weather reports it, or simulated over the timeline if the host asked for that.

use std::time::{Duration, Instant};

use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};

use super::Context;
use crate::{
    error::{Result, Status},
    ground::{
        GroundHeld, GroundWater, SurfaceClass,
        water::{Forcing, STEP_S, depth_at_mm},
    },
    moment::Moment,
    scene::WorldKind,
    weather::SurfaceCover,
};

/// Where the wetness of the ground comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum GroundModel {
    /// From the weather of the moment: as reported, or as the rain of the moment keeps it. No state: rain that ends leaves
    /// dry ground.
    #[default]
    Reported,
    /// A state that rain fills and that drains and dries by wind, sun and humidity ([`crate::ground::water`]). It begins at
    /// simulation time 0 as the weather of that moment reports the ground. An update that moves time by more than a day begins it
    /// anew, in the same way, a day before its end.
    Simulated,
}

/// Water at a place of the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GroundAt {
    /// Depth of water, mm: the film, and what stands in the hollow if there is one. For tyres.
    pub water_mm: f64,
    /// Film on level ground outside of hollows, mm; on the host's terrain that of the place.
    pub film_mm: f64,
    /// Of all the ground, on the host's terrain of the place: 0 dry, 0.3 damp, 1 under a closed film.
    pub wetness: f64,
    /// Share of all the ground, or of the host's terrain, under standing water.
    pub puddles: f64,
    /// Whether standing water covers the place. Off the host's terrain only paved ground has puddles.
    pub in_puddle: bool,
    /// What the ground is made of there, by the host's terrain, else by the context's default.
    pub surface_class: SurfaceClass,
}

/// Sunlight for evaporation is looked up this often, s: a multiple of the step.
const SUN_EVERY_S: f64 = 300.0;
/// Luminous efficacy of sun and sky together, lm/W (Muneer 1997).
const LUX_PER_W_M2: f64 = 110.0;
/// An update that moves time by more than this begins the state anew, this long before its end, s.
const LONGEST_S: f64 = 86_400.0;

/// The simulated water and what its next step needs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct GroundState {
    time_s: f64,
    film_mm: f64,
    soaked_mm: f64,
    hollows_mm: f64,
    /// Sunlight on level ground since the last look at it.
    sunlight_w_m2: f64,
}

impl GroundState {
    pub fn water(&self) -> GroundWater {
        GroundWater { film_mm: self.film_mm, soaked_mm: self.soaked_mm, hollows_mm: self.hollows_mm }
    }

    fn set(&mut self, water: GroundWater) {
        (self.film_mm, self.soaked_mm, self.hollows_mm) = (water.film_mm, water.soaked_mm, water.hollows_mm);
    }

    /// Whether a saved one can be one of ours.
    pub fn is_valid(&self) -> bool {
        let amounts = [self.film_mm, self.soaked_mm, self.hollows_mm, self.sunlight_w_m2];
        self.time_s.is_finite() && amounts.iter().all(|v| (0.0..1e4).contains(v))
    }
}

impl Context {
    /// Makes ready to lead the simulated water from the present to `time_s`.
    pub(super) fn begin_ground(&mut self, time_s: f64) -> Result<()> {
        if self.desc.ground == GroundModel::Reported {
            return Ok(());
        }
        let state = if time_s - self.time_s > LONGEST_S {
            // Where the sun is looked at, so that leaps that end a little apart begin alike.
            let begin_s = ((time_s - LONGEST_S) / SUN_EVERY_S).floor() * SUN_EVERY_S;
            let state = self.first_ground(begin_s.max(self.time_s))?;
            self.begin_terrain_anew();
            state
        } else {
            self.ground.map_or_else(|| self.first_ground(self.time_s), Ok)?
        };
        self.ground = Some(state);
        Ok(())
    }

    /// Leads the simulated water on until the present, or until `most` since `begun` is over: one step at least. A terrain has no
    /// part in steps before `terrain_from_s`.
    pub(super) fn lead_ground(&mut self, begun: Instant, most: Duration, terrain_from_s: f64) -> Result<Status> {
        let Some(mut state) = self.ground else { return Ok(Status::Ok) };
        for steps in 0.. {
            let end_s = ((state.time_s / STEP_S).floor() + 1.0) * STEP_S;
            if end_s > self.time_s {
                break;
            }
            if steps > 0 && begun.elapsed() >= most {
                return Ok(Status::Pending);
            }
            if state.time_s.rem_euclid(SUN_EVERY_S) == 0.0 {
                state.sunlight_w_m2 = self.sunlight_w_m2(state.time_s)?;
            }
            let (before, from_s, seconds) = (state.water(), state.time_s, end_s - state.time_s);
            let c = self.timeline.at(0.5 * (from_s + end_s));
            let forcing = Forcing::of(&c, state.sunlight_w_m2);
            state.set(before.after(&forcing, seconds));
            state.time_s = end_s;
            if from_s >= terrain_from_s {
                self.step_terrain((from_s, seconds), &c, &forcing, &before)?;
            }
            self.ground = Some(state);
        }
        Ok(Status::Ok)
    }

    /// Where the steps up to the present end, s.
    pub(super) fn steps_end_s(&self) -> f64 {
        (self.time_s / STEP_S).floor() * STEP_S
    }

    /// What is before this has no part in any later step, s.
    pub(super) fn stepped_to_s(&self) -> f64 {
        self.ground.map_or(self.time_s, |state| state.time_s.min(self.time_s))
    }

    /// Simulation time of the simulated water, s: the present, or earlier as long as [`Context::update_within`] answers that steps
    /// remain. The present if nothing is simulated.
    pub fn state_time_s(&self) -> f64 {
        match (&self.behind, self.ground) {
            (Some(_), Some(state)) => state.time_s,
            _ => self.time_s,
        }
    }

    /// A state that begins at `time_s` as the weather reports the ground.
    fn first_ground(&self, time_s: f64) -> Result<GroundState> {
        let sunlight_w_m2 = self.sunlight_w_m2(time_s)?;
        let mut state = GroundState { time_s, film_mm: 0.0, soaked_mm: 0.0, hollows_mm: 0.0, sunlight_w_m2 };
        state.set(GroundWater::of_cover(&self.timeline.at(time_s).surface));
        Ok(state)
    }

    /// The water at `time_s`, within a step of the state, by the weather half-way there.
    fn ground_after(&self, state: &GroundState, time_s: f64) -> GroundWater {
        let c = self.timeline.at(0.5 * (state.time_s + time_s));
        state.water().after(&Forcing::of(&c, state.sunlight_w_m2), time_s - state.time_s)
    }

    /// Sunlight on level ground at the world's origin, in whole W/m^2: what another machine's rounding changes in a light
    /// that is only drawn must not change a state.
    fn sunlight_w_m2(&self, time_s: f64) -> Result<f64> {
        let world = &self.desc.world;
        let origin = if world.kind == WorldKind::Ecef { world.origin.to_ecef() } else { DVec3::ZERO };
        Ok((self.scene_at(origin, time_s)?.ground.total_lux / LUX_PER_W_M2).round())
    }

    /// The simulated water on level, open ground at [`Context::state_time_s`]; `None` if it is not simulated
    /// ([`GroundModel::Reported`]).
    pub fn ground_water(&self) -> Option<GroundWater> {
        match (self.desc.ground, self.ground) {
            (GroundModel::Reported, _) => None,
            (GroundModel::Simulated, Some(state)) if self.behind.is_none() && self.time_s > state.time_s => {
                Some(self.ground_after(&state, self.time_s))
            }
            (GroundModel::Simulated, Some(state)) => Some(state.water()),
            (GroundModel::Simulated, None) => Some(GroundWater::of_cover(&self.timeline.at(self.time_s).surface)),
        }
    }

    /// What weather has done to the ground up to now: `reported` with the simulated water in its place.
    pub(crate) fn ground_cover(&self, reported: SurfaceCover) -> SurfaceCover {
        match self.ground_water().map(|w| w.cover()) {
            Some((wetness, puddles)) => SurfaceCover { wetness, puddles, ..reported },
            None => reported,
        }
    }

    /// As [`Context::ground_cover`] at a place: in a rain area no drier than its rain of the moment keeps the ground.
    pub(crate) fn ground_cover_at(&self, position: DVec3, reported: SurfaceCover) -> SurfaceCover {
        let cover = self.ground_cover(reported);
        let weather = self.timeline.at(self.time_s);
        let here = self.over().at_place(position, self.time_s, weather).precipitation;
        if here == weather.precipitation {
            return cover;
        }
        let kept = crate::weather::cover_under_rain(&here, weather.air.relative_humidity);
        SurfaceCover {
            wetness: cover.wetness.max(kept.0 * (1.0 - cover.ice)),
            puddles: cover.puddles.max(kept.1 * (1.0 - cover.ice)),
            ..cover
        }
    }

    /// What a camera sees of the ground.
    pub(crate) fn ground_held(&self, now: &Moment<'_>) -> GroundHeld<'_> {
        GroundHeld {
            cover: self.ground_cover_at(now.eye, now.scene.conditions.surface),
            hollows: &self.hollows,
            terrain: self.drawn_terrain(),
            has_wet_terrain: self.has_wet_terrain(),
            surface_class: self.surface_class,
        }
    }

    /// Water on the ground at `position`, now, or while steps remain at [`Context::state_time_s`]: on the host's terrain ([`Context::set_ground_grid`]), up to 3 m above it, that of
    /// its cells; elsewhere by the hollows that are drawn, wherever the host's own ground has its own.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] if the position is no place.
    pub fn ground_at(&self, position: DVec3) -> Result<GroundAt> {
        let frame = self.desc.world.place_at("position", position)?;
        let surface_class = self.surface_class_at(position);
        if let Some((cell, puddles)) = self.terrain_at(position) {
            return Ok(GroundAt {
                water_mm: cell.depth_mm(),
                film_mm: cell.film_mm,
                wetness: cell.wetness(),
                puddles,
                in_puddle: cell.standing_mm > 0.0,
                surface_class,
            });
        }
        let reported = self.timeline.at(self.time_s).surface;
        let cover = self.ground_cover_at(position, reported);
        let kept = GroundWater::of_cover(&cover);
        let water = match self.ground_water() {
            Some(state) if cover == self.ground_cover(reported) => state,
            Some(state) => state.max(&kept),
            None => kept,
        };
        let at = DVec2::from(crate::ground::pattern_axes(&frame.world_to_enu).map(|a| a.dot(position)));
        let hollow_mm = depth_at_mm(&water, self.hollows.depth(at));
        let water_mm = if surface_class.has_hollows() { hollow_mm } else { water.film_mm };
        Ok(GroundAt {
            water_mm,
            film_mm: water.film_mm,
            wetness: cover.wetness,
            puddles: cover.puddles,
            in_puddle: water_mm > water.film_mm,
            surface_class,
        })
    }
}
