//! Saving a context and loading it again, and a number by which channels compare theirs.
//!
//! A state is text: a line with the format and a checksum of all that follows, then TOML. What the description of a
//! context fixes is compared on load; everything that can be set or that has come about since is restored, by the world
//! and by each effect that holds a part of it. Keys may be added without another format if a state without them means
//! what it did; a key whose meaning changes makes another format.

use super::shared_world::Context;
use crate::{
    effects::LoadedHeld,
    error::{Error, Result, Status, number, toml_fault},
    world::{LoadedWorld, SavedWorld, parse_error},
};

/// The format that is written, and the only one that is read. Format 1 did not say of which place and ground a state
/// was.
const FORMAT: u32 = 2;
/// Beginning of the first line.
const MAGIC: &str = "welkin state ";

/// FNV-1a, 64 bits: never the same for two texts that differ in one byte.
fn checksum(text: &str) -> u64 {
    let fold = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
    text.bytes().fold(0xcbf2_9ce4_8422_2325, fold)
}

fn sealed(body: &str) -> String {
    format!("{MAGIC}{FORMAT} {:016x}\n{body}", checksum(body))
}

/// Returns the text below the first line, if that fits.
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
    // A text that was cut may still be TOML, and so may one with another digit.
    if sealed(body) != text {
        return Err(parse_error("it is cut short or changed, its checksum does not fit"));
    }
    Ok(body)
}

/// A state that can be shown.
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

    /// `for_hash`: to be hashed, never loaded.
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

    /// Everything that decides what this context shows from now on, as UTF-8 text: weather, time, clock, lights, water,
    /// areas, shelters, lamps, wind grid, fog law, planet, exposure and tone curve, and of which place, seed and ground
    /// model it is. Not in it: how it is drawn (sky settings, views), and the images of [`Context::set_occluder_maps`],
    /// which are each channel's own.
    ///
    /// # Errors
    /// [`Status::WrongOrder`] while [`Context::update_within`] has steps to do; [`Status::Internal`] if a number cannot
    /// be written.
    pub fn save(&self) -> Result<Vec<u8>> {
        Ok(sealed(&self.saved(false)?).into_bytes())
    }

    /// Loads a state that [`Context::save`] wrote, in place of all that it holds, on a context that was created alike:
    /// the same world, place, seed and ground model; for a state without planet and tone curve, as earlier versions
    /// wrote them, the same of these too. Occluder maps stay as they are.
    ///
    /// # Errors
    /// [`Status::Parse`] for bytes that are no such state, cut short, changed, or of another format, which it names;
    /// [`Status::InvalidArgument`] naming what was created otherwise. The context stays as it was.
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

    /// A state that fits this context.
    fn read_state(&self, body: &str) -> Result<Loaded> {
        let mut table: toml::Table = toml::from_str(body).map_err(|e| parse_error(toml_fault(body, &e)))?;
        let held = self.held.read(&self.world, &mut table);
        let saved: SavedWorld = table.try_into().map_err(|e| parse_error(toml_fault(body, &e)))?;
        Ok(Loaded { world: self.world.read(saved, &self.created())?, held: held? })
    }

    /// Shows a state, and leaves the one before in its place.
    fn swap_in(&mut self, other: &mut Loaded) {
        self.world.swap_in(&mut other.world);
        self.held.swap_in(&mut self.world, &mut other.held);
    }

    /// A number that is equal on two channels whose contexts show the same world from now on: a hash of what
    /// [`Context::save`] writes, in which the water of each tile stands by a hash that is kept until it changes.
    ///
    /// # Errors
    /// As [`Context::save`].
    pub fn state_hash(&self) -> Result<u64> {
        Ok(checksum(&self.saved(true)?))
    }
}
