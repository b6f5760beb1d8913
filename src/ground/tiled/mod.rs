//! Water on the tiles of the host's terrain: film and pores of every cell by the laws of [`super::water`], and run-off
//! that collects in the hollows, across the borders between tiles.
//!
//! In each step every cell that is awake (on which water falls, flows or dries) sheds water, which reaches the cell's
//! pit by the end of the step ([`drains`]). Pits fill, spill and join ([`lakes`]). Water leaves at holes and at the
//! edge of the terrain; no water runs in from there. Runs of cells on which nothing falls, flows or dries are skipped,
//! and so are tiles in which all runs rest. The balance is: rain = (change of film, pores and standing water) +
//! evaporated + leaked + drained. Rain includes the water with which a tile's own state begins, and drained water
//! includes that of cells that were removed.
//!
//! When the ground changes, only the blocks and lakes that the change touches are updated. The water of these lakes is
//! poured again where it stood: it runs off a floor that was raised, and into a pit that was dug.
//!
//! Film and pores are stored in single precision, rounded down. The rounding loss counts as run-off.

mod drains;
mod lakes;
mod saved;
mod step;
#[cfg(test)]
mod tests;
mod tile;
mod water;

pub(super) use self::{
    saved::SavedTiles,
    step::TiledStep,
    water::{Changed, TiledWater},
};
