//! One-channel noise texture on the CPU: its bytes with mip levels, and the cover of clouds that are cut out of it.

use glam::DVec3;

use super::opacity::CloudFunction;
use super::reference::noise_at;
use super::settings::{NoiseSettings, axes, levels_of, size_of_level, texels};
use crate::error::{Error, Result, Status, check_range};

/// Two- or three-dimensional image with one byte per texel and mip levels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NoiseImage {
    size: [u32; 3],
    levels: Vec<Vec<u8>>,
}

impl NoiseImage {
    /// Computes noise in a texture of `size` texels, with a full chain of mip levels. Width, height and depth are
    /// powers of two, 8 to 8192 in two dimensions and 8 to 1024 in three, with at most 2^27 texels; a depth of 1 makes
    /// a two-dimensional texture. The bytes are the same on every machine.
    ///
    /// A volume of 128^3 takes about a second; [`super::NoiseTexture`] draws it faster.
    ///
    /// # Errors
    /// The errors of [`NoiseSettings::check`]; [`Status::OutOfMemory`].
    pub fn generate(size: [u32; 3], settings: &NoiseSettings) -> Result<Self> {
        settings.check(size)?;
        let [width, height, depth] = size;
        let middle = |i: u32, n: u32| (f64::from(i) + 0.5) / f64::from(n);
        let mut bytes = empty(texels(size))?;
        for z in 0..depth {
            for y in 0..height {
                let at = |x| DVec3::new(middle(x, width), middle(y, height), middle(z, depth));
                bytes.extend((0..width).map(|x| byte_of(noise_at(settings, size, at(x)))));
            }
        }
        Self::from_texels(size, bytes)
    }

    /// Creates an image of these bytes, x first, then y, then z, with a full chain of mip levels. Each texel of a level
    /// is the mean of 2 x 2 or 2 x 2 x 2 texels of the next finer level. Where an edge of that level has an odd number
    /// of texels, its last one is left out.
    ///
    /// # Errors
    /// [`Status::InvalidArgument`] if the number of bytes is not that of texels; [`Status::OutOfMemory`].
    pub fn from_texels(size: [u32; 3], bytes: Vec<u8>) -> Result<Self> {
        if texels(size) != bytes.len() as u64 || bytes.is_empty() {
            return Err(Error::range("bytes", &format!("one for each of {size:?} texels"), bytes.len()));
        }
        let mut levels = vec![bytes];
        for level in 1..levels_of(size) {
            let above = levels.last().map_or(&[][..], Vec::as_slice);
            levels.push(halved(above, size_of_level(size, level - 1))?);
        }
        Ok(Self { size, levels })
    }

    /// Creates an image from the size and levels that a file gives.
    pub(super) fn of_levels(size: [u32; 3], levels: Vec<Vec<u8>>) -> Self {
        Self { size, levels }
    }

    /// Returns width, height and depth of level 0, texels; a depth of 1 means two dimensions.
    pub fn size(&self) -> [u32; 3] {
        self.size
    }

    /// Returns the bytes of each mip level, level 0 first; x first, then y, then z.
    pub fn levels(&self) -> &[Vec<u8>] {
        &self.levels
    }

    /// Returns width, height and depth of a mip level, texels.
    pub fn size_of_level(&self, level: u32) -> [u32; 3] {
        size_of_level(self.size, level)
    }

    /// Returns one slice of level 0 for inspection: `width` x `height` bytes, rows from the top; `None` beyond the
    /// depth.
    pub fn preview(&self, slice: u32) -> Option<&[u8]> {
        let area = self.size[0] as usize * self.size[1] as usize;
        self.levels[0].get(slice as usize * area..)?.get(..area)
    }

    /// Returns an image with the opacities of the texels in place of the noise, and with new mip levels computed from
    /// them. A distant cloud is then on the mean as dense as a near one.
    ///
    /// # Errors
    /// [`Status::OutOfMemory`].
    pub fn opacities(&self, cloud: &CloudFunction) -> Result<Self> {
        let of_byte: Vec<u8> = (0..=255).map(|n| byte_of(cloud.opacity(f64::from(n) / 255.0))).collect();
        let mut bytes = empty(texels(self.size))?;
        bytes.extend(self.levels[0].iter().map(|n| of_byte[usize::from(*n)]));
        Self::from_texels(self.size, bytes)
    }

    /// Returns the share of the texels of level 0 above `cutoff`, 0 to 1. It is the cover of a cloud cut out at that
    /// value.
    pub fn cover(&self, cutoff: f64) -> f64 {
        let above = self.levels[0].iter().filter(|n| f64::from(**n) / 255.0 > cutoff).count();
        above as f64 / self.levels[0].len() as f64
    }

    /// Returns the cutoff that gives `cover`, 0 to 1, as closely as bytes allow: [`NoiseImage::cover`] at this cutoff
    /// differs from `cover` by at most the share of the texels that have the cutoff's own byte. Within a byte value the
    /// cutoff is interpolated as if the texels with this byte were spread evenly over all numbers that round to the
    /// byte. The values of a filtered texture are spread so.
    ///
    /// # Errors
    /// [`Status::InvalidArgument`] for a cover outside \[0, 1\].
    pub fn cutoff_for_cover(&self, cover: f64) -> Result<f64> {
        check_range("cover", cover, 0.0, 1.0, "")?;
        let mut counts = [0_u64; 256];
        self.levels[0].iter().for_each(|n| counts[usize::from(*n)] += 1);
        let wanted = cover * self.levels[0].len() as f64;
        let mut above = 0.0;
        for (level, count) in counts.iter().enumerate().rev().filter(|(_, count)| **count > 0) {
            let count = *count as f64;
            if above + count >= wanted {
                // A byte value represents all numbers that round to it.
                let cutoff = level as f64 + 0.5 - (wanted - above) / count;
                return Ok((cutoff / 255.0).clamp(0.0, 1.0));
            }
            above += count;
        }
        Ok(0.0)
    }
}

/// Converts a value in [0, 1] to a byte.
fn byte_of(value: f64) -> u8 {
    (value * 255.0).round() as u8
}

/// Returns an empty vector with room for this many bytes.
pub(super) fn empty(bytes: u64) -> Result<Vec<u8>> {
    let full = || Error::new(Status::OutOfMemory, format!("there are no {bytes} bytes of memory for noise"));
    let mut room = Vec::new();
    room.try_reserve_exact(usize::try_from(bytes).map_err(|_| full())?).map_err(|_| full())?;
    Ok(room)
}

/// Returns the next coarser mip level of one of `size` texels: means in whole bytes, halves rounded up
/// (`shaders/noise/shrink.wgsl`).
fn halved(finer: &[u8], size: [u32; 3]) -> Result<Vec<u8>> {
    let [width, height, depth] = size_of_level(size, 1);
    let texel = |x: u32, y: u32, z: u32| {
        let [x, y, z] = [x.min(size[0] - 1), y.min(size[1] - 1), z.min(size[2] - 1)].map(|i| i as usize);
        u32::from(finer[(z * size[1] as usize + y) * size[0] as usize + x])
    };
    let corners = if axes(size) == 2 { 4 } else { 8 };
    let mut coarser = empty(texels([width, height, depth]))?;
    for z in 0..depth {
        for y in 0..height {
            for x in 0..width {
                let corner = |i: u32| texel(2 * x + (i & 1), 2 * y + (i >> 1 & 1), 2 * z + (i >> 2));
                let sum: u32 = (0..corners).map(corner).sum();
                coarser.push(((sum + corners / 2) / corners) as u8);
            }
        }
    }
    Ok(coarser)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mip_levels_are_means() {
        let image = NoiseImage::from_texels([4, 2, 1], vec![0, 10, 20, 20, 0, 1, 20, 23]).unwrap();
        assert_eq!(image.levels()[1..], [vec![3, 21], vec![12]]);
        let cube = NoiseImage::from_texels([2, 2, 2], vec![0, 0, 0, 0, 1, 1, 1, 1]).unwrap();
        assert_eq!(cube.levels()[1..], [vec![1]], "a half rounds up");
        assert_eq!(cube.preview(1), Some(&[1, 1, 1, 1][..]));
        assert_eq!(cube.preview(2), None);
        assert!(NoiseImage::from_texels([2, 2, 2], vec![0; 7]).is_err());
        assert!(NoiseImage::from_texels([0, 2, 2], vec![]).is_err());
    }

    #[test]
    fn a_cutoff_gives_the_cover_it_was_asked_for() {
        let image = NoiseImage::generate([256, 256, 1], &NoiseSettings::default()).unwrap();
        for cover in [0.0, 0.01, 0.1, 0.25, 0.5, 0.77, 0.99, 1.0] {
            let cutoff = image.cutoff_for_cover(cover).unwrap();
            assert!((image.cover(cutoff) - cover).abs() < 0.012, "{cover}: {cutoff} {}", image.cover(cutoff));
        }
        assert_eq!(image.cover(image.cutoff_for_cover(0.0).unwrap()), 0.0);
        assert_eq!(image.cover(image.cutoff_for_cover(1.0).unwrap()), 1.0);
        assert!(image.cutoff_for_cover(1.5).is_err());
        let even = NoiseImage::from_texels([2, 1, 1], vec![255, 0]).unwrap();
        assert_eq!((even.cutoff_for_cover(0.0).unwrap(), even.cutoff_for_cover(1.0).unwrap()), (1.0, 0.0));
    }
}
