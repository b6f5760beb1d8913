//! Settings of a noise texture, and the number of octaves that a texture can hold.

use crate::error::{Error, Result, check_range};

/// Largest number of texels of a texture: a cube of 512.
pub(super) const MOST_TEXELS: u64 = 1 << 27;
/// Longest edge of a two- and of a three-dimensional texture, texels.
const LONGEST: [u32; 2] = [8192, 1024];
/// Shortest edge, texels.
const SHORTEST: u32 = 8;
/// Largest number of octaves.
const MOST_OCTAVES: u32 = 16;

/// Kind of noise in a texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum NoiseKind {
    /// Gradient noise (Perlin 2002): billows without a preferred direction. For cover.
    Gradient,
    /// Cellular noise (Worley 1996), bright at its feature points: round lumps. For the edges of clouds.
    Cellular,
    /// Gradient noise mapped from \[0, 1\] to \[cellular noise, 1\] (Schneider 2015): connected lumps. For the shape of
    /// clouds.
    GradientOverCellular,
}

/// Settings of a noise texture. The default is that of Tarantilis (2004, section III.B.4.c) for a volume of 128^3.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoiseSettings {
    /// Kind of noise. Default: gradient noise.
    pub kind: NoiseKind,
    /// Cells of the first octave across the texture along x, y and z, from 1 to half the number of texels. Whole
    /// numbers, so that the texture repeats without a seam. Default 6. The third is not used in two dimensions.
    pub frequency: [u32; 3],
    /// Octaves, 1 to 16; default 6. Octaves with less than two texels to a cell add only their mean.
    pub octaves: u32,
    /// Amplitude of the first octave, 0 to 4; default 0.7. The amplitudes of all octaves should have a sum of 1 to 2,
    /// or most texels are alike.
    pub amplitude: f64,
    /// Ratio of an octave's amplitude to that of the one before, 0 to 1; default 0.5.
    pub persistence: f64,
    /// Seed: each number gives another pattern. Default 0.
    pub seed: u64,
}

impl Default for NoiseSettings {
    fn default() -> Self {
        Self { kind: NoiseKind::Gradient, frequency: [6; 3], octaves: 6, amplitude: 0.7, persistence: 0.5, seed: 0 }
    }
}

impl NoiseSettings {
    /// Returns the number of octaves that a texture of `size` texels can hold: `octaves`, or fewer if finer octaves
    /// would have less than two texels to a cell.
    pub fn octaves_in(&self, size: [u32; 3]) -> u32 {
        let held = |axis: usize| (size[axis] / (2 * self.frequency[axis]).max(1)).max(1).ilog2() + 1;
        (0..axes(size)).map(held).fold(self.octaves, u32::min)
    }

    /// Checks that these settings suit a texture of `size` texels (width, height, depth; a depth of 1 means two
    /// dimensions).
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`], which names the field and what it accepts.
    pub fn check(&self, size: [u32; 3]) -> Result<()> {
        check_size(size)?;
        for (axis, texels) in size.into_iter().enumerate().take(axes(size)) {
            let field = format!("frequency[{axis}]");
            check_range(&field, f64::from(self.frequency[axis]), 1.0, f64::from(texels / 2), "cells")?;
        }
        check_range("octaves", f64::from(self.octaves), 1.0, f64::from(MOST_OCTAVES), "")?;
        check_range("amplitude", self.amplitude, 0.0, 4.0, "")?;
        check_range("persistence", self.persistence, 0.0, 1.0, "")
    }
}

/// Returns the number of axes: 2 for a depth of 1, otherwise 3.
pub(super) fn axes(size: [u32; 3]) -> usize {
    if size[2] == 1 { 2 } else { 3 }
}

/// Checks that edges are powers of two within their range, and that the texels are not too many. With powers of two
/// every texel of a mip level covers whole texels of the next finer level, and cells have exactly the same positions as
/// on a GPU.
fn check_size(size: [u32; 3]) -> Result<()> {
    let axes = axes(size);
    let longest = LONGEST[axes - 2];
    for (axis, texels) in size.into_iter().enumerate().take(axes) {
        if !texels.is_power_of_two() || !(SHORTEST..=longest).contains(&texels) {
            let accepted = format!("a power of two in [{SHORTEST}, {longest}] texels");
            return Err(Error::range(&format!("size[{axis}]"), &accepted, texels));
        }
    }
    if texels(size) > MOST_TEXELS {
        return Err(Error::range("size", &format!("at most {MOST_TEXELS} texels"), texels(size)));
    }
    Ok(())
}

/// Returns the number of texels without mip levels.
pub(super) fn texels(size: [u32; 3]) -> u64 {
    size.into_iter().map(u64::from).product()
}

/// Returns the number of mip levels of a full chain, with the texture itself.
pub(super) fn levels_of(size: [u32; 3]) -> u32 {
    size.into_iter().max().unwrap_or(1).max(1).ilog2() + 1
}

/// Returns the size of a mip level, texels.
pub(super) fn size_of_level(size: [u32; 3], level: u32) -> [u32; 3] {
    size.map(|texels| (texels >> level).max(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn octaves_finer_than_the_texels_are_left_out() {
        // Octaves that the presets of 2004 ask for, and the number that their textures can hold.
        for (texels, frequency, asked, held) in
            [(1024, 3, 10, 8), (1024, 6, 10, 7), (1024, 16, 8, 6), (128, 6, 6, 4), (128, 6, 2, 2), (8, 4, 9, 1)]
        {
            let settings = NoiseSettings { frequency: [frequency; 3], octaves: asked, ..Default::default() };
            assert_eq!(settings.octaves_in([texels; 3]), held, "{texels} {frequency}");
            assert_eq!(settings.octaves_in([texels, texels, 1]), held, "{texels} {frequency}");
        }
        let flat = NoiseSettings { frequency: [4, 4, 2], ..Default::default() };
        assert_eq!(flat.octaves_in([128, 128, 16]), 3);
    }

    #[test]
    fn what_cannot_be_made_is_refused_by_name() {
        let good = NoiseSettings::default();
        assert!(good.check([128; 3]).is_ok() && good.check([1024, 512, 1]).is_ok());
        let refused = |s: NoiseSettings, size, field: &str| {
            let e = s.check(size).unwrap_err();
            assert_eq!(e.field(), Some(field), "{e}");
        };
        refused(good, [100, 128, 128], "size[0]");
        refused(good, [128, 0, 1], "size[1]");
        refused(good, [128, 128, 0], "size[2]");
        refused(good, [16384, 128, 1], "size[0]");
        refused(good, [1024; 3], "size");
        refused(NoiseSettings { frequency: [6, 0, 6], ..good }, [128; 3], "frequency[1]");
        refused(NoiseSettings { frequency: [6, 6, 65], ..good }, [128; 3], "frequency[2]");
        refused(NoiseSettings { octaves: 0, ..good }, [128; 3], "octaves");
        refused(NoiseSettings { octaves: 17, ..good }, [128; 3], "octaves");
        refused(NoiseSettings { amplitude: f64::NAN, ..good }, [128; 3], "amplitude");
        refused(NoiseSettings { persistence: -0.1, ..good }, [128; 3], "persistence");
        assert!(NoiseSettings { frequency: [6, 6, 0], ..good }.check([128, 128, 1]).is_ok(), "a plane has two axes");
    }
}
