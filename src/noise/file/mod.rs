//! Noise in files: DDS and KTX2 textures of one channel of 8 bits, planes and volumes, with mip levels.

mod bytes;
mod dds;
mod ktx2;

use std::fs::File;
use std::io::Read as _;
use std::path::Path;

use super::image::{NoiseImage, empty};
use super::settings::MOST_TEXELS;
use crate::error::{Error, Result, Status, shown};

/// Most bytes of a file: a texture of the most texels with its mip levels, and room for what else formats hold.
const MOST_BYTES: u64 = 2 * MOST_TEXELS;

impl NoiseImage {
    /// Reads a DDS or KTX2 file, as [`NoiseImage::from_bytes`].
    ///
    /// # Errors
    /// [`Status::Io`] where the file cannot be read; those of [`NoiseImage::from_bytes`].
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

    /// Reads a texture of one channel of 8 bits, a plane or a volume: DDS with the pixel format A8, L8, R8_UNORM or
    /// A8_UNORM, or KTX2 with VK_FORMAT_R8_UNORM and without supercompression. Mip levels that it has are kept; none
    /// are made.
    ///
    /// # Errors
    /// [`Status::Unsupported`] for other files, formats, cube maps, arrays and textures of more than 2^27 texels;
    /// [`Status::Parse`] for bytes cut short or that contradict themselves; [`Status::OutOfMemory`]. The message names
    /// the field of the file.
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

    /// The image as a DDS file with its mip levels, as luminance of 8 bits (L8): the form of it that most programs
    /// read.
    pub fn to_dds(&self) -> Vec<u8> {
        dds::write(self, dds::Texels::Luminance)
    }

    /// The image as a DDS file with its mip levels and the longer header, called DX10, with the format R8_UNORM: for
    /// programs that want the format by its name. Fewer read it.
    pub fn to_dds_dx10(&self) -> Vec<u8> {
        dds::write(self, dds::Texels::Red)
    }

    /// The image as a KTX2 file with VK_FORMAT_R8_UNORM and its mip levels.
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
