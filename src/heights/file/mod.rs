//! Files of heights: raw numbers, PNG, Terragen terrains and ESRI ASCII grids.

mod ascii_grid;
mod numbers;
mod picture;
mod raw;
mod samples;
mod terragen;

use std::{fs::File, io::Read as _, path::Path};

use super::{
    map::{HeightMap, MAX_HEIGHT_SAMPLES, room_for},
    settings::HeightSettings,
};
use crate::error::{Error, Result, Status, shown};

/// Largest size of a file, bytes: an ESRI ASCII grid of the largest map with 15 characters and a space for each height.
const MOST_BYTES: u64 = 16 * MAX_HEIGHT_SAMPLES;

impl HeightMap {
    /// Reads a file of heights in a format of [`HeightMap::from_bytes`].
    ///
    /// # Errors
    /// [`Status::Io`] if the file cannot be read; [`Status::Unsupported`] for a file of more than 4 GiB; otherwise the
    /// errors of [`HeightMap::from_bytes`], those about the file after its name.
    pub fn load(path: impl AsRef<Path>, settings: &HeightSettings) -> Result<Self> {
        settings.check().map_err(|e| e.within("settings"))?;
        let path = path.as_ref();
        let name = path.display().to_string();
        let name = shown(&name);
        let failed = |e: std::io::Error| Error::new(Status::Io, format!("{name}: {e}"));
        let file = File::open(path).map_err(failed)?;
        let length = file.metadata().map_err(failed)?.len();
        if length > MOST_BYTES {
            let sentence = format!("{name}: a file of heights has at most {MOST_BYTES} bytes, this one has {length}");
            return Err(Error::unsupported(sentence));
        }
        let mut bytes = room_for(length).map_err(|e| e.found_in(&name))?;
        file.take(MOST_BYTES).read_to_end(&mut bytes).map_err(failed)?;
        Self::from_bytes(&bytes, settings).map_err(|e| e.found_in(&name))
    }

    /// Reads heights from the bytes of a file: a raw file if `settings.raw` is set; otherwise PNG with one channel of 8
    /// or 16 bits, Terragen `.ter`, or an ESRI ASCII grid. The heights lie within 100 000 m of 0.
    ///
    /// # Errors
    /// [`Status::InvalidArgument`] naming a field of the settings; [`Status::Unsupported`] for other files and for
    /// variants of these formats that are not read; [`Status::Parse`] for bytes that are cut short, contradict
    /// themselves or are no heights; [`Status::OutOfMemory`]. The message names the place in the file, and what is
    /// accepted there.
    pub fn from_bytes(bytes: &[u8], settings: &HeightSettings) -> Result<Self> {
        settings.check().map_err(|e| e.within("settings"))?;
        if let Some(raw) = &settings.raw {
            return raw::read(bytes, raw, settings).map_err(|e| e.found_in("raw heights"));
        }
        if bytes.starts_with(&picture::MAGIC) {
            picture::read(bytes, settings).map_err(|e| e.found_in("PNG"))
        } else if bytes.starts_with(terragen::MAGIC) {
            terragen::read(bytes, settings).map_err(|e| e.found_in("Terragen terrain"))
        } else if ascii_grid::is_grid(bytes) {
            ascii_grid::read(bytes, settings).map_err(|e| e.found_in("ESRI ASCII grid"))
        } else {
            Err(unknown(bytes))
        }
    }

    /// Writes a raw file in the layout of `settings.raw`, whose size must be the map's. A height that is not known is
    /// written as `settings.no_data`, or as NaN among floats.
    ///
    /// # Errors
    /// [`Status::InvalidArgument`] naming a field of the settings, or the first height that has no number by this
    /// scale; [`Status::OutOfMemory`].
    pub fn to_raw(&self, settings: &HeightSettings) -> Result<Vec<u8>> {
        settings.check().map_err(|e| e.within("settings"))?;
        raw::write(self, settings)
    }

    /// Writes a PNG with one channel of grey of 16 bits, the northernmost row on top. The scale must give each height a
    /// number from 0 to 65 535: [`super::HeightScale::fitting`] returns the finest one that does.
    ///
    /// # Errors
    /// As [`HeightMap::to_raw`].
    pub fn to_png(&self, settings: &HeightSettings) -> Result<Vec<u8>> {
        settings.check().map_err(|e| e.within("settings"))?;
        picture::write(self, settings)
    }

    /// Writes a Terragen terrain with the chunks in the order of its specification. The file's scale is the distance
    /// between samples, which must be known and the same in both directions. A step of height is as fine as the format
    /// allows: about the sum of the heights' range and twice that distance, divided by 65 536.
    ///
    /// # Errors
    /// [`Status::InvalidArgument`] for a height that is not known, sides above 32 767, a distance between samples that
    /// is not known, not the same in both directions or too small for the heights; [`Status::OutOfMemory`].
    pub fn to_ter(&self) -> Result<Vec<u8>> {
        terragen::write(self)
    }
}

/// Returns the error for a file of an unknown format.
fn unknown(bytes: &[u8]) -> Error {
    let is_tiff = [b"II*\0", b"MM\0*", b"II+\0", b"MM\0+"].iter().any(|magic| bytes.starts_with(&magic[..]));
    let begins = if is_tiff { "this is a TIFF" } else { "byte 0 begins none of these" };
    Error::unsupported(format!(
        "heights are read from PNG, Terragen .ter, ESRI ASCII grid, or raw numbers with settings.raw; {begins}: convert \
         it by gdal_translate -of AAIGrid"
    ))
}
