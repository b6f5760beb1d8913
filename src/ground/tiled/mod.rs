//! Water on the tiles of the host's terrain: of every cell film and pores by the laws of [`super::water`], and in the
//! hollows what runs off, wherever one tile ends and the next begins.
//!
//! In a step each cell that is awake sheds water ([`drains`]), which is in its pit at the end of the step; pits fill,
//! spill and join ([`lakes`]). Beside a hole and at the end of the terrain water leaves; nothing runs in. Runs of cells
//! on which nothing falls, flows or dries are passed over, and so are tiles of which all runs rest. So rain = change of
//! film, pores and standing water + evaporated + leaked + drained, where drained is also what went with cells that were
//! taken away.
//!
//! A change of the ground is followed by the blocks and the waters that it touches. Water that stood there is poured
//! anew where it stood: off a floor that was raised, into a pit that was dug.
//!
//! Film and pores are kept in single precision, rounded down; what that takes off runs off.

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
