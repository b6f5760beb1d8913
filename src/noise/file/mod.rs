//! Noise files: DDS and KTX2 textures with one channel of 8 bits, in two or three dimensions, with mip levels.

mod bytes;
mod dds;
mod ktx2;

use std::fs::File;
use std::io::Read as _;
use std::path::Path;

use super::image::{NoiseImage, empty};
use super::settings::MOST_TEXELS;
use crate::error::{Error, Result, Status, shown};

/// Largest size of a file, bytes: the largest texture with its mip levels, and room for the format's headers.
const MOST_BYTES: u64 = 2 * MOST_TEXELS;

impl NoiseImage {
    /// Reads a DDS or KTX2 file of a format that [`NoiseImage::from_bytes`] accepts.
    ///
    /// # Errors
    /// [`Status::Io`] if the file cannot be read; otherwise the errors of [`NoiseImage::from_bytes`].
    pub fn load(path: impl AsRef<Path>) -> Result<Self> {
        let path = path.as_ref();
        let name = path.display().to_string();
        let name = shown(&name);
        let failed = |e: std::io::Error| Error::new(Status::Io, format!("{name}: {e}"));
        let file = File::open(path).map_err(failed)?;
        let length = file.metadata().map_err(failed)?.len();
        check_length(length).map_err(|e| e.found_in(&name))?;
        let mut bytes = empty(length)?;
        file.take(MOST_BYTES + 1).read_to_end(&mut bytes).map_err(failed)?;
        Self::from_bytes(&bytes).map_err(|e| e.found_in(&name))
    }

    /// Reads a texture with one channel of 8 bits, in two or three dimensions: DDS with the pixel format A8, L8,
    /// R8_UNORM or A8_UNORM, or KTX2 with VK_FORMAT_R8_UNORM and without supercompression. Keeps the file's mip levels
    /// and computes none.
    ///
    /// # Errors
    /// [`Status::Unsupported`] for other files and formats, cube maps, arrays, textures of more than 2^27 texels, and
    /// files of more than 2^28 bytes; [`Status::Parse`] for bytes that are cut short or contradict themselves;
    /// [`Status::OutOfMemory`]. The message names the field of the file.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self> {
        check_length(bytes.len() as u64)?;
        if bytes.starts_with(&dds::MAGIC) {
            dds::read(bytes).map_err(|e| e.found_in("DDS"))
        } else if bytes.starts_with(&ktx2::MAGIC) {
            ktx2::read(bytes).map_err(|e| e.found_in("KTX2"))
        } else {
            Err(Error::unsupported("a noise texture is a DDS or a KTX2 file; this begins like neither"))
        }
    }

    /// Writes the image as a DDS file with its mip levels, as 8-bit luminance (L8), the form that most programs read.
    pub fn to_dds(&self) -> Vec<u8> {
        dds::write(self, dds::Texels::Luminance)
    }

    /// Writes the image as a DDS file with its mip levels and the extended header (DX10), in the format R8_UNORM: for
    /// programs that need the format by name. Fewer programs read it.
    pub fn to_dds_dx10(&self) -> Vec<u8> {
        dds::write(self, dds::Texels::Red)
    }

    /// Writes the image as a KTX2 file with VK_FORMAT_R8_UNORM and its mip levels.
    pub fn to_ktx2(&self) -> Vec<u8> {
        ktx2::write(self)
    }
}

fn check_length(bytes: u64) -> Result<()> {
    if bytes > MOST_BYTES {
        return Err(Error::unsupported(format!(
            "a noise texture has at most {MOST_BYTES} bytes, this file has {bytes}"
        )));
    }
    Ok(())
}
