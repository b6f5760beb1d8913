//! Saving and loading of a context, and a hash by which channels compare their contexts.
//!
//! A state is text: a line with the format and a checksum of everything after it, then TOML. Settings that the
//! description of a context fixes are compared on load with those of the loading context. What was set or simulated
//! after the creation of the context is restored as far as [`Context::save`] lists it: by the world, and by each effect
//! for its own state. New keys may be added within a format if a state without them keeps its meaning. A key whose
//! meaning changes requires a new format.

use super::shared_world::Context;
use crate::{
    effects::LoadedHeld,
    error::{Error, Result, Status, number, toml_fault},
    world::{LoadedWorld, SavedWorld, parse_error},
};

/// Number of the format that is written, and the only one that is read. Format 1 did not contain the place and the
/// ground model.
const FORMAT: u32 = 2;
/// Beginning of the first line.
const MAGIC: &str = "welkin state ";

/// Computes the 64-bit FNV-1a hash. It differs for any two texts of the same length that differ in one byte.
fn checksum(text: &str) -> u64 {
    let fold = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
    text.bytes().fold(0xcbf2_9ce4_8422_2325, fold)
}

/// Returns a saved state: the first line with the checksum of `body`, then `body`.
fn sealed(body: &str) -> String {
    format!("{MAGIC}{FORMAT} {:016x}\n{body}", checksum(body))
}

/// Returns the text below the first line, if the format and the checksum in the first line are right.
fn unsealed(bytes: &[u8]) -> Result<&str> {
    let text = std::str::from_utf8(bytes).map_err(|_| parse_error("the bytes are no UTF-8 text"))?;
    let (head, body) = text.split_once('\n').ok_or_else(|| parse_error("the first line is missing"))?;
    let format = match head.strip_prefix(MAGIC) {
        Some(rest) => rest.split(' ').next().unwrap_or_default(),
        None => head.strip_prefix("version = ").ok_or_else(|| parse_error("the first line is not a state's"))?,
    };
    if format != FORMAT.to_string() {
        let format: String = format.chars().take(12).collect();
        return Err(parse_error(format_args!(
            "it is of format {format}, this version of Welkin reads format {FORMAT} alone: save it anew"
        )));
    }
    // A truncated text may still be TOML, and so may one with a changed digit.
    if sealed(body) != text {
        return Err(parse_error("it is cut short or changed, its checksum does not fit"));
    }
    Ok(body)
}

/// State that was read and checked, ready to be swapped in.
struct Loaded {
    world: LoadedWorld,
    held: LoadedHeld,
}

impl Context {
    /// Returns the settings that the description of this context fixes.
    fn created(&self) -> toml::Table {
        let mut table = self.world.created();
        self.held.all().iter().for_each(|effect| effect.created(&mut table));
        table
    }

    /// Writes the state as text. `for_hash` says that the text is only hashed, never loaded.
    fn saved(&self, for_hash: bool) -> Result<String> {
        if self.behind.is_some() {
            let wanted = "a state comes after wk_context_update has answered WK_OK: steps of the simulation remain";
            return Err(Error::new(Status::WrongOrder, format!("{wanted} up to {} s", number(self.world.time_s))));
        }
        let fault = |e| Error::new(Status::Internal, format!("the state cannot be written: {e}"));
        let mut table = toml::Table::try_from(self.world.saved(self.created())?).map_err(fault)?;
        self.held.all().iter().try_for_each(|effect| effect.save_in(&self.world, for_hash, &mut table))?;
        toml::to_string(&table).map_err(fault)
    }

    /// Saves everything that decides what this context shows from now on, as UTF-8 text: weather, time, clock, lights,
    /// exposure, tone curve, planet, shelters, lamps, rain areas, weather regions, the cloud map, the wind grid, the
    /// fog law, the settings of single effects, and the simulated water, snow, soil and wind. The text also contains
    /// the place, seed and ground model for which it is valid. Not saved are settings of drawing (sky settings, views),
    /// the list of stars, heights of terrain tiles, and the images of [`Context::set_occluder_maps`], because each
    /// channel may have its own images.
    ///
    /// # Errors
    /// [`Status::WrongOrder`] while [`Context::update_within`] has steps to do; [`Status::Internal`] if a number cannot
    /// be written.
    pub fn save(&self) -> Result<Vec<u8>> {
        Ok(sealed(&self.saved(false)?).into_bytes())
    }

    /// Loads a state that [`Context::save`] wrote, in place of the present one. The context must have been created with
    /// the same world, place, seed and ground model. A state from a version in which planet and tone curve could not
    /// yet be set does not restore these two: the context must already have the same planet and tone curve. Occluder
    /// maps stay as they are.
    ///
    /// # Errors
    /// [`Status::Parse`] for bytes that are not a state, are truncated or changed, or have another format, which the
    /// message names; [`Status::InvalidArgument`] naming the setting with which this context was created differently.
    /// The context stays as it was.
    pub fn load(&mut self, bytes: &[u8]) -> Result<()> {
        let mut loaded = self.read_state(unsealed(bytes)?)?;
        let behind = self.behind.take();
        self.swap_in(&mut loaded);
        let shown = self.refresh();
        if shown.is_err() {
            self.swap_in(&mut loaded);
            self.behind = behind;
        }
        shown
    }

    /// Reads a state that fits this context.
    fn read_state(&self, body: &str) -> Result<Loaded> {
        let mut table: toml::Table = toml::from_str(body).map_err(|e| parse_error(toml_fault(body, &e)))?;
        let held = self.held.read(&self.world, &mut table);
        let saved: SavedWorld = table.try_into().map_err(|e| parse_error(toml_fault(body, &e)))?;
        Ok(Loaded { world: self.world.read(saved, &self.created())?, held: held? })
    }

    /// Swaps the loaded state in; `other` then holds the previous one.
    fn swap_in(&mut self, other: &mut Loaded) {
        self.world.swap_in(&mut other.world);
        self.held.swap_in(&mut self.world, &mut other.held);
    }

    /// Returns a hash that is equal on two channels whose contexts show the same world from now on. It covers
    /// everything that [`Context::save`] writes; for the water of each terrain tile it uses a hash that is kept until
    /// the water changes.
    ///
    /// # Errors
    /// As [`Context::save`].
    pub fn state_hash(&self) -> Result<u64> {
        Ok(checksum(&self.saved(true)?))
    }
}
