//! Step of the water on all tiles. One step may take several calls.

use super::{
    drains::Sink,
    tile::cells_of,
    water::{StepInParts, TiledWater, pit_below, pour_all},
};
use crate::{
    error::Result,
    ground::{rain_on::RainStep, state::GroundStep, terrain::Flows, water::Step},
    terrain::{CellId, Terrain},
    world::{UpdateBudget, World},
};

/// Inputs of a step.
#[derive(Clone, Copy)]
pub(crate) struct TiledStep<'a> {
    pub world: &'a World,
    pub terrain: &'a Terrain,
    /// Inputs of the same step for level, open ground outside all weather regions.
    pub ground: GroundStep<'a>,
}

/// Water that a step added and removed, and whether any water may have changed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SteppedTiles {
    pub flows: Flows,
    /// Whether any water may have changed.
    pub changes: bool,
}

impl TiledWater {
    /// Advances the tiles until all have done the step or the time budget is used up, at least one tile per call.
    /// Returns `None` while tiles remain.
    pub fn step(&mut self, now: &TiledStep<'_>, budget: Option<UpdateBudget>) -> Result<Option<SteppedTiles>> {
        let mut part = self.part.take().unwrap_or_default();
        let step = Step::new(now.ground.forcing, now.ground.seconds);
        let keys = std::mem::take(&mut self.keys);
        let done = part.last;
        let mut left = keys.iter().skip_while(|(key, _)| done.is_some_and(|last| **key <= last));
        let mut led = Ok(());
        for (key, slot) in left.by_ref() {
            led = self.step_tile(*slot, now, &step, &mut part);
            if led.is_err() {
                break;
            }
            part.last = Some(*key);
            if budget.is_some_and(|w| w.begun.elapsed() >= w.most) {
                break;
            }
        }
        let remain = left.next().is_some() || led.is_err();
        self.keys = keys;
        if remain {
            self.part = Some(part);
            return led.map(|()| None);
        }
        let dry = self.lakes.count == 0;
        self.finish(now.terrain, &step, &mut part.flows);
        self.version.1 += 1;
        Ok(Some(SteppedTiles { flows: part.flows, changes: part.changes || !dry || self.lakes.count > 0 }))
    }

    /// Advances the water on one tile by a step.
    fn step_tile(&mut self, slot: u32, now: &TiledStep<'_>, step: &Step, part: &mut StepInParts) -> Result<()> {
        let Some(tile) = self.tiles[slot as usize].as_mut() else { return Ok(()) };
        let ground = &now.ground;
        let local = ground.in_regions(now.world, tile.rain.whole.middle);
        let (conditions, forcing) = local.as_ref().map_or((ground.conditions, ground.forcing), |(c, f)| (c, f));
        let step = &if local.is_some() { Step::new(forcing, ground.seconds) } else { *step };
        let quiet = forcing.liquid_mm_h <= 0.0 && now.world.set.regions.is_empty();
        if quiet && tile.begun && !tile.is_awake() {
            return Ok(());
        }
        let data = now.terrain.tile(slot);
        let cells = cells_of(now.terrain, data);
        let shelters = &now.world.set.shelters;
        let overs = tile.rain.overs(now.world, ground.from_s + 0.5 * ground.seconds, conditions)?;
        if !tile.begun {
            let water = tile.rain.first_water(&cells, (conditions, ground.water), &overs, shelters);
            // Counts the initial water as rain.
            part.flows.rain += tile.begin(data, &water);
            part.changes = true;
        }
        let rains = overs.rain(forcing);
        if rains {
            let falling = RainStep { conditions, forcing, seconds: ground.seconds };
            tile.rain.fall(&cells, &falling, &overs, shelters);
        }
        part.changes |= rains || tile.is_awake();
        let flows = tile.step(data, (slot as usize, &self.lakes), step, rains);
        part.flows.rain += flows.rain;
        part.flows.evaporated += flows.evaporated;
        Ok(())
    }

    /// Pours the run-off of the step into the pits that it reaches, and lowers standing water by evaporation and
    /// leakage.
    fn finish(&mut self, terrain: &Terrain, step: &Step, flows: &mut Flows) {
        let came = self.gather(terrain, flows);
        flows.drained += pour_all((&self.tiles, &mut self.lakes), terrain, came);
        if self.lakes.count > 0 {
            let sinks = step.evaporated_mm + step.leaked_mm;
            let mut bared = Vec::new();
            let gone = self.lakes.sink(terrain, sinks, &mut bared);
            flows.evaporated += gone * step.evaporated_mm / sinks;
            flows.leaked += gone * step.leaked_mm / sinks;
            bared.into_iter().for_each(|cell| self.wake(terrain, cell));
        }
        (self.covered, self.cells) =
            (self.lakes.covered(), (terrain.all().len() * terrain.side() * terrain.side()) as f64);
    }

    /// Collects the run-off of this step from all blocks. Returns pairs of a pit and an amount of water that reaches
    /// it, mm times cells; a pit may occur several times. Water that leaves the terrain is added to `flows.drained`.
    fn gather(&mut self, terrain: &Terrain, flows: &mut Flows) -> Vec<(CellId, f64)> {
        let mut ends: Vec<(Sink, f64)> = Vec::new();
        for slot in self.keys.values() {
            let Some(tile) = self.tiles[*slot as usize].as_mut() else { continue };
            for block in tile.drains.blocks.iter_mut().filter(|b| b.gets) {
                block.gets = false;
                let found = block.sinks.iter().zip(&mut block.inflow).filter(|(_, water)| **water > 0.0);
                ends.extend(found.map(|(sink, water)| (*sink, std::mem::take(water))));
            }
        }
        let mut came = Vec::with_capacity(ends.len());
        for (sink, water) in ends {
            let pit = match sink {
                Sink::Pit(pit) => Some(pit),
                Sink::On(cell) => pit_below(&self.tiles, terrain, cell),
                Sink::Out => None,
            };
            match pit {
                Some(pit) => came.push((pit, water)),
                None => flows.drained += water,
            }
        }
        came
    }
}
